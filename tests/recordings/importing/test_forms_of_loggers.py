"""Tables in the forms of many loggers give the times, positions and headings of one true motion."""

import tomllib
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.cells import column_of_cells, number_of_cell
from boatsim.recordings.importing.clocks import times_of_day_from_digits
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.queued_messages import queued_positions
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.logs.table import read
from boatsim.recordings.table import Recording
from tests.recordings.importing.test_proposal_by_motion import DOF, DRIVES, simulated

RUN = simulated(duration=150.0)
T = RUN["t"] - RUN["t"][0]
COUNT = len(T)
BEGIN = datetime(2026, 11, 25, 23, 59, 0, tzinfo=UTC)
FORCES = {"thrust_port": RUN["port"], "thrust_stbd": RUN["starboard"]}


def texts(values: np.ndarray, decimals: int = 3) -> list[str]:
    return [f"{value:.{decimals}f}" for value in values]


def stamps(form: str, begin: datetime = BEGIN) -> list[str]:
    """Times of the rows; %f is cut to tenths of a second."""
    found = []
    for seconds in T:
        when = begin + timedelta(seconds=round(float(seconds), 1))
        found.append(when.strftime(form.replace("%f", str(when.microsecond // 100_000))))
    return found


def columns(**more: list[str]) -> dict[str, list[str]]:
    heading = texts(np.degrees(RUN["psi"]) % 360.0, 2)
    pose = {"x_m": texts(RUN["north"]), "y_m": texts(RUN["east"]), "heading_deg": heading}
    orders = {name: texts(values, 1) for name, values in FORCES.items()}
    return pose | orders | more


def table(folder: Path, cells: dict[str, list[str]], separator: str = ",", above: str = "") -> Path:
    lines = [separator.join(cells), *map(separator.join, zip(*cells.values(), strict=True))]
    file = folder / "log.csv"
    file.write_text(above + "\n".join(lines) + "\n", encoding="utf-8")
    return file


def imported(file: Path) -> tuple[Recording, str]:
    """The recording by the proposed map, and the map."""
    log = open_logs([file])
    text = propose_map(log, None, DRIVES, DOF)
    return convert_log(log, parse_map(tomllib.loads(text), "map.toml"), "map.toml"), text


def check_motion(found: Recording, north: np.ndarray = RUN["north"]) -> None:
    assert found.t == pytest.approx(T, abs=2e-3)
    assert found["x_m"] == pytest.approx(north, abs=2e-3)
    off = np.angle(np.exp(1j * (found["psi_rad"] - RUN["psi"])))
    assert np.abs(off).max() < 2e-3


@pytest.mark.parametrize(
    "form", ["%m/%d/%y %I:%M:%S.%f %p", "%d.%m.%y %H:%M:%S.%f", "%H%M%S.%f", "%H:%M:%S.%f"]
)
def test_times_go_on_after_midnight_in_every_form(tmp_path, form):
    check_motion(imported(table(tmp_path, {"utc_time": stamps(form), **columns()}))[0])


def test_whole_seconds_with_am_and_pm_are_spread_over_their_rows(tmp_path):
    cells = {"Date Time": stamps("%m/%d/%y %I:%M:%S %p"), **columns()}
    check_motion(imported(table(tmp_path, cells))[0])


@pytest.mark.parametrize("form", ["%S.%f", "%S"])
def test_hours_minutes_and_seconds_may_have_columns_of_their_own(tmp_path, form):
    cells = {"hour": stamps("%H"), "minute": stamps("%M"), "second": stamps(form), **columns()}
    check_motion(imported(table(tmp_path, cells))[0])


def test_a_calendar_in_columns_counts_since_1970(tmp_path):
    parts = {"year": "%Y", "month": "%m", "day": "%d", "hour": "%H", "minute": "%M"}
    cells = {name: stamps(form) for name, form in parts.items()}
    milliseconds = [f"{int(text)}00" for text in stamps("%f")]
    cells |= {"second": stamps("%S"), "msec": milliseconds}
    log = read(table(tmp_path, cells | columns()))
    assert log.signals["x_m"].t == pytest.approx(BEGIN.timestamp() + T, abs=1e-5)


def test_numbers_that_only_count_seconds_are_no_times_of_day():
    assert times_of_day_from_digits(np.arange(100.0, 400.0, 0.1)) is None
    assert times_of_day_from_digits(np.arange(100.0, 158.0, 0.1)) is None


@pytest.mark.parametrize("name", ["GPS seconds", "t_rx"])
def test_the_time_has_further_names(tmp_path, name):
    cells = {"GPS week": ["2446"] * COUNT, name: texts(295392.0 + T, 2), **columns()}
    check_motion(imported(table(tmp_path, cells))[0])


def test_rows_in_any_order_are_sorted_by_a_column_called_time(tmp_path):
    cells = {"time": texts(T, 1), **columns()}
    order = np.random.default_rng(1).permutation(COUNT)
    order = np.concatenate([order[order > 700], order[order <= 700]])  # ends before it begins
    shuffled = {name: [values[i] for i in order] for name, values in cells.items()}
    check_motion(imported(table(tmp_path, shuffled))[0])


@pytest.mark.parametrize(("begin", "hour"), [((2026, 10, 25, 2), -1), ((2026, 3, 29, 1), 1)])
def test_a_clock_that_changes_to_or_from_summer_time_goes_on(tmp_path, begin, hour):
    first = datetime(*begin, 59, 0)
    form = "%Y-%m-%d %H:%M:%S.%f"
    before, after = stamps(form, first), stamps(form, first + timedelta(hours=hour))
    cells = {"Local time": before[:600] + after[600:], **columns()}
    log = read(table(tmp_path, cells))
    found = convert_log(log, parse_map(tomllib.loads(propose_map(log)), "m.toml"), "m.toml")
    check_motion(found)
    assert any("the samples go on" in text for text in found.remarks)


def test_a_pause_of_an_hour_over_which_the_boat_moved_on_stays(tmp_path):
    late = np.where(T < 60.0, T, T + 3600.0)
    cells = columns()
    cells["x_m"] = texts(RUN["north"] + np.where(T < 60.0, 0.0, 40.0))
    log = read(table(tmp_path, {"time": texts(late, 1), **cells}))
    found = convert_log(log, parse_map(tomllib.loads(propose_map(log)), "m.toml"), "m.toml")
    assert found.t[-1] == pytest.approx(late[-1], abs=1e-3)


def test_a_map_without_times_asks_for_them(tmp_path):
    _, text = imported(table(tmp_path, columns()))
    assert '# time = "..."  # CHECK: no column holds times' in text
    _, text = imported(table(tmp_path, {"time": texts(T, 1), **columns()}))
    assert "no column holds times" not in text


@pytest.mark.parametrize(
    ("latitude", "longitude", "more"),
    [
        (["3312.5000S"], ["07136.2500W"], {}),
        (["33.208333"], ["71.604167"], {"ns": ["S"], "ew": ["W"]}),
    ],
)
def test_south_and_west_are_negative(tmp_path, latitude, longitude, more):
    cells = {"time": texts(T, 1), "lat": latitude * COUNT, "lon": longitude * COUNT}
    cells |= {name: letters * COUNT for name, letters in more.items()}
    log = read(table(tmp_path, cells | {"n": texts(T, 1)}))
    assert log.signals["lat"].values[0] == pytest.approx(-33.208333, abs=1e-6)
    assert log.signals["lon"].values[0] == pytest.approx(-71.604167, abs=1e-6)


def test_a_single_letter_is_no_hemisphere(tmp_path):
    cells = {"time": texts(T, 1), "lat": ["33.2"] * COUNT, "lon": ["71.6"] * COUNT}
    log = read(table(tmp_path, cells | {"wind": ["W"] * COUNT}))
    assert log.signals["lon"].values[0] == 71.6


@pytest.mark.parametrize(
    ("text", "separator", "number"),
    [
        ("−5,25", ";", -5.25),
        ("6'643'210.5", ";", 6643210.5),
        ("6 643 210,5", ";", 6643210.5),
    ],
)
def test_signs_and_groups_of_typesetters_are_read(text, separator, number):
    assert number_of_cell(text, separator) == pytest.approx(number)


@pytest.mark.parametrize(("separator", "mark"), [(",", ","), (";", ".")])
def test_marks_of_thousands_are_told_from_decimals_by_two_signs(separator, mark):
    milliseconds = np.arange(0, 2000, 100)
    cells = [f"{value:,d}".replace(",", mark) for value in milliseconds]
    found = column_of_cells(cells, separator)
    assert found.values == pytest.approx(milliseconds)
    assert "separates thousands" in found.remarks[0][0]
    assert column_of_cells([f"1{mark}250", f"2{mark}5"], separator).values[0] == 1.25
    assert column_of_cells([f"1{mark}250", f"2{mark}500"], separator).values[0] == 1.25


def test_lines_before_a_header_and_decimal_commas_are_read(tmp_path):
    cells = {"Datum": stamps("%d.%m.%Y %H:%M:%S,%f"), **columns()}
    cells = {name: [text.replace(".", ",") for text in values] for name, values in cells.items()}
    cells["Datum"] = stamps("%d.%m.%Y %H:%M:%S,%f")
    check_motion(imported(table(tmp_path, cells, ";", "Logger V1.2;;;\nBoat;A;;\n"))[0])


def test_a_first_row_of_decimal_commas_is_no_header(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text("\n".join("0,10;1,25;2,50" for _ in range(30)) + "\n")
    assert list(read(file).signals) == ["column_1", "column_2", "column_3"]


def test_the_text_that_spreadsheets_write_with_two_bytes_is_read(tmp_path):
    file = table(tmp_path, {"time": texts(T, 1), **columns()}, "\t")
    file.write_text(file.read_text(encoding="utf-8"), encoding="utf-16")
    check_motion(imported(file)[0])


def test_a_heading_from_east_and_its_rate_follow_the_course_of_the_track(tmp_path):
    yaw = np.angle(np.exp(1j * (0.5 * np.pi - RUN["psi"])))
    cells = {"t": texts(T, 1), **columns()} | {"yaw": texts(yaw, 4), "gyro_z": texts(-RUN["r"], 4)}
    del cells["heading_deg"]
    found, text = imported(table(tmp_path, cells))
    check_motion(found)
    assert found["r_radps"] == pytest.approx(RUN["r"], abs=1e-3)
    assert "CHECK: counterclockwise from east by the course of the track" in text


@pytest.mark.parametrize("names", [("x_enu", "y_enu", "yaw_enu"), ("x_ned", "y_ned", "yaw_ned")])
def test_names_of_frames_give_the_axes(tmp_path, names):
    pose = RUN["north"], RUN["east"], RUN["psi"]
    if "enu" in names[0]:
        pose = RUN["east"], RUN["north"], np.angle(np.exp(1j * (0.5 * np.pi - RUN["psi"])))
    cells = {"t": texts(T, 1), **{n: texts(p, 4) for n, p in zip(names, pose, strict=True)}}
    check_motion(imported(table(tmp_path, cells))[0])


def test_a_heading_in_radians_that_runs_on_is_told_by_the_course(tmp_path):
    run_on = RUN["psi"] + 4.0 * np.pi  # beyond a turn, which radians seldom are
    cells = {"t": texts(T, 1), **columns()} | {"psi": texts(run_on, 4)}
    del cells["heading_deg"]
    check_motion(imported(table(tmp_path, cells))[0])


def test_a_heading_in_hundredths_of_degrees_and_scaled_positions_are_read(tmp_path):
    hundredths = np.round(np.degrees(RUN["psi"]) * 100.0) % 36000.0
    latitude = 59.9 + np.degrees(RUN["north"] / 6.37e6)
    longitude = 10.7 + np.degrees(RUN["east"] / 6.37e6 / np.cos(np.radians(59.9)))
    cells = {"t": texts(T, 1), "lat_e7": texts(latitude * 1e7, 0)}
    cells |= {"lon_e7": texts(longitude * 1e7, 0), "hdg": texts(hundredths, 0)}
    text = propose_map(read(table(tmp_path, cells)), None, (), DOF)
    columns_of_map = tomllib.loads(text)
    assert columns_of_map["position"]["latitude"] == "lat_e7 * deg * 1e-7"
    assert columns_of_map["columns"]["psi_rad"] == "hdg * deg * 0.01"


def test_a_rate_of_turn_in_degrees_per_minute_is_told_by_the_heading(tmp_path):
    cells = {"t": texts(T, 1), **columns(ROT=texts(60.0 * np.degrees(RUN["r"]), 1))}
    found, text = imported(table(tmp_path, cells))
    assert found["r_radps"] == pytest.approx(RUN["r"], abs=1e-3)
    assert "degrees per minute by the changes of heading_deg" in text


def test_drives_are_not_exchanged_where_the_heading_is_counterclockwise(tmp_path):
    cells = {"t": texts(T, 1), **columns()}
    del cells["heading_deg"]
    cells["heading_ccw"] = texts(-RUN["psi"], 4)
    assert "turns to the other side" not in imported(table(tmp_path, cells))[1]


@pytest.mark.slow
def test_sensors_that_share_the_rows_of_a_table_have_rates_of_their_own(tmp_path):
    rows = {name: [] for name in ("time", "x_m", "y_m", "heading_deg")}
    for i in range(COUNT):
        for late, names in ((0.0, ("x_m", "y_m")), (0.013, ("heading_deg",))):
            for name in ("x_m", "y_m", "heading_deg"):
                rows[name].append(columns()[name][i] if name in names else "")
            rows["time"].append(f"{T[i] + late:.3f}")
    text = propose_map(read(table(tmp_path, rows)), None, (), DOF)
    assert "# 10 Hz" in text
    assert "rate = " not in tomllib.loads(text)


@pytest.mark.parametrize("names", [("F_port [N]", "F_stb [N]"), ("F_Bb [N]", "F_Stb [N]")])
def test_a_force_with_a_side_is_an_order(tmp_path, names):
    cells = {"t": texts(T, 1), **columns()}
    for old, new in zip(FORCES, names, strict=True):
        cells[new] = cells.pop(old)
    found = tomllib.loads(propose_map(read(table(tmp_path, cells)), None, (), DOF))["columns"]
    assert {names[0], names[1]} <= set(found.values())


def test_the_name_of_a_file_says_what_its_sides_are(tmp_path):
    for name in ("pose", "motor"):
        (tmp_path / name).mkdir()
    pose = table(tmp_path / "pose", {"stamp": texts(RUN["t"], 1), **columns()})
    pose = pose.rename(tmp_path / "pose.csv")
    shares = {"left": texts(RUN["port"] / 104.0), "right": texts(RUN["starboard"] / 104.0)}
    motor = table(tmp_path / "motor", {"stamp": texts(RUN["t"], 1), **shares})
    motor = motor.rename(tmp_path / "motor.csv")
    text = pose.read_text().replace("thrust_", "unknown_")
    pose.write_text(text)
    found = tomllib.loads(propose_map(open_logs([pose, motor]), None, DRIVES, DOF))["columns"]
    assert found["n_port_radps"]["signal"] == "left"


def test_messages_that_arrive_at_once_after_a_stall_are_late():
    t = T.copy()
    stalled = (t > 60.05) & (t < 66.05)
    t[stalled] = 66.0 + 0.001 * np.arange(int(stalled.sum()))
    found = list(queued_positions(t, RUN["north"], RUN["east"]))
    assert len(found) == 1
    assert (found[0].last, found[0].begin) == pytest.approx((60.0, 66.0), abs=0.01)
    assert t[stalled].max() < found[0].end < 66.2
    lost = ~stalled
    assert not list(queued_positions(T[lost], RUN["north"][lost], RUN["east"][lost]))
