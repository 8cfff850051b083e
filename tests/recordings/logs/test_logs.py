"""Logs of every format: read, proposed for, converted, and what is wrong with one said in a
line."""

import builtins
import io
import math
import random
import re
import shutil
import struct
import tomllib
from contextlib import redirect_stderr, redirect_stdout
from datetime import UTC, datetime
from pathlib import Path

import make_logs
import numpy as np
import pyarrow as pa
import pytest
from make_logs import geodetic, sentence
from pyarrow import parquet

from boatsim.cli.importing import import_log
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.log import known_suffixes, open_log
from boatsim.recordings.importing.mapping import parse_map, read_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.signal_classification import classify_signals
from boatsim.recordings.importing.signal_listing import signal_table
from boatsim.recordings.table import read

LOGS = Path(__file__).parents[2] / "data" / "logs"
TRUTH = np.genfromtxt(LOGS / "truth.csv", delimiter=",", names=True)
FULL = 104.0
CHANNELS = {"n_port_radps": (-FULL, FULL), "n_starboard_radps": (-FULL, FULL)}
DRIVES = [VesselChannel(name, *ends) for name, ends in CHANNELS.items()]
FREEDOMS = ("surge", "sway", "yaw")
# [s] by which rows of the .BIN are off: its gyro comes so much behind the attitude
ATT_CLOCK = 0.0013
# log -> most by which x and y [m], psi [rad], r [rad/s], commands [rad/s] may be off: the
# resolution of the format
RESOLUTION = {
    "rover.BIN": (0.012, 4e-4, 1e-4, 1e-9),  # 1e-7 deg of latitude; times of the streams by 2 ms
    "px4.ulg": (2e-3, 1e-6, 1e-7, 1e-5),  # single precision; positions 1.1 ms late
    "ros2.mcap": (1e-6, 1e-6, 1e-6, 1e-9),
    "ros1.bag": (1e-6, 1e-6, 1e-6, 1e-9),
    "ros2_bag": (1e-6, 1e-6, 1e-6, 1e-9),
    "instruments.nmea": (5e-4, 1e-5, 2e-6, 6e-4),  # 1e-7 minutes, 0.001 deg, 0.01 deg/min, 0.01 rpm
    "table.csv": (3e-4, 1e-5, 1e-6, 6e-3),  # 1e-9 deg, 0.001 deg, 1e-4 deg/s, 0.01 per cent
    "stacked.parquet": (1e-6, 1e-6, 1e-6, 1e-9),
}
MAPS = {}  # log -> the text of the map that is proposed for it


def proposed(name: str) -> str:
    if name not in MAPS:
        MAPS[name] = propose_map(open_log(LOGS / name), "otter", DRIVES, FREEDOMS)
    return MAPS[name]


def converted(name: str, **changes: object):
    return convert_log(
        open_log(LOGS / name),
        parse_map(tomllib.loads(proposed(name)) | changes, "map.toml"),
        "map.toml",
        CHANNELS,
    )


def line_of(action, *given: object) -> str:
    with pytest.raises(BadInput) as caught:
        action(*given)
    message = str(caught.value)
    assert "\n" not in message and len(message) < 600
    return message


def true(name: str, t):
    return np.interp(t, TRUTH["t_s"], TRUTH[name])


