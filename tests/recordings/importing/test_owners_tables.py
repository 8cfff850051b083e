"""Tables as loggers, spreadsheets and owners write them give the motion of the boat, and a remark on
each repair."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.recordings.importing.coarse_times import spread_coarse_times
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.coordinates import degrees_of_texts
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.missing_values import placeholder_rows
from boatsim.recordings.logs.table import read
from boatsim.recordings.table import Recording
from tests.recordings.importing.test_proposal_by_motion import (
    DOF,
    DRIVES,
    RPM,
    SPEED_AT_80,
    simulated,
)

RUN = simulated()
COUNT = len(RUN["t"])
LATITUDE = 59.9 + np.degrees(RUN["north"] / 6.37e6)
LONGITUDE = 10.7 + np.degrees(RUN["east"] / 6.37e6 / np.cos(np.radians(59.9)))


def texts_of(values, form: str = "{:.9g}") -> list[str]:
    return [form.format(value) for value in values]


def columns_of_run() -> dict[str, list[str]]:
    """Texts of the columns of a log, with one time for each row."""
    return {
        "time": texts_of(RUN["t"], "{:.3f}"),
        "lat": texts_of(LATITUDE),
        "lon": texts_of(LONGITUDE),
        "heading_deg": texts_of(np.degrees(RUN["psi"]) % 360.0),
        "rpm_port": texts_of(RUN["port"] / RPM),
        "rpm_starboard": texts_of(RUN["starboard"] / RPM),
    }


def lines_of(columns: dict[str, list[str]]) -> list[str]:
    rows = [",".join(row) for row in zip(*columns.values(), strict=True)]
    return [",".join(columns), *rows]


def imported(folder: Path, lines: list[str]) -> tuple[Recording, str]:
    """The recording by the proposed map, and all remarks."""
    file = folder / "log.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    log = read(file)
    text = propose_map(log, None, DRIVES, DOF, None, lambda: SPEED_AT_80)
    found = convert_log(log, parse_map(tomllib.loads(text), "map.toml"), "map.toml")
    return found, "\n".join(found.remarks)


def check_motion(found: Recording, tolerance: float = 1e-6) -> None:
    """All rows are there, at their times."""
    assert found.t == pytest.approx(RUN["t"] - RUN["t"][0], abs=1e-3)
    off = np.angle(np.exp(1j * (found["psi_rad"] - RUN["psi"])))
    assert np.nanmax(np.abs(off)) < tolerance
    assert found["n_port_radps"] == pytest.approx(RUN["port"], rel=1e-6)
    assert np.ptp(found["x_m"]) == pytest.approx(np.ptp(RUN["north"]), rel=0.01)


def test_seconds_and_nanoseconds_of_two_columns_are_one_time(tmp_path):
    columns = columns_of_run()
    whole = np.floor(RUN["t"] + 1e-6)
    del columns["time"]
    stamp = {
        "header.stamp.secs": texts_of(whole, "{:.0f}"),
        "header.stamp.nsecs": texts_of(np.round((RUN["t"] - whole) * 10.0) * 1e8, "{:.0f}"),
    }
    found, remarks = imported(tmp_path, lines_of(stamp | columns))
    check_motion(found)
    assert "the times are those of columns header.stamp.secs and header.stamp.nsecs" in remarks
    assert "no column holds times" not in remarks


@pytest.mark.parametrize(
    ("late", "said"),
    [
        (0.0, ""),
        (
            0.9,
            "column log_time_ns is up to 0.9 s later than usual after the times used "
            "(header.stamp.sec and header.stamp.nanosec), first 3.000 s after the log begins",
        ),
    ],
)
def test_messages_have_the_times_of_their_stamps_and_not_of_their_logging(tmp_path, late, said):
    columns = columns_of_run()
    del columns["time"]
    t = RUN["t"]
    whole = np.floor(t + 1e-4)
    logged = t + 0.02
    rows = slice(30, 39)  # the link was silent, and messages came together at its end
    if late:
        logged[rows] += late - (t[rows] - t[rows.start])
    stamp = {
        "log_time_ns": [f"{round(1e3 * time)}000000" for time in logged],
        "header.stamp.nanosec": texts_of(np.round((t - whole) * 10.0) * 1e8, "{:.0f}"),
        "header.stamp.sec": texts_of(whole, "{:.0f}"),
    }
    found, remarks = imported(tmp_path, lines_of(stamp | columns))
    check_motion(found)
    assert "the times are those of columns header.stamp.sec and header.stamp.nanosec" in remarks
    assert said in remarks
    assert ("later than usual" in remarks) == bool(said)


def test_the_first_of_two_stamps_of_a_table_is_that_of_the_row(tmp_path):
    columns = columns_of_run()
    del columns["time"]
    stamps = {}
    for name, late in (("header", 0.0), ("gps.header", 0.3)):
        t = RUN["t"] - late
        whole = np.floor(t + 1e-4)
        stamps[f"{name}.stamp.sec"] = texts_of(whole, "{:.0f}")
        stamps[f"{name}.stamp.nanosec"] = texts_of(np.round((t - whole) * 10.0) * 1e8, "{:.0f}")
    found, remarks = imported(tmp_path, lines_of(stamps | columns))
    check_motion(found)
    assert "the times are those of columns header.stamp.sec and header.stamp.nanosec" in remarks


def test_a_duration_in_milliseconds_is_no_fraction_of_the_time(tmp_path):
    ping = 30.0 + 800.0 * np.random.default_rng(1).random(COUNT)
    rows = [f"{i},{i},{value:.0f}" for i, value in enumerate(ping)]
    file = tmp_path / "log.csv"
    file.write_text("\n".join(["time,heading_deg,ping_ms", *rows]))
    log = read(file)
    assert log.signals["heading_deg"].t == pytest.approx(np.arange(COUNT, dtype=float))


@pytest.mark.parametrize(
    ("other", "values"),
    [
        ("board_millis", 1000.0 * np.round(1.0004 * (RUN["t"] - RUN["t"][0]), 3)),  # runs fast
        ("pc_time", RUN["t"] + np.where(RUN["t"] > RUN["t"][60], 3.0, 0.0)),  # set forward once
        ("gps_time", np.where(RUN["t"] < RUN["t"][30], 0.0, RUN["t"] + 0.02)),  # 0 before a fix
        ("utc_time", np.floor(RUN["t"])),  # whole seconds
    ],
)
def test_clocks_that_drift_or_begin_late_are_no_late_messages(tmp_path, other, values):
    columns = columns_of_run() | {other: texts_of(values, "{:.3f}")}
    found, remarks = imported(tmp_path, lines_of(columns))
    check_motion(found)
    assert "later than usual" not in remarks


def test_a_row_without_a_time_is_left_out_also_beside_a_second_clock(tmp_path):
    columns = columns_of_run()
    columns["sensor_clock_s"] = texts_of(RUN["t"] - 3.2, "{:.3f}")
    columns["time"][100] = ""
    found, remarks = imported(tmp_path, lines_of(columns))
    assert len(found.t) >= COUNT - 2
    assert "later than usual" not in remarks


def test_times_of_logging_that_are_used_are_compared_with_another_clock(tmp_path):
    columns = columns_of_run()
    late = RUN["t"].copy()
    late[30:39] += 0.9 - (RUN["t"][30:39] - RUN["t"][30])
    columns["time"] = texts_of(late, "{:.3f}")
    columns["sensor_clock_s"] = texts_of(RUN["t"] - 3.2, "{:.3f}")
    _, remarks = imported(tmp_path, lines_of(columns))
    assert "the times used (time) are up to 0.9 s later than usual after column sensor_clock_s" in (
        remarks
    )


def test_a_fraction_of_a_second_adds_to_a_column_of_whole_seconds(tmp_path):
    columns = columns_of_run()
    columns["time"] = texts_of(np.floor(RUN["t"] + 1e-6), "{:.0f}")
    tenths = np.round((RUN["t"] - np.floor(RUN["t"] + 1e-6)) * 10.0)
    columns["millis"] = texts_of(100.0 * tenths, "{:.0f}")
    found, _ = imported(tmp_path, lines_of(columns))
    check_motion(found)


@pytest.mark.parametrize("name", ["millis", "time", "uptime_ms"])
def test_times_since_the_start_of_the_logger_may_be_milliseconds(tmp_path, name):
    columns = columns_of_run()
    del columns["time"]
    times = {name: texts_of(np.round(1000.0 * (RUN["t"] - RUN["t"][0])) + 5123.0, "{:.0f}")}
    found, remarks = imported(tmp_path, lines_of(times | columns))
    check_motion(found)
    said = "the times of column time are taken as ms: they are whole numbers, 100 from row to row"
    assert (said in remarks) == (name == "time")


def test_whole_seconds_far_apart_stay_seconds(tmp_path):
    rows = [f"{20 * i},{i}" for i in range(40)]
    file = tmp_path / "log.csv"
    file.write_text("\n".join(["time,heading_deg", *rows]))
    assert np.ptp(read(file).signals["heading_deg"].t) == 20 * 39


def test_rows_that_share_a_second_are_spread_evenly(tmp_path):
    columns = columns_of_run()
    columns["time"] = texts_of(np.floor(RUN["t"] + 1e-6), "{:.0f}")
    found, remarks = imported(tmp_path, lines_of(columns))
    check_motion(found)
    assert "10 rows share each time of column time, every 1 s" in remarks


def test_a_log_that_begins_and_ends_within_a_second_is_spread_by_the_usual_rate():
    t = np.floor(np.arange(7, 138) / 10.0)
    values = np.sin(np.arange(7, 138))
    found = spread_coarse_times(t, [values])
    assert found is not None
    assert found.t == pytest.approx(np.arange(7, 138) / 10.0)


def test_copies_and_rows_of_several_sensors_are_not_spread():
    t = np.floor(np.arange(100) / 5.0)
    assert spread_coarse_times(t, [t]) is None
    turns = np.arange(100) % 5
    sensors = [np.where(turns == i, np.sin(t), np.nan) for i in range(5)]
    assert spread_coarse_times(t, sensors) is None
    assert spread_coarse_times(np.arange(100.0), [np.sin(t)]) is None


def test_lines_before_the_header_and_cut_rows_are_left_out_with_a_remark(tmp_path):
    lines = lines_of(columns_of_run())
    lines[301] = lines[301][:25]
    lines.insert(400, lines[0])
    lines = ["Logger 1.2; serial 4711", "Trial: zigzag 3", "", *lines]
    file = tmp_path / "log.csv"
    file.write_text("\n".join(lines) + "\n")
    found, remarks = imported(tmp_path, lines)
    assert len(found) == COUNT - 1
    assert (
        "2 lines before the header are left out, the first is 'Logger 1.2; serial 4711'" in remarks
    )
    assert "row 305: 1 row is cut or joined and left out" in remarks
    assert "row 404: 1 row is the header again and left out" in remarks


def test_a_table_without_a_header_has_numbered_columns(tmp_path):
    file = tmp_path / "log.csv"
    file.write_text("\n".join(lines_of(columns_of_run())[1:]))
    log = read(file)
    assert len(log.signals["column_4"].values) == COUNT
    assert "has no header; its columns are called column_1 to column_6" in "\n".join(log.remarks)
    assert log.signals["column_4"].t == pytest.approx(RUN["t"])


def test_numbers_for_missing_values_are_left_empty(tmp_path):
    columns = columns_of_run()
    for row in (9, 40, 200):
        columns["heading_deg"][row] = "-999"
        columns["rpm_port"][row] = "65535"
    found, remarks = imported(tmp_path, lines_of(columns))
    assert np.abs(found["n_port_radps"]).max() < 110.0
    assert "row 11, column heading_deg: 3 cells are -999, which stands for a missing" in remarks
    assert len(found) == COUNT - 3


def test_a_number_within_the_range_of_the_others_is_measured():
    assert not placeholder_rows(np.append(np.linspace(0.0, 1500.0, 100), 999.0))
    assert not placeholder_rows(np.full(50, 9999.0))


def test_a_unit_behind_every_number_is_the_unit_of_the_column(tmp_path):
    columns = columns_of_run()
    columns["heading"] = [f"{text} deg" for text in columns.pop("heading_deg")]
    columns["rpm_port"] = [f"{text} rpm" for text in columns["rpm_port"]]
    found, _ = imported(tmp_path, lines_of(columns))
    check_motion(found)


def test_words_of_a_column_are_no_units(tmp_path):
    columns = columns_of_run() | {"mode": ["3 auto", "4 hold"] * (COUNT // 2)}
    file = tmp_path / "log.csv"
    file.write_text("\n".join(lines_of(columns)))
    assert "mode" not in read(file).signals


def minutes_of(degrees: float) -> str:
    return f"{100.0 * np.floor(degrees) + 60.0 * (degrees % 1.0):.6f}"


def test_degrees_and_minutes_become_degrees(tmp_path):
    columns = columns_of_run()
    columns["lat"] = list(map(minutes_of, LATITUDE))
    columns["lon"] = list(map(minutes_of, LONGITUDE))
    columns |= {"ns": ["N"] * COUNT, "ew": ["W"] * COUNT}
    found, remarks = imported(tmp_path, lines_of(columns))
    check_motion(found)
    assert "lat and lon are degrees and minutes" in remarks
    assert "longitude -10.7000" in remarks  # west


@pytest.mark.parametrize(
    ("text", "degrees"),
    [
        ("59°54'12.3\"N", 59.903417),
        ("S 59 54.205", -59.903417),
        ("59.903417° N", 59.903417),
        ("010-42,5W", -10.708333),
    ],
)
def test_coordinates_are_read_as_people_write_them(text, degrees):
    assert degrees_of_texts([text, ""])[0] == pytest.approx(degrees, abs=1e-6)
    assert degrees_of_texts(["hold", "auto"]) is None


def test_a_table_with_many_cut_rows_is_refused(tmp_path):
    lines = lines_of(columns_of_run())
    lines = [lines[0], *(line[: 20 + 40 * (i % 2)] for i, line in enumerate(lines[1:]))]
    file = tmp_path / "log.csv"
    file.write_text("\n".join(lines))
    with pytest.raises(BadInput, match="cells; the header has 6 columns"):
        read(file)


def test_a_clock_that_is_set_back_goes_on_and_late_or_doubled_rows_stay(tmp_path):
    columns = columns_of_run()
    back = np.where(np.arange(COUNT) >= 300, 5.0, 0.0)
    columns["time"] = texts_of(RUN["t"] - back, "{:.3f}")
    found, remarks = imported(tmp_path, lines_of(columns))
    check_motion(found)
    assert "the clock goes back by 4.9 s after sample 300, but the samples go on" in remarks
    lines = lines_of(columns_of_run())
    late = [*lines[:200], *lines[230:260], *lines[200:230], *lines[260:]]  # a block came late
    found, remarks = imported(tmp_path, late)
    check_motion(found)
    assert "samples are logged after a later one" in remarks
    doubled = [*lines[:300], *lines[250:300], *lines[300:]]
    found, remarks = imported(tmp_path, doubled)
    check_motion(found)
    assert "clock goes back" not in remarks


def test_local_positions_before_the_first_fix_are_left_out(tmp_path):
    columns = columns_of_run()
    del columns["lat"], columns["lon"]
    rows = np.arange(COUNT)
    columns["north_m"] = texts_of(np.where(rows < 30, 0.0, RUN["north"] + 150.0))
    columns["east_m"] = texts_of(np.where(rows < 30, 0.0, RUN["east"] - 80.0))
    found, remarks = imported(tmp_path, lines_of(columns))
    assert "omitted 30 positions of 0, 0 before the first fix" in remarks
    first = RUN["t"][30] - RUN["t"][0]
    assert f"m away, {first:.3f} s after the log begins" in remarks
    assert np.nanmin(found["x_m"]) > 100.0


def test_positions_that_begin_at_the_origin_are_kept(tmp_path):
    columns = columns_of_run()
    del columns["lat"], columns["lon"]
    columns["north_m"] = texts_of(RUN["north"] - RUN["north"][0])
    columns["east_m"] = texts_of(RUN["east"] - RUN["east"][0])
    found, remarks = imported(tmp_path, lines_of(columns))
    assert found["x_m"][0] == 0.0 and "before the first fix" not in remarks


def test_positions_that_came_in_bursts_go_back_to_the_rhythm_of_the_sensor(tmp_path):
    columns = columns_of_run()
    queue, shown, is_open, newest = list[int](), list[int](), False, 0
    for row in range(COUNT):
        if row % 2 == 0:
            queue.append(row)
        is_open |= row % 10 == 7
        if is_open and queue:
            newest = queue.pop(0)
            is_open = bool(queue)
        shown.append(newest)
    for name in ("lat", "lon"):
        columns[name] = [columns[name][row] for row in shown]
    found, remarks = imported(tmp_path, lines_of(columns))
    assert "repeat the one before and are not measurements" in remarks
    assert "the sensor measured every 0.2 s, but the program read it late" in remarks
    t = found.t + (RUN["t"][-1] - RUN["t"][0] - found.t[-1])
    known = np.isfinite(found["x_m"]) & (t > 5.0)
    spread = []
    for delay in np.arange(0.0, 1.0, 0.05):  # the mean delay stays
        off = 0.0
        for name, truth in (("x_m", RUN["north"]), ("y_m", RUN["east"])):
            off = off + np.std(
                found[name][known] - np.interp(t[known] - delay, RUN["t"] - RUN["t"][0], truth)
            )
        spread.append(off)
    assert min(spread) < 0.1
