"""One run in two files is one recording on one clock, and late columns get the time at which they were
true."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.errors import BadInput
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.recording_notes import recording_notes_text
from boatsim.recordings.importing.several_logs import Span, open_logs
from boatsim.recordings.importing.time_zones import ZoneShift, shifts_of_zones
from boatsim.recordings.table import read

CHANNELS = {"thrust_motor_N": (-50.0, 100.0)}
EPOCH = 1.75e9  # [s] since 1970
COLUMNS = {"psi_rad": "heading * deg", "thrust_motor_N": "thrust"}


def heading(t):
    return 40.0 * np.sin(0.3 * t)


def thrust(t):
    return 50.0 + 40.0 * np.sin(0.5 * t)


def write(path: Path, clock: str, t, start: float, **columns) -> Path:
    table = np.column_stack([t - t[0] + start, *columns.values()])
    lines = [",".join([clock, *columns]), *(",".join(f"{x:.6f}" for x in row) for row in table)]
    path.write_text("\n".join(lines) + "\n")
    return path


def two_files(folder: Path, starts: tuple[float, float]) -> list[Path]:
    """Instruments from 0 to 60 s, and the engine from 12.33 to 50.3 s of the same run."""
    t, late = np.arange(0.0, 60.0, 0.1), np.arange(12.33, 50.33, 0.25)
    return [
        write(folder / "instruments.csv", "time", t, starts[0], heading=heading(t)),
        write(folder / "engine.csv", "time", late, starts[1], thrust=thrust(late)),
    ]


def check_columns(run, begin: float) -> None:
    """The columns are those of the run at the times of the rows, which begin `begin` s after it."""
    t = run.t + begin
    assert run["psi_rad"] == pytest.approx(np.radians(heading(t)), abs=1e-5)
    held = 12.33 + 0.25 * np.floor((t - 12.33) / 0.25 + 1e-6)
    inside = np.abs(t - held) < 0.149  # in the row of a change the command is a mean
    assert run["thrust_motor_N"][inside] == pytest.approx(thrust(held[inside]), abs=1e-4)


def test_two_files_in_utc_are_joined_by_their_times(tmp_path):
    log = open_logs(two_files(tmp_path, (EPOCH, EPOCH + 12.33)))
    run = convert_log(log, parse_map({"columns": COLUMNS}, "map.toml"), "map.toml", CHANNELS)
    check_columns(run, 12.4)
    assert run.t[-1] == pytest.approx(
        50.0 - 12.4, abs=0.11
    )  # no row after the end of the engine's file
    remarks = " ".join(run.remarks)
    assert "12.4 s before and 9.9 s after the rows are left out" in remarks
    assert "engine.csv: 2025-06-15 15:06:52 to 2025-06-15 15:07:30 UTC" in remarks


def test_two_clocks_need_a_begin_and_the_line_is_said(tmp_path):
    log = open_logs(two_files(tmp_path, (EPOCH, 0.0)))
    with pytest.raises(BadInput, match=r'\[begins\] / "engine.csv" = SECONDS'):
        convert_log(log, parse_map({"columns": COLUMNS}, "map.toml"), "map.toml", CHANNELS)
    table = {"begins": {"engine.csv": 12.33}, "columns": COLUMNS}
    check_columns(convert_log(log, parse_map(table, "map.toml"), "map.toml", CHANNELS), 12.4)
    with pytest.raises(BadInput, match="engine.csv"):
        convert_log(
            log, parse_map(table | {"begins": {"motor.csv": 1.0}}, "map.toml"), "map.toml", CHANNELS
        )


def test_files_of_different_hours_name_their_spans_and_the_line(tmp_path):
    log = open_logs(two_files(tmp_path, (EPOCH, EPOCH + 3612.33)))
    with pytest.raises(BadInput) as caught:
        convert_log(log, parse_map({"columns": COLUMNS}, "map.toml"), "map.toml", CHANNELS)
    assert "16:06:52" in str(caught.value) and '[begins] / "engine.csv"' in str(caught.value)


def zoned_files(folder: Path, ahead: float, start: float = EPOCH) -> list[Path]:
    """A compass, and an engine with a gyroscope that begins 8 s later, its clock ahead [s]."""
    run = turning_boat()
    late = run["t"] >= 8.0
    rate = np.degrees(np.gradient(run["psi"], run["t"]))
    engine = {"thrust": run["thrust"][late], "gyro_z": rate[late]}
    degrees = np.degrees(run["psi"])
    return [
        write(folder / "compass.csv", "time", run["t"], start, heading=degrees),
        write(folder / "engine.csv", "time", run["t"][late], start + ahead + 8.0, **engine),
    ]


ZONED = {
    "psi_rad": "heading * deg",
    "r_radps": "gyro_z * degps",
    "thrust_motor_N": "thrust",
}


@pytest.mark.filterwarnings("error")
def test_two_files_with_motion_in_other_zones_name_their_spans_and_the_line(tmp_path):
    log = open_logs(zoned_files(tmp_path, 7200.0))
    with pytest.raises(BadInput) as caught:
        convert_log(log, parse_map({"columns": ZONED}, "map.toml"), "map.toml", CHANNELS)
    message = str(caught.value)
    assert "compass.csv 2025-06-15 15:06:40" in message
    assert "engine.csv 2025-06-15 17:06:48" in message
    assert '[begins] / "engine.csv" = 8 (its clock is 2 h ahead, as that of another' in message


@pytest.mark.parametrize("hours", [2.0, -5.5, 0.5, 14.0])
@pytest.mark.parametrize("start", [EPOCH, 44000.0])
def test_files_of_other_zones_begin_where_whole_or_half_hours_put_them(tmp_path, hours, start):
    log = open_logs(zoned_files(tmp_path, 3600.0 * hours, start))
    text = propose_map(log)
    way = "ahead" if hours > 0.0 else "behind"
    said = f"CHECK: its clock is {abs(hours):g} h {way}, as that of another time zone; the turning"
    assert said in text
    table = tomllib.loads(text)
    assert table["begins"] == {"engine.csv": 8.0}
    run = convert_log(
        log,
        parse_map({"begins": table["begins"], "columns": ZONED}, "map.toml"),
        "map.toml",
        CHANNELS,
    )
    known = turning_boat()
    psi = np.interp(run.t + 8.0, known["t"], known["psi"])
    assert run["psi_rad"] == pytest.approx(psi, abs=1e-3)
    held = np.interp(run.t + 8.0, known["t"], known["thrust"])
    assert run["thrust_motor_N"] == pytest.approx(held, abs=0.3)


def test_a_difference_of_no_half_hours_is_no_zone():
    first = Span(EPOCH, EPOCH + 120.0)
    assert shifts_of_zones({"a": first, "b": Span(EPOCH + 600.0, EPOCH + 720.0)}) == {}
    assert shifts_of_zones({"a": first, "b": Span(EPOCH + 60.0, EPOCH + 3720.0)}) == {}
    long = Span(EPOCH, EPOCH + 7200.0)  # the shift with the longest overlap
    ahead = {"a": long, "b": Span(EPOCH + 10805.0, EPOCH + 18005.0)}
    assert shifts_of_zones(ahead)["b"] == ZoneShift(3.0, 5.0)
    by_motion = {"b": 1804.0}
    assert shifts_of_zones(ahead, by_motion)["b"] == ZoneShift(2.5, 1805.0)


def test_files_without_any_common_time_get_a_comment_that_says_so(tmp_path):
    text = propose_map(open_logs(two_files(tmp_path, (EPOCH, EPOCH + 700.0))), "v")
    assert '# begins."engine.csv" = SECONDS  # CHECK: its times are 2025-06-15 15:18:20' in text


def test_a_proposal_for_two_files_has_the_signals_of_both_and_the_begin(tmp_path):
    text = propose_map(open_logs(two_files(tmp_path, (0.0, 0.0))), "v")
    assert 'psi_rad = "heading * deg"' in text and 'begins."engine.csv" = 0.0  # CHECK' in text
    text = propose_map(open_logs(two_files(tmp_path, (EPOCH, EPOCH))), "v")
    assert "begins." not in text


def test_a_name_that_both_files_have_gets_the_name_of_its_file(tmp_path):
    t = np.arange(0.0, 10.0, 0.1)
    files = [
        write(tmp_path / "a.csv", "time", t, EPOCH, heading=heading(t), volt=t),
        write(tmp_path / "b.csv", "time", t, EPOCH, thrust=thrust(t), volt=t),
    ]
    assert {"a.volt", "b.volt", "heading", "thrust"} <= open_logs(files).signals.keys()


def test_the_time_of_each_file_may_be_an_expression(tmp_path):
    t = np.arange(0.0, 30.0, 0.1)
    files = [
        write(tmp_path / "a.csv", "tick", t * 10.0, 0.0, heading=heading(t)),
        write(tmp_path / "b.csv", "count", t * 1000.0, 0.0, thrust=thrust(t)),
    ]
    table = {
        "time": {"a.csv": "tick * 0.1", "b.csv": "count * ms"},
        "begins": {"b.csv": 0.0},
        "columns": COLUMNS,
    }
    run = convert_log(open_logs(files), parse_map(table, "map.toml"), "map.toml", CHANNELS)
    assert run["psi_rad"] == pytest.approx(np.radians(heading(run.t)), abs=1e-5)
    assert run["thrust_motor_N"] == pytest.approx(thrust(run.t), abs=1e-4)


def test_a_late_column_of_a_map_gets_the_time_at_which_it_was_true(tmp_path):
    t = np.arange(0.0, 30.0, 0.1)
    file = write(
        tmp_path / "a.csv",
        "time",
        t,
        0.0,
        heading=heading(t - 0.4),
        thrust=thrust(t),
        psi_true=heading(t),
    )
    table = {"latency": {"psi_rad": 0.4}, "columns": COLUMNS}
    run = convert_log(open_logs([file]), parse_map(table, "map.toml"), "map.toml", CHANNELS)
    known = np.isfinite(run["psi_rad"])
    assert known.sum() > 280
    # the first row is that of the first command, 0.4 s after the first heading is true
    assert run["psi_rad"][known] == pytest.approx(np.radians(heading(run.t[known])), abs=1e-5)
    with pytest.raises(BadInput, match="latency: column 'x_m'"):
        parse_map({"latency": {"x_m": 0.4}, "columns": COLUMNS}, "map.toml")


def test_the_thrust_of_a_range_grows_with_the_power_that_the_map_states(tmp_path):
    t = np.arange(0.0, 30.0, 0.1)
    rpm = 2000.0 * np.sin(0.5 * t)
    file = write(tmp_path / "a.csv", "time", t, 0.0, heading=heading(t), rpm=rpm)
    ends = {"low": -2000, "neutral": 0, "high": 2000, "least": -50, "most": 100}
    what = {"signal": "rpm", "exponent": 2.0, **ends}
    table = {"columns": {"psi_rad": "heading * deg", "thrust_motor_N": what}}
    run = convert_log(open_logs([file]), parse_map(table, "map.toml"), "map.toml", CHANNELS)
    full = np.where(rpm > 0.0, 100.0, 50.0)
    assert run["thrust_motor_N"] == pytest.approx(full * rpm * np.abs(rpm) / 2000.0**2, abs=1e-3)


def test_a_curve_gives_the_thrust_of_a_measured_table(tmp_path):
    t = np.arange(0.0, 30.0, 0.1)
    stick = np.linspace(-1.0, 1.0, len(t))
    file = write(tmp_path / "a.csv", "time", t, 0.0, heading=heading(t), stick=stick)
    points = [[-1.0, -40.0], [-0.2, 0.0], [0.2, 0.0], [0.6, 30.0], [1.0, 100.0]]
    table = {
        "columns": {"psi_rad": "heading", "thrust_motor_N": {"signal": "stick", "points": points}}
    }
    run = convert_log(open_logs([file]), parse_map(table, "map.toml"), "map.toml", CHANNELS)
    assert run["thrust_motor_N"] == pytest.approx(np.interp(stick, *np.transpose(points)), abs=1e-3)
    table["columns"]["thrust_motor_N"]["points"] = points[::-1]
    with pytest.raises(BadInput, match="by increasing signal"):
        parse_map(table, "map.toml")


def test_several_parts_of_a_log_to_use_become_those_of_the_recording(tmp_path):
    t = np.arange(0.0, 30.0, 0.1)
    file = write(tmp_path / "a.csv", "time", t, 0.0, heading=heading(t), thrust=thrust(t))
    table = {"use": [[5.0, 10.0], [15.0, 20.0]], "columns": COLUMNS}
    run = convert_log(open_logs([file]), parse_map(table, "map.toml"), "map.toml", CHANNELS)
    assert run.t[-1] == pytest.approx(15.0, abs=0.11)
    assert np.allclose(run.notes.use, [[0.0, 5.0], [10.0, 15.0]], atol=0.11)
    text = recording_notes_text(tmp_path / "run.csv", "v", None, run.notes.use)
    assert tomllib.loads(text)["runs"]["run"]["use"] == [list(part) for part in run.notes.use]
    with pytest.raises(BadInput, match="in order of time"):
        parse_map(table | {"use": [[5.0, 10.0], [9.0, 20.0]]}, "map.toml")


def test_the_command_joins_two_files_by_the_map_that_it_proposed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = [path.name for path in two_files(tmp_path, (EPOCH, EPOCH + 12.33))]
    done = CliRunner().invoke(app, ["import", *files, "--propose", "map.toml"])
    assert done.exit_code == 0, done.output
    assert "boatsim import instruments.csv engine.csv --map map.toml" in done.output
    text = Path("map.toml").read_text().replace("throttle", "thrust_motor_N")
    Path("map.toml").write_text(text)
    done = CliRunner().invoke(app, ["import", *files, "--map", "map.toml", "--out", "run/run.csv"])
    assert done.exit_code == 0, done.output
    check_columns(read("run/run.csv"), 12.4)
    done = CliRunner().invoke(app, ["import", *files, "--map", "map.toml", "--out", "engine.csv"])
    assert done.exit_code == 2 and "would overwrite the input" in done.output


def turning_boat() -> dict[str, np.ndarray]:
    """A boat at 1 m/s whose turning has no period."""
    t = np.arange(0.0, 120.0, 0.1)
    turn = 0.3 * np.sin(0.004 * t**2) + 0.2 * np.sin(0.31 * t)
    psi = np.cumsum(turn) * 0.1
    north, east = np.cumsum(np.cos(psi)) * 0.1, np.cumsum(np.sin(psi)) * 0.1
    return {"t": t, "psi": psi, "north": north, "east": east, "thrust": 50.0 + 10.0 * turn}


def sensor_files(folder: Path, starts: tuple[float, float, float]) -> list[Path]:
    """One file for each sensor; the heading begins 5 s and the engine 8 s after the track."""
    run = turning_boat()
    late, last = run["t"] >= 5.0, run["t"] >= 8.0
    track = {"north": run["north"][::5], "east": run["east"][::5]}
    degrees = np.degrees(run["psi"])
    return [
        write(folder / "track.csv", "time", run["t"][::5], starts[0], **track),
        write(folder / "compass.csv", "time", run["t"][late], starts[1], heading=degrees[late]),
        write(folder / "engine.csv", "time", run["t"][last], starts[2], thrust=run["thrust"][last]),
    ]


def test_files_of_one_clock_without_utc_begin_at_their_times(tmp_path):
    log = open_logs(sensor_files(tmp_path, (51.2, 56.2, 59.2)))
    table = tomllib.loads(propose_map(log))
    assert table["begins"] == {"compass.csv": 5.0, "engine.csv": 8.0}
    run = convert_log(log, parse_map(table, "map.toml"), "map.toml", CHANNELS)
    told = turning_boat()
    assert run["psi_rad"][0] == pytest.approx(np.interp(8.0, told["t"], told["psi"]), abs=1e-3)
    with pytest.raises(BadInput, match=r'"compass.csv" = 5 \(if both have one clock\)'):
        convert_log(log, parse_map({"columns": COLUMNS}, "map.toml"), "map.toml", CHANNELS)


def test_files_that_begin_at_zero_are_placed_by_the_turning_that_both_show(tmp_path):
    log = open_logs(sensor_files(tmp_path, (0.0, 0.0, 0.0)))
    text = propose_map(log)
    begins = tomllib.loads(text)["begins"]
    assert begins["compass.csv"] == pytest.approx(5.0, abs=0.3)
    assert "CHECK: by the turning that both files show" in text
    assert begins["engine.csv"] == 0.0 and "0 is a guess" in text


def test_regular_zigzags_do_not_show_when_a_file_begins(tmp_path):
    t = np.arange(0.0, 120.0, 0.1)
    psi = 0.5 * np.sin(0.5 * t)
    north, east = np.cumsum(np.cos(psi)) * 0.1, np.cumsum(np.sin(psi)) * 0.1
    files = [
        write(tmp_path / "track.csv", "time", t, 0.0, north=north, east=east),
        write(tmp_path / "compass.csv", "time", t[50:], 0.0, heading=np.degrees(psi[50:])),
    ]
    assert 'begins."compass.csv" = 0.0  # CHECK' in propose_map(open_logs(files))


def test_a_folder_is_one_run_and_what_is_no_log_is_named(tmp_path):
    sensor_files(tmp_path, (51.2, 56.2, 59.2))
    (tmp_path / "notes.txt").write_text("calm, no wind")
    (tmp_path / "photo.jpg").write_bytes(b"x")
    log = open_logs([tmp_path])
    assert {"north", "heading", "thrust"} <= log.signals.keys()
    assert any("notes.txt" in remark for remark in log.remarks)
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(BadInput, match="the folder has no log that can be read"):
        open_logs([empty])


@pytest.mark.parametrize("start", [0.0, EPOCH])
def test_files_of_the_same_signals_that_follow_each_other_are_one_log(tmp_path, start):
    t = np.arange(0.0, 60.0, 0.1)
    parts = []
    for i, rows in enumerate((slice(0, 200), slice(200, 450), slice(450, 600)), 1):
        columns = {"heading": heading(t[rows]), "thrust": thrust(t[rows])}
        parts.append(
            write(tmp_path / f"log_{i}.csv", "time", t[rows], start + t[rows][0], **columns)
        )
    log = open_logs([parts[1], parts[0], parts[2]])
    run = convert_log(log, parse_map({"columns": COLUMNS}, "map.toml"), "map.toml", CHANNELS)
    assert run.t == pytest.approx(t, abs=1e-4)
    assert run["psi_rad"] == pytest.approx(np.radians(heading(t)), abs=1e-5)
    assert "log_1.csv, log_2.csv, log_3.csv have the same signals" in " ".join(run.remarks)