@pytest.mark.parametrize("name", RESOLUTION)
def test_what_was_simulated_comes_back_from_every_log_by_the_map_that_is_proposed(name):
    run = converted(name)
    place, heading, rate, command = RESOLUTION[name]
    begin = (
        0.1 if name.startswith(("ros", "stacked")) else 0.0
    )  # the first row behind the first command
    t = run.t + begin
    first = {
        n: run[n][np.isfinite(run[n])][0] - true(n, t[np.isfinite(run[n])])[0]
        for n in ("x_m", "y_m")
    }
    for n, most in (("x_m", place), ("y_m", place), ("r_radps", rate)):
        if n in run.signals:  # the origin of latitudes is the first fix
            assert np.nanmax(np.abs(run[n] - true(n, t) - first.get(n, 0.0))) < most, n
    off = np.remainder(run["psi_rad"] - true("psi_rad", t) + math.pi, 2 * math.pi) - math.pi
    assert np.nanmax(np.abs(off)) < heading
    for n in CHANNELS:
        between = np.array([0.5 * sum(pair) for pair in zip(t[:-1], t[1:], strict=True)])
        steady = np.all(
            [np.abs(np.remainder(between + 2.5, 5.0) - 2.5) > 0.25, np.abs(between - 2.0) > 0.25],
            axis=0,
        )
        there = TRUTH[n][np.searchsorted(TRUTH["t_s"], between) - 1]
        assert np.abs(run[n][:-1] - there)[steady].max() < command, n
        area = float(
            run[n][:-1] @ np.diff(t)
        )  # a command that came between two rows counts from its own time
        within = (TRUTH["t_s"] >= t[0] - 1e-9) & (TRUTH["t_s"] < t[-1] - 1e-9)
        assert area == pytest.approx(float(TRUTH[n][within].sum() * 0.02), rel=2e-3)


def test_all_samples_of_a_slow_signal_are_there_and_no_others():
    run = converted("rover.BIN")
    assert [int(np.isfinite(run[n]).sum()) for n in ("x_m", "psi_rad", "r_radps")] == [
        151,
        301,
        751,
    ]
    assert np.median(np.diff(run.t[np.isfinite(run["x_m"])])) == pytest.approx(0.2)
    run = converted("table.csv")  # fixes come twice a second and are repeated between
    assert int(np.isfinite(run["x_m"]).sum()) == 61
    assert any("240 of 301 samples repeat the one before" in line for line in run.remarks)


def test_rows_at_a_stated_rate_are_even_and_say_how_far_samples_were_moved():
    run = converted("px4.ulg", rate=10.0)
    np.testing.assert_allclose(np.diff(run.t), 0.1, atol=1e-6)
    assert any("nearest row, up to 0.05 s" in line for line in run.remarks)
    assert any("samples between the 10 rows a second are left out" in line for line in run.remarks)


def test_part_of_a_log_is_used():
    run = converted("rover.BIN", use=(5.0, 15.0))
    assert 9.9 < run.t[-1] <= 10.0 and any("t_s = 0 is 5.0" in line for line in run.remarks)
    assert "there is no fix" in line_of(lambda: converted("rover.BIN", use=(500.0, 600.0)))


def test_the_origin_of_the_map_is_where_positions_are_counted_from():
    table = tomllib.loads(proposed("instruments.nmea"))
    table["position"]["origin"] = list(
        geodetic(-111.0, -50.0)
    )  # of a place so far south and west of the start
    run = convert_log(
        open_log(LOGS / "instruments.nmea"), parse_map(table, "map.toml"), "map.toml", CHANNELS
    )
    assert run["x_m"][0] == pytest.approx(111.0, abs=2e-3) and run["y_m"][0] == pytest.approx(
        50.0, abs=2e-3
    )


def test_outputs_are_commands_and_the_stick_stays_beside_them():
    found = {g.name: g.column for g in classify_signals(open_log(LOGS / "rover.BIN"))}
    assert found["RCOU.C1"] == found["RCOU.C3"] == "command" and found["RCIN.C1"] == "stick"
    run = converted("rover.BIN")
    assert {"n_port_radps", "n_starboard_radps", "stick_rcin_c1"} <= run.signals.keys()
    assert "ATT.DesYaw" not in found  # what is wanted is not what is


def test_a_proposal_without_a_vessel_names_the_drives_by_what_the_log_says_of_them():
    text = propose_map(open_log(LOGS / "rover.BIN"))
    table = tomllib.loads(text)
    assert table["columns"]["throttle_port"] == {
        "signal": "RCOU.C1",
        "low": 1100,
        "neutral": 1500,
        "high": 1900,
        "least": -1,
        "most": 1,
    }
    assert {"throttle_starboard", "psi_rad", "r_radps"} <= table["columns"].keys()
    parse_map(table, "map.toml")


@pytest.mark.parametrize("name", [*RESOLUTION, "truth.csv"])
def test_every_signal_is_listed_with_unit_rate_and_range(name):
    log = open_log(LOGS / name)
    lines = signal_table(log)
    assert len(lines) == 1 + len(log.signals)
    assert all(len(line) < 200 for line in lines)


def test_a_recording_of_ours_is_proposed_as_it_is():
    log = open_log(LOGS / "truth.csv")
    table = tomllib.loads(propose_map(log, "otter", DRIVES, FREEDOMS))
    assert all(table["columns"][n] == n for n in ("x_m", "y_m", "psi_rad", "r_radps", *CHANNELS))


# the command
# --------------------------------------------------------------------------------------------------------


def ran(log: Path, *given: object) -> tuple[str, str]:
    out, said = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(said):
        assert import_log([log], *given, []) == 0  # type: ignore[arg-type]
    return out.getvalue(), said.getvalue()


def test_a_log_becomes_a_recording_that_can_be_read_and_knows_its_vessel(tmp_path):
    log, map, run = LOGS / "rover.BIN", tmp_path / "map.toml", tmp_path / "runs" / "run.csv"
    out, _ = ran(log, None, None, map, "otter")
    assert "RCOU.C1" in out and list(tmp_path.iterdir()) == [map]
    out, said = ran(log, run, map, None, None)
    assert "901 rows" in out and "refuse" not in said
    found = read(run, load_vessel("otter").limits())
    assert found.notes.vessel == "otter" and found.notes.facts["position_fix"] == "gnss"
    assert np.isnan(found["x_m"]).any() and np.isfinite(found["n_port_radps"]).all()


def test_each_recording_of_a_folder_is_entered_in_its_notes(tmp_path):
    log, map, runs = LOGS / "rover.BIN", tmp_path / "map.toml", tmp_path / "runs"
    ran(log, None, None, map, "otter")
    ran(log, runs / "first.csv", map, None, None)
    notes = runs / "recording.toml"
    notes.write_text(notes.read_text() + "\n[noise]\nposition_sd_m = 0.5\n")
    ran(log, runs / "second.csv", map, None, None)
    assert (runs / "first.csv").read_bytes() == (runs / "second.csv").read_bytes()
    for name in ("first", "second"):
        found = read(runs / f"{name}.csv", load_vessel("otter").limits()).notes
        assert found.vessel == "otter" and found.noise == {"position_sd_m": 0.5}
    written = notes.read_bytes()
    _, said = ran(log, runs / "second.csv", map, None, None)
    assert "exists and is kept" in said and notes.read_bytes() == written


def test_doubled_rows_and_rows_out_of_order_are_reported(tmp_path):
    lines = (LOGS / "truth.csv").read_text().splitlines()
    log, map, run = tmp_path / "log.csv", tmp_path / "map.toml", tmp_path / "runs" / "run.csv"
    log.write_text(
        "\n".join([*lines[:50], *lines[45:50], *lines[60:70], *lines[50:60], *lines[70:]])
    )
    ran(log, None, None, map, "otter")
    _, said = ran(log, run, map, None, None)
    assert "5 samples have the time of another one" in said
    assert "14 samples are logged after a later one" in said
    ran(LOGS / "truth.csv", tmp_path / "good" / "run.csv", map, None, None)
    assert run.read_bytes() == (tmp_path / "good" / "run.csv").read_bytes()


def test_notes_that_can_not_be_extended_are_kept(tmp_path):
    log, map, run = LOGS / "rover.BIN", tmp_path / "map.toml", tmp_path / "run.csv"
    ran(log, None, None, map, "otter")
    notes = tmp_path / "recording.toml"
    notes.write_text('runs = { other = { vessel = "mariner" } }\n')
    _, said = ran(log, run, map, None, None)
    assert "exists and is kept" in said and "[runs.run]" in said
    assert notes.read_text().startswith("runs = {")


def test_the_vessel_of_a_map_lies_beside_the_map(tmp_path, monkeypatch):
    log, map = LOGS / "rover.BIN", tmp_path / "maps" / "map.toml"
    ran(log, None, None, map, "otter")
    shutil.copytree(load_vessel("otter").path, tmp_path / "maps" / "boats" / "mine")
    text = map.read_text().replace('vessel = "otter"', 'vessel = "boats/mine"')
    map.write_text(text)
    monkeypatch.chdir(tmp_path)
    ran(log, tmp_path / "runs" / "run.csv", map, None, None)
    found = read(tmp_path / "runs" / "run.csv").notes.vessel
    assert Path(found) == tmp_path / "maps" / "boats" / "mine" / "vessel.toml"


def test_without_a_map_nothing_is_written(tmp_path):
    ran(LOGS / "px4.ulg", tmp_path / "run.csv", None, None, None)
    assert not list(tmp_path.iterdir())
    assert "--out" in line_of(
        import_log, [LOGS / "px4.ulg"], None, tmp_path / "m.toml", None, None, []
    )


def test_the_log_itself_is_never_written_over(tmp_path):
    log = tmp_path / "t.csv"
    shutil.copy(LOGS / "truth.csv", log)
    assert "would overwrite the input" in line_of(
        import_log, [log], log, tmp_path / "m.toml", None, None, []
    )


ENDS = {"signal": "RCOU.C1", "low": 1, "neutral": 2, "high": 3}
PLACE = {"latitude": "GPS.Lat * deg", "longitude": "GPS.Lng * deg"}

# what is wrong
# ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes, said",
    [
        (
            {"columns": {"psi_rad": "ATT.Ywa * deg"}},
            "rover.BIN has no signal 'ATT.Ywa'; did you mean 'ATT.Yaw'?",
        ),
        ({"columns": {"psi_rad": "ATT.Ywa * deg"}}, "map.toml: columns.psi_rad = 'ATT.Ywa * deg'"),
        ({"columns": {"psi_rad": "ATT.Yaw * dge"}}, "there is no unit 'dge'; did you mean 'deg'?"),
        ({"columns": {"psi_rad": 3}}, "psi_rad is 3; allowed is"),
        ({"columns": {"n": ENDS | {"neutral": 3}}}, "neutral must lie between low and high"),
        ({"columns": {"n": ENDS | {"hihg": 3}}}, "'hihg' does not exist; did you mean 'high'?"),
        ({"columns": {"x_m": "ATT.Yaw"}}, "columns.x_m is what position makes"),
        ({"position": {"latitude": "GPS.Lat", "longitude": "GPS.Lng"}}, "are they in degrees?"),
        ({"position": PLACE | {"longitude": "ATT.Yaw * deg"}}, "are of two streams"),
        ({"position": PLACE | {"origin": [95.0, 0.0]}}, "position.origin"),
        ({"rate": 0}, "rate = 0"),
        ({"use": [3, 1]}, "the second larger"),
        ({"vesel": "otter"}, "'vesel' does not exist; did you mean 'vessel'?"),
        ({"columns": {"r_radps": "RCOU.C1"}, "use": [0.0, 1.5]}, "at least 20 are needed"),
    ],
)
def test_a_mistake_in_a_map_is_one_line_with_its_key(changes, said):
    assert said in line_of(lambda: converted("rover.BIN", **changes))


def test_a_map_without_poses_says_so(tmp_path):
    path = tmp_path / "map.toml"
    path.write_text('[columns]\nn_port_radps = "RCOU.C1"\n')
    assert "no pose: give position" in line_of(read_map, path)
    path.write_text("[columns")
    assert "not a TOML file" in line_of(read_map, path)


LIBRARIES = {
    "rover.BIN": ("pymavlink", "ardupilot"),
    "px4.ulg": ("pyulog", "px4"),
    "ros2.mcap": ("mcap", "ros"),
    "ros1.bag": ("rosbags", "ros"),
    "ros2_bag": ("rosbags", "ros"),
    "instruments.nmea": ("pynmea2", "nmea"),
}


@pytest.mark.parametrize("name", LIBRARIES)
def test_a_library_that_is_not_installed_is_named_with_the_extra_that_brings_it(monkeypatch, name):
    library, extra = LIBRARIES[name]
    whole = builtins.__import__

    def without(module: str, *rest: object, **more: object) -> object:
        if module.split(".")[0] == library:
            raise ModuleNotFoundError(f"No module named {module!r}")
        return whole(module, *rest, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", without)
    assert f"needs {library}; install it with: pip install 'boatsim[{extra}]'" in line_of(
        open_log, LOGS / name
    )


def test_a_suffix_that_nobody_reads_and_a_file_that_is_not_there_are_named(tmp_path):
    (tmp_path / "log.xyz").write_text("?")
    message = line_of(open_log, tmp_path / "log.xyz")
    assert "its suffix '.xyz' is of no known format" in message and ".mcap" in message
    assert "there is no such file" in line_of(open_log, tmp_path / "none.bin")
    assert "is a folder; a log is a file, or the folder of a ROS 2 bag" in line_of(
        open_log, tmp_path
    )


def test_every_suffix_belongs_to_one_format():
    assert {
        ".bin",
        ".ulg",
        ".mcap",
        ".bag",
        ".db3",
        ".nmea",
        ".csv",
        ".parquet",
        "/",
    } <= known_suffixes().keys()


def damaged(folder: Path, name: str, change) -> Path:
    """A copy of a log, its file changed."""
    path = folder / name
    if (LOGS / name).is_dir():
        shutil.copytree(LOGS / name, path, dirs_exist_ok=True)
        file = next(path.glob("*.db3"))
    else:
        file = path
        shutil.copy(LOGS / name, path)
    file.write_bytes(change(file.read_bytes()))
    return path


@pytest.mark.parametrize("name", RESOLUTION)
def test_a_log_that_is_cut_anywhere_is_shorter_or_refused_in_one_line(tmp_path, name):
    whole, chance = len(open_log(LOGS / name).signals), random.Random(name)
    size = len(
        next((LOGS / name).glob("*.db3")).read_bytes()
        if (LOGS / name).is_dir()
        else (LOGS / name).read_bytes()
    )
    for cut in [0, 1, 7, 100, size - 1, *(chance.randrange(size) for _ in range(12))]:
        path = damaged(tmp_path, name, lambda data, cut=cut: data[:cut])
        try:
            assert len(open_log(path).signals) <= whole
        except BadInput as error:
            assert "\n" not in str(error) and str(error).startswith(str(path))


@pytest.mark.parametrize("name", RESOLUTION)
def test_a_log_with_bytes_changed_is_read_or_refused_in_one_line(tmp_path, name):
    chance = random.Random(name)

    def spoilt(data: bytes) -> bytes:
        changed = bytearray(data)
        for _ in range(chance.choice([1, 4, 40])):
            changed[int(len(changed) * chance.random() ** 3)] = chance.randrange(256)
        return bytes(changed)

    for _ in range(12):
        path = damaged(tmp_path, name, spoilt)
        try:
            log = open_log(path)
            signal_table(log)
            parse_map(tomllib.loads(propose_map(log, "otter", DRIVES, FREEDOMS)), "map.toml")
        except BadInput as error:
            assert "\n" not in str(error)


def test_what_libraries_print_of_a_damaged_log_is_not_passed_on(tmp_path, capfd):
    open_log(
        damaged(
            tmp_path, "rover.BIN", lambda data: data[:40000] + bytes(range(256)) * 8 + data[40000:]
        )
    )
    open_log(
        damaged(
            tmp_path, "px4.ulg", lambda data: data[:30000] + bytes(range(256)) * 8 + data[30000:]
        )
    )
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name, module", [("ros2.mcap", "mcap"), ("ros1.bag", "rosbag")])
def test_a_chunk_that_would_unpack_to_more_than_is_stated_is_refused(monkeypatch, name, module):
    monkeypatch.setattr(f"boatsim.recordings.logs.{module}.MAX_CHUNK", 20_000)
    assert "cannot be read as" in line_of(open_log, LOGS / name)


@pytest.mark.parametrize(
    "key, value, said",
    [
        ("compression_mode", "FILE", "is compressed; unpack it"),
        ("storage_identifier", "mcap", "give the .mcap in it"),
    ],
)
def test_a_bag_that_is_compressed_or_holds_mcap_says_what_to_do(tmp_path, key, value, said):
    path = tmp_path / "bag"
    shutil.copytree(LOGS / "ros2_bag", path)
    about = path / "metadata.yaml"
    about.write_text(re.sub(rf"{key}: .*", f"{key}: {value}", about.read_text()))
    assert said in line_of(open_log, path)


def test_names_from_a_log_reach_neither_terminal_nor_map_as_they_are(tmp_path):
    path = tmp_path / "t.csv"
    header = 't_s,psi\x1b[31m,"he said ""x"" \\ y",heading'
    path.write_text(
        header + "\n" + "".join(f"{0.1 * i:.1f},{i},{i},{0.01 * i}\n" for i in range(40))
    )
    log = open_log(path)
    assert "\x1b" not in "\n".join(signal_table(log)) + propose_map(log)
    tomllib.loads(propose_map(log))


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "is empty"),
        ("t_s,x_m\n", "has a header and no rows"),
        ("a,a\n1,2\n", "two columns of this name"),
        ("a,b\n1,2\n1\n3,4\n", "row 3: has 1 cells; the header has 2 columns"),
        ("a\0b", "is not a text file"),
        ("a,b\n" * 3, "has a header and no rows"),
        ("a,b\n" + "c,d\n" * 3, None),
    ],
)
def test_a_bad_table_gets_one_line(tmp_path, text, said):
    path = tmp_path / "t.csv"
    path.write_text(text)
    assert (said or "has no signals") in line_of(open_log, path)


@pytest.mark.parametrize(
    "text",
    [
        "# made by a logger\nt_s,heading_deg\n0.0,10\n0.5,20\n1.0,30\n",
        "time;heading_deg\n0,0;10\n0,5;20\n1,0;30\n",
        "Time [ms]\theading_deg\n0\t10\n500\t20\n1000\t30\n",
        "timestamp,heading_deg\n2024-05-01T10:00:00Z,10\n2024-05-01T10:00:00.5Z,20\n2024-05-01T10:00:01Z,30\n",
        "timestamp_us,heading_deg\n1714557600000000,10\n1714557600500000,20\n1714557601000000,30\n",
        "epoch,heading_deg\n1714557600,10\n1714557600.5,20\n1714557601,30\n",
        "time,heading_deg\ns,deg\n0,10\n0.5,20\n1,30\n",
        "#time,heading_deg\n0,10\n0.5,20\n1,30\n",
        '"time","heading_deg"\r\n"0","10"\r\n"0.5","20"\r\n"1","30"\r\n',
    ],
)
def test_tables_as_programs_write_them_are_read_with_their_times(tmp_path, text):
    path = tmp_path / "t.csv"
    path.write_bytes(text.encode())
    found = open_log(path).signals["heading_deg"]
    np.testing.assert_array_equal(found.values, [10, 20, 30])
    np.testing.assert_allclose(found.t - found.t[0], [0.0, 0.5, 1.0], atol=1e-6)
    assert found.unit == "deg"


def test_sentences_past_midnight_and_ones_with_a_wrong_sum(tmp_path):
    lines = [
        sentence(f"GPGGA,{clock},6326.4000,N,01021.0000,E,4,12,0.5,0.0,M,0.0,M,,")
        for clock in ("235959.00", "000000.00", "000001.00")
    ]
    path = tmp_path / "log.nmea"
    path.write_text("".join(lines) + lines[0].replace("*", "*0").replace("E,4", "E,5") + "noise\n")
    log = open_log(path)
    np.testing.assert_allclose(np.diff(log.signals["GGA.latitude"].t), [1.0, 1.0])
    assert any("2 of 5 lines are no whole sentences" in line for line in log.remarks)


def test_a_bag_whose_definitions_are_code_runs_none(tmp_path):
    """Names of messages come from the file; a library that makes classes of them would run what is
    in them."""
    from boatsim.recordings.importing.ros import Decoder

    mark = tmp_path / "ran"
    name = f"a/B:\n    pass\nopen({str(mark)!r}, 'w')\nclass C"
    assert Decoder("float64 x\n", name, True)(b"\0\1\0\0" + bytes(8)) == {"x": 0.0}
    assert not mark.exists()


LITTLE, BIG = b"\0\1\0\0", b"\0\0\0\0"  # what ROS 2 writes in front of a message
ONE = b"\0\0\0\0\0\0\xf0\x3f"  # 1.0, little end first
NUMBERS = "uint8 a\nfloat64 b\n"


@pytest.mark.parametrize(
    "text, data, cdr, found",
    [
        (NUMBERS, LITTLE + b"\x05" + bytes(7) + ONE, True, {"a": 5.0, "b": 1.0}),
        (NUMBERS, BIG + b"\x05" + bytes(7) + ONE[::-1], True, {"a": 5.0, "b": 1.0}),
        (NUMBERS, b"\x05" + ONE, False, {"a": 5.0, "b": 1.0}),
        ("string s\nint16 a\n", LITTLE + b"\x03\0\0\0hi\0\0\x07\0", True, {"a": 7.0}),
        ("string s\nint16 a\n", b"\x02\0\0\0hi\x07\0", False, {"a": 7.0}),
        ("uint16[] c\n", b"\x02\0\0\0\x01\0\x02\0", False, {"c[0]": 1.0, "c[1]": 2.0}),
        ("time t\n", b"\x01\0\0\0\x02\0\0\0", False, {"t.sec": 1.0, "t.nanosec": 2.0}),
        ("int8 K=3\nint8 a # note\n", b"\xff", False, {"a": -1.0}),
        (
            "Part[2] p\n===\nMSG: m/Part\nint8 a\n",
            b"\x01\x02",
            False,
            {"p[0].a": 1.0, "p[1].a": 2.0},
        ),
    ],
)
def test_messages_are_decoded_by_their_definitions(text, data, cdr, found):
    from boatsim.recordings.importing.ros import Decoder

    decode = Decoder(text, "m/Whole", cdr)
    assert decode(data) == found
    for cut in range(len(data)):
        with pytest.raises(ValueError):
            decode(data[:cut])


def test_messages_of_no_size_in_many_ways_within_each_other_take_no_time():
    from boatsim.recordings.importing.ros import Decoder

    levels = [f"MSG: p/L{i}\n" + f"L{i + 1} a\nL{i + 1} b\nL{i + 1} c\n" for i in range(18)]
    text = ("\n" + "=" * 80 + "\n").join(["L0 a\n", *levels, "MSG: p/L18\n"])  # 3^18 of them
    with pytest.raises(ValueError, match="more messages in the message than it has bytes"):
        Decoder(text, "p/Root", cdr=False)(b"")
    deeper = (
        text.replace("MSG: p/L18\n", "MSG: p/L18\nL19 a\n")
        + "\n"
        + "=" * 80
        + "\nMSG: p/L19\nL18 a\n"
    )
    with pytest.raises(ValueError, match="too deep"):
        Decoder(deeper, "p/Root", cdr=False)


@pytest.mark.parametrize("size", [30, 12_000, 20_000, 60_000])
def test_a_log_whose_end_is_damaged_does_not_hold_up_the_reader(tmp_path, size):
    header = (LOGS / "px4.ulg").read_bytes()[:16]
    (tmp_path / "log.ulg").write_bytes(
        header
        + (struct.pack("<HB", 100, ord("Z")) + bytes(100)) * 300
        + struct.pack("<HB", size, 0)
        + bytes(5)
    )
    line_of(open_log, tmp_path / "log.ulg")


@pytest.mark.parametrize("quick", ["0", "1"])
def test_messages_of_no_length_do_not_hold_up_the_reader(tmp_path, monkeypatch, quick):
    monkeypatch.setenv("PYMAVLINK_FAST_INDEX", quick)
    format = lambda n, size, *texts: b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", n, size, *texts)  # noqa: E731
    begin = format(128, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns")
    (tmp_path / "log.BIN").write_bytes(
        begin + format(144, 0, b"AAA", b"Q", b"TimeUS") + b"\xa3\x95\x90" + bytes(8)
    )
    line_of(open_log, tmp_path / "log.BIN")


@pytest.mark.parametrize("columns", [6_000, 5])
def test_a_table_beyond_the_limits_is_refused_by_what_it_says_of_itself_or_as_soon_as_it_is_counted(
    tmp_path, monkeypatch, columns
):
    table = pa.table({f"c{i}": np.zeros(100) for i in range(columns)})
    parquet.write_table(table, tmp_path / "log.parquet")
    text = (
        ",".join(table.column_names)
        + "\n"
        + ("1," * (columns - 1) + "1\n") * 20_000 * (columns < 100)
    )
    (tmp_path / "log.csv").write_text(text + "1\n")
    monkeypatch.setattr("boatsim.recordings.importing.log.MAX_VALUES", 499)
    for name in ("log.parquet", "log.csv"):
        assert re.search("columns|signals|values", line_of(open_log, tmp_path / name))


def test_a_message_that_holds_itself_or_claims_to_be_huge_is_refused():
    from boatsim.recordings.importing.ros import Decoder

    with pytest.raises(ValueError, match="holds itself"):
        Decoder("m/A a\n===\nMSG: m/A\nm/A a\n", "m/A", False)
    with pytest.raises(ValueError, match="more than the message has bytes"):
        Decoder("uint8[] c\n", "m/A", False)(b"\xff\xff\xff\xff")


def test_the_logs_are_what_their_script_writes(tmp_path, monkeypatch):
    """All but the bags and Parquet, whose writers put versions or the time of writing into the
    file."""
    run = {n: TRUTH[n] for n in TRUTH.dtype.names}
    for name in ("rover.BIN", "px4.ulg", "instruments.nmea", "table.csv"):
        make_logs.LOGS[name](run, tmp_path / name)
        assert abs(len((tmp_path / name).read_bytes()) - len((LOGS / name).read_bytes())) < 100, (
            name
        )
        assert (tmp_path / name).stat().st_size < 200_000
    assert re.search(r"Otter", (LOGS / "README.md").read_text())


def test_the_map_that_the_documents_show_is_one():
    page = (Path(__file__).parents[3] / "docs" / "logs.md").read_text()
    shown = tomllib.loads(re.search(r"```toml\n(.*?)```", page, re.DOTALL)[1])
    assert parse_map(shown, "map.toml").columns.keys() == shown["columns"].keys()


@pytest.mark.parametrize(
    "name", ["yaw_rate_deg_s", "yaw_rate_deg_per_s", "gyro_z deg_s", "yaw_rate_degps"]
)
def test_a_rate_whose_name_says_degrees_per_second_is_one(tmp_path, name):
    rows = [f"{0.1 * k:.1f},{0.01 * k:.3f},{0.4 * k % 30.0:.2f}" for k in range(60)]
    (tmp_path / "log.csv").write_text("\n".join([f"time_s,psi_rad,{name}", *rows]) + "\n")
    signal = open_log(tmp_path / "log.csv").signals[name]
    assert signal.unit in ("deg/s", "")
    assert f'r_radps = "{name} * degps"' in propose_map(open_log(tmp_path / "log.csv"))


def nmea(body: str) -> str:
    total = 0
    for character in body:
        total ^= ord(character)
    return f"${body}*{total:02X}"


@pytest.mark.parametrize("with_fixes", [True, False])
def test_zda_gives_the_date_and_the_time_where_no_fix_has_one(tmp_path, with_fixes):
    lines = []
    for k in range(40):  # across midnight, with the date sent after the next fix
        clock = (86380 + k) % 86400
        text = f"{clock // 3600:02d}{clock // 60 % 60:02d}{clock % 60:02d}.00"
        before = f"{(clock - 1) % 86400 // 3600:02d}{(clock - 1) % 86400 // 60 % 60:02d}"
        before += f"{(clock - 1) % 60:02d}.00"
        day = 26 if 86380 + k - with_fixes < 86400 else 27
        if with_fixes:
            lines.append(nmea(f"GPGGA,{text},5000.000,N,00800.{k:03d},E,1,08,1.0,0.0,M,0.0,M,,"))
        lines.append(nmea(f"GPZDA,{before if with_fixes else text},{day},11,2026,00,00"))
        lines.append(nmea(f"HEHDT,{10 + k}.0,T"))
    path = tmp_path / "log.nmea"
    path.write_text("\n".join(lines) + "\n")
    log = open_log(path)
    t = log.signals["HDT.heading"].t
    begin = datetime(2026, 11, 26, 23, 59, 40, tzinfo=UTC).timestamp()
    assert t == pytest.approx(begin + np.arange(40.0), abs=1e-3)
    assert not [name for name in log.signals if "ZDA" in name]
