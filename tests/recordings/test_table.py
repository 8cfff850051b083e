"""Recordings: what is read comes back, every real set is readable, and a bad file gets one line
that says where."""

import math
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.recordings import units
from boatsim.recordings.readers import csv
from boatsim.recordings.table import Notes, Recording, read, write_csv

REAL = Path(__file__).parents[2].parent / "shared" / "recordings"


# Sets of which every recording can be read. Others in the folder hold recordings that are refused
# today: turning rates that look like degrees, unwrapped azimuths, shaft rates above the limits.
READABLE = {
    "blueboat_lake",
    "esso_osaka",
    "kvlcc2_hsva_zigzag",
    "kvlcc2_marin_free",
    "kvlcc2_roll_decay",
    "trials",
    "twin_usv_paths",
}


def is_recording(file: Path) -> bool:
    """Whether a file is a recording of a readable set, not a table of other quantities."""
    other = "wind" in file.parts or file.name.startswith("missing_force")
    return file.relative_to(REAL).parts[0] in READABLE and not other


RUNS = sorted(filter(is_recording, REAL.glob("**/*.csv")))
HEADER = "t_s,x_m,y_m,psi_rad,thrust_port_N\n"
LIMITS = {"thrust_port_N": (-1.0, 1.0), "thrust_starboard_N": (-1.0, 1.0)}
real = pytest.mark.skipif(
    not RUNS, reason="the real recordings lie beside the repository, not in it"
)


def lines(n: int = 30) -> list[str]:
    return [
        f"{0.1 * i:.1f},{0.02 * i:.3f},{0.1 * math.sin(0.1 * i):.4f},{0.05 * i:.4f},0.5\n"
        for i in range(n)
    ]


def file(folder: Path, text: str | bytes, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def changed(row: int, text: str) -> str:
    """A good file whose given line (1 is the header) is replaced."""
    good = [HEADER, *lines()]
    good[row - 1] = text + "\n"
    return "".join(good)


def line_of(path: Path, **channels: tuple[float, float]) -> str:
    with pytest.raises(BadInput) as caught:
        read(path, channels or LIMITS)
    message = str(caught.value)
    assert "\n" not in message and message.startswith(str(path))
    return message


def circle(n: int = 200) -> Recording:
    t = 0.05 * np.arange(n)
    psi = 0.4 * t
    signals = {
        "x_m": 2.0 * np.sin(psi),
        "y_m": 2.0 - 2.0 * np.cos(psi),
        "psi_rad": psi,
        "pwm_port": np.full(n, 120.0),
    }
    signals["camera_x_m"] = np.where(np.arange(n) % 8 == 0, signals["x_m"], np.nan)
    return Recording("circle", t, signals)


@real
@pytest.mark.parametrize(
    "path", [p for p in RUNS if "trials" not in p.parts], ids=lambda p: f"{p.parts[-3]}/{p.stem}"
)
def test_every_real_recording_is_read_with_its_notes(path):
    run = read(path)
    expected = path.read_text().count("\n") - 1
    assert len(run) == expected and all(len(v) == expected for v in run.signals.values())
    assert {"x_m", "y_m", "psi_rad"} <= run.signals.keys()
    stated = tomllib.loads((path.parent / "recording.toml").read_text())
    assert run.notes.vessel == stated.get("vessel")


@real
def test_every_practice_trial_is_read_within_its_limits():
    steering = {f"steer_{side}_rad": (-math.pi / 4, math.pi / 4) for side in ("port", "starboard")}
    trials = [read(path, LIMITS | steering) for path in RUNS if "trials" in path.parts]
    assert len(trials) > 100
    assert {run.notes.vessel for run in trials} == {"trial_boat"}


@real
@pytest.mark.parametrize("wrapped", [False, True])
def test_degrees_are_told_from_radians_on_every_real_recording_that_turns(wrapped):
    for run in map(read, RUNS):
        psi = np.remainder(run["psi_rad"], 2 * math.pi) if wrapped else run["psi_rad"]
        assert units.find_heading_in_degrees(run.t, psi, run.signals) is None, run.path
        if (
            run.notes.vessel != "kvlcc2_roll"
        ):  # goes straight ahead: 0.05 deg and 0.05 rad look the same
            assert units.find_heading_in_degrees(run.t, np.degrees(psi), run.signals) is not None, (
                run.path
            )


@real
def test_columns_are_renamed_and_a_leading_minus_flips_the_sign():
    source = REAL / "kvlcc2_hsva_zigzag" / "runs" / "Z_20_05.csv"
    table = np.genfromtxt(source, delimiter=",", names=True)
    np.testing.assert_array_equal(read(source)["delta_rad"], -table["delta_rad"] + 0.0)
    lake = REAL / "blueboat_lake" / "runs" / "run_216.csv"
    table = np.genfromtxt(lake, delimiter=",", names=True)
    np.testing.assert_array_equal(read(lake)["thrust_port_N"], table["force_right_N"])
    assert "filled" in read(lake).remarks[0] and "filled" not in read(lake).signals


def test_what_is_written_is_read_back_and_the_bytes_are_the_same(tmp_path):
    run = circle()
    write_csv(run, tmp_path / "a.csv")
    write_csv(read(tmp_path / "a.csv"), tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    again = read(tmp_path / "a.csv")
    assert list(again.signals) == list(run.signals)
    for name, values in run.signals.items():
        np.testing.assert_allclose(again[name], values, atol=1e-9, rtol=0, equal_nan=True)


def test_parquet_gives_the_same_recording_as_csv(tmp_path):
    import pyarrow as pa
    from pyarrow import parquet

    run = circle()
    table = {"t_s": run.t, **run.signals, "words": ["text"] * len(run)}
    parquet.write_table(pa.table(table), tmp_path / "run.parquet")
    again = read(tmp_path / "run.parquet")
    np.testing.assert_array_equal(again.t, run.t)
    np.testing.assert_array_equal(again["psi_rad"], run["psi_rad"])
    assert "words" in again.remarks[0]
    assert "is not a Parquet file" in line_of(file(tmp_path, "t_s,x_m\n", "bad.parquet"))


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = file(tmp_path, "old")
    with pytest.raises(RuntimeError), replace_file(path) as temporary:
        temporary.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_headings_are_unwrapped_and_may_pass_17_rad(tmp_path):
    psi = 0.3 * 0.1 * np.arange(800)
    rows = [
        f"{0.1 * i:.1f},0,0,{p},0\n"
        for i, p in enumerate(np.remainder(psi + math.pi, 2 * math.pi) - math.pi)
    ]
    again = read(file(tmp_path, HEADER + "".join(rows)))
    assert psi[-1] > 17
    np.testing.assert_allclose(again["psi_rad"], psi, atol=1e-9)


@pytest.mark.parametrize("ratio", [0.1, 10.0])
def test_a_heading_that_only_drifts_with_a_biased_gyro_is_not_called_degrees(ratio):
    t = 0.1 * np.arange(400)
    drift = {"r_radps": np.full(400, 0.01 * ratio)}
    assert units.find_heading_in_degrees(t, 0.01 * t, drift) is None
    assert units.find_rate_in_degrees(t, drift["r_radps"], 0.01 * t) is None


def test_a_boat_that_moves_sideways_while_its_heading_swings_is_not_called_degrees():
    t = np.arange(0, 20, 1 / 6)
    swing = 0.2 * np.sin(0.5 * t)
    sideways = {"x_m": 0.01 * np.sin(0.5 * t), "y_m": 0.1 * t}
    assert units.find_heading_in_degrees(t, swing, sideways) is None
    spinning = {"x_m": 0.01 * t, "y_m": 0.02 * t}
    assert units.find_heading_in_degrees(t, 0.9 * t, spinning) is None


def test_a_wrapped_heading_of_a_spinning_boat_is_not_called_degrees():
    t = np.arange(0, 40, 1 / 6)
    psi = np.remainder(8.0 * np.maximum(t - 10.0, 0.0) + math.pi, 2.0 * math.pi)
    assert units.find_heading_in_degrees(t, psi - math.pi, {}) is None
    assert units.find_heading_in_degrees(t, psi, {}) is None
    assert units.find_heading_in_degrees(t, np.degrees(psi), {}) is not None


def spinning_hovercraft():
    """A craft that spins to and fro at up to 25 rad/s and drifts, whatever way it points."""
    t = np.arange(0, 30, 1 / 120)
    psi = 20.0 * np.sin(1.2 * t)
    return t, psi, {"x_m": 0.2 * np.sin(0.5 * t), "y_m": 0.2 * np.cos(0.4 * t)}


def test_fast_turning_alone_is_not_called_degrees():
    t, psi, track = spinning_hovercraft()
    assert units.find_heading_in_degrees(t, psi, track) is None
    assert units.find_heading_in_degrees(t, psi, {}) is None
    assert units.find_heading_in_degrees(t, np.degrees(psi), track) is not None


def test_turning_and_course_together_show_degrees():
    t = np.arange(0, 60, 0.1)
    psi = 0.8 * np.sin(0.3 * t)
    track = {"x_m": np.cumsum(0.1 * np.cos(psi)), "y_m": np.cumsum(0.1 * np.sin(psi))}
    drift = {"x_m": track["x_m"], "y_m": track["y_m"] + 0.3 * t}  # course and bow differ by 20 deg
    assert units.find_heading_in_degrees(t, psi, drift) is None
    assert units.find_heading_in_degrees(t, np.degrees(psi), drift) is not None


def test_a_roll_angle_that_was_never_recorded_decides_nothing_about_units():
    t = np.arange(0.0, 20.0, 0.1)
    columns = {"t_s": t, "y_m": np.sin(t), "phi_rad": np.full(len(t), np.nan)}
    assert units.find_columns_in_degrees(columns) == {}


def spinning(rate: float, seed: int = 4) -> dict[str, np.ndarray]:
    """A craft that spins up and drifts east; its heading is counted on."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, 40.0, 0.1)
    r = rate * np.interp(t, [0.0, 10.0, 40.0], [0.1, 1.0, 0.8])
    psi = np.cumsum(r) * 0.1
    return {
        "t_s": t,
        "x_m": 0.01 * rng.normal(size=len(t)),
        "y_m": 0.5 * t + 0.01 * rng.normal(size=len(t)),
        "psi_rad": psi + 0.01 * rng.normal(size=len(t)),
        "r_radps": r + 0.01 * rng.normal(size=len(t)),
    }


@pytest.mark.parametrize("rate", [6.0, 14.0, 31.0])
@pytest.mark.parametrize("columns", [("psi_rad",), ("x_m", "y_m", "psi_rad"), ("r_radps",)])
def test_a_craft_that_spins_several_turns_a_second_is_in_radians(rate, columns):
    run = spinning(rate)
    assert units.find_columns_in_degrees({name: run[name] for name in ("t_s", *columns)}) == {}


def test_a_gap_in_a_heading_that_is_counted_on_is_no_sign_of_degrees():
    run = spinning(14.0)
    rows = np.abs(run["t_s"] - 20.0) > 1.5
    kept = {name: values[rows] for name, values in run.items() if name != "r_radps"}
    assert np.abs(np.diff(kept["psi_rad"])).max() > 3.0 * math.pi
    assert units.find_columns_in_degrees(kept) == {}


def test_a_sparse_heading_shows_the_unit_of_a_rate_of_turn():
    run = spinning(14.0)
    sparse = run | {"psi_rad": np.where(np.arange(400) % 2 == 0, run["psi_rad"], np.nan)}
    assert units.find_columns_in_degrees(sparse) == {}
    gentle = spinning(0.3)
    gentle["r_radps"] = np.degrees(gentle["r_radps"])
    gentle["psi_rad"][1::2] = np.nan
    assert list(units.find_columns_in_degrees(gentle)) == ["r_radps"]


def test_a_rate_of_turn_alone_is_in_degrees_by_its_size_and_its_scatter_or_resolution():
    gentle = spinning(0.3)
    degrees = np.degrees(gentle["r_radps"])
    assert list(units.find_columns_in_degrees({"t_s": gentle["t_s"], "r_radps": degrees})) == [
        "r_radps"
    ]
    smooth = np.degrees(0.2 + 0.1 * np.sin(gentle["t_s"]))
    rounded = {"t_s": gentle["t_s"], "r_radps": np.round(smooth, 1)}
    assert list(units.find_columns_in_degrees(rounded)) == ["r_radps"]


def test_a_part_keeps_its_times_and_an_empty_part_says_what_there_is():
    run = circle().between(2.0, 4.0)
    assert (run.t[0], run.t[-1], len(run)) == (pytest.approx(2.0), pytest.approx(4.0), 41)
    with pytest.raises(BadInput, match="no rows from 50 to 60 s; it has 0 to 9.95 s"):
        circle().between(50, 60)


@pytest.mark.parametrize(
    "name, unit",
    [
        ("x_m", "m"),
        ("sensed_ax_mps2", "m/s^2"),
        ("wind_N_Nm", "N m"),
        ("pwm_port", ""),
        ("estimate_d_N_low", "N"),
        ("n_rpm", "1/min"),
        ("r_radps", "rad/s"),
        ("filled", ""),
    ],
)
def test_the_unit_is_the_end_of_the_name(name, unit):
    assert circle().unit(name) == unit


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "is empty"),
        (HEADER, "has a header and no rows"),
        (b"\x89PNG\r\n\x1a\n\xff\xfe" * 9, "is not a text file"),
        (HEADER + "".join(lines(19)), "has 19 rows; at least 20 are needed"),
        ((HEADER + "".join(lines())).replace(",", ";"), "row 1: is separated by semicolons"),
        (changed(1, "time,x_m,y_m,psi_rad,thrust_port_N"), "row 1, column t_s: is missing"),
        (changed(1, "t_s,a,b,c,thrust_port_N"), "no pose or rate"),
        (
            changed(1, "t_s,x_m,x_m,psi_rad,thrust_port_N"),
            "row 1, column x_m: there are two columns",
        ),
        (changed(7, "0.5,0,0,0"), "row 7: has 4 cells; the header has 5 columns"),
        (changed(7, "0.5,0,nan,0,0"), "row 7, column y_m: the cell is empty or not a number"),
        (changed(7, "0.5,0,0,,0"), "row 7, column psi_rad: the cell is empty"),
        (changed(7, "0.5,0,0,0,inf"), "row 7, column thrust_port_N: inf is too large"),
        (changed(7, "0.5,zero,0,0,0"), "row 7, column x_m: 'zero' is not a number"),
        (changed(7, "0.5,1_0,0,0,0"), "row 7, column x_m: '1_0' is not a number"),
        (changed(7, "0.4,0,0,0,0"), "row 7, column t_s: time 0.4 s after 0.4 s; it must increase"),
        (
            changed(7, "0.5,0,0,0,3.3"),
            "row 7, column thrust_port_N: command 3.3 N is far outside the vessel's limits -1 to",
        ),
    ],
)
def test_a_bad_file_gets_one_line_with_file_row_and_column(tmp_path, text, said):
    assert said in line_of(file(tmp_path, text))


@pytest.mark.parametrize("times", ["0.0", "0.0 0.0 0.1 0.1 0.1 0.0", "3 2 1"])
@pytest.mark.filterwarnings("error")
def test_time_that_stands_still_or_runs_back_is_one_line(tmp_path, times):
    rows = [
        f"{times.split()[i % len(times.split())]},{0.1 * i},{0.1 * i * i},{0.3 * i},0.5\n"
        for i in range(40)
    ]
    assert "it must increase" in line_of(file(tmp_path, HEADER + "".join(rows)))


def test_a_blank_line_does_not_shift_the_row_that_is_named(tmp_path):
    assert "row 8, column y_m" in line_of(file(tmp_path, changed(7, "\n0.5,0,nan,0,0")))


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    assert "there is no such file" in line_of(tmp_path / "none.csv")
    assert "is a folder" in line_of(tmp_path)


def test_poses_and_commands_of_two_logs_that_share_no_row(tmp_path):
    rows = [f"{0.1 * i:.1f}," + ("0,0,0," if i < 20 else ",,,0.5") + "\n" for i in range(40)]
    assert "poses (0 to 1.9 s) and commands (2 to 3.9 s) have no row in common" in line_of(
        file(tmp_path, HEADER + "".join(rows))
    )


@pytest.mark.parametrize("degrees", ["psi_rad", "phi_rad", "r_radps"])
def test_degrees_are_refused_with_the_column_that_has_them(tmp_path, degrees):
    run = circle()
    full = {**run.signals, "r_radps": np.full(len(run), 0.4), "phi_rad": 0.05 * np.sin(run.t)}
    full["r_radps"][:40], full["psi_rad"] = 0.0, np.maximum(0.0, run["psi_rad"] - 0.8)
    write_csv(Recording("x", run.t, full), tmp_path / "run.csv")
    read(tmp_path / "run.csv")
    write_csv(
        Recording("x", run.t, {**full, degrees: np.degrees(full[degrees])}), tmp_path / "run.csv"
    )
    assert f"column {degrees}: " in line_of(tmp_path / "run.csv")
    assert "looks like degrees" in line_of(tmp_path / "run.csv")


def test_a_recorded_roll_rate_shows_that_a_boat_was_knocked_down(tmp_path):
    run = circle()
    roll = {**run.signals, "phi_rad": 1.2 * np.sin(run.t), "p_radps": 1.2 * np.cos(run.t)}
    write_csv(Recording("x", run.t, roll), tmp_path / "run.csv")
    assert np.max(np.abs(read(tmp_path / "run.csv")["phi_rad"])) > 1.1
    del roll["p_radps"]
    write_csv(Recording("x", run.t, roll), tmp_path / "run.csv")
    assert "column phi_rad" in line_of(tmp_path / "run.csv")


def test_notes_come_from_the_nearest_folder_above_and_a_run_overrides_them(tmp_path):
    deep = tmp_path / "set" / "runs"
    deep.mkdir(parents=True)
    file(
        tmp_path,
        """
        vessel = "trial_boat"
        load = ["heavy", "wide"]
        colour = "red"
        noise = {position_sd_m = 0.003, heading_sd_rad = 0.01, headng_sd_rad = 1.0}
        ambient = {axes = ["surge", "sway"], force_rms = [0.01, 0.02], time_constant_s = 2.0}
        set.cross_flow_drag = {section_drag_coefficient = 1.1}
        facts.fan = "north wall"
        [runs.run]
        use = [0.5, 2.9]
        load = "light"
        forward_speed_mps = 0.97
        noise.position_sd_m = 0.005
        [runs.other]
        vessel = "kvlcc2"
        """,
        "recording.toml",
    )
    run = read(file(deep, HEADER + "".join(lines())))
    assert run.notes == Notes(
        vessel="trial_boat",
        load=("light",),
        settings={"cross_flow_drag": {"section_drag_coefficient": 1.1}},
        use=((0.5, 2.9),),
        noise={"position_sd_m": 0.005, "heading_sd_rad": 0.01},
        ambient={"axes": ["surge", "sway"], "force_rms": [0.01, 0.02], "time_constant_s": 2.0},
        facts={"forward_speed_mps": 0.97, "fan": "north wall"},
    )
    assert (len(run), len(run.used())) == (30, 25)
    assert (
        "colour" in run.remarks[0]
        and "noise.headng_sd_rad (did you mean heading_sd_rad?)" in run.remarks[0]
    )


@pytest.mark.parametrize(
    "text, said",
    [
        ("vessel = ", "not a TOML file"),
        ("vessel = 3", "vessel = 3; allowed is a text"),
        ("load = [1]", "load = [1]; allowed is a text or a list of texts"),
        ("use = [5, 2]", "use = [5, 2]; allowed is [from_s, to_s]"),
        ("use = [1, 2]", "rows in its part to use"),
        ("noise = 3", "noise = 3; allowed is a table"),
        ("noise.position_sd_m = -1", "noise.position_sd_m = -1; allowed is a number of at least 0"),
        ("ambient.axes = ['surge', 'swy']", "axis 'swy' does not exist; did you mean 'sway'"),
        ("set.wind.force_N = 'x'", "set.wind.force_N = 'x'; allowed is a number"),
        ("columns.x_m = 1", "columns.x_m = 1; allowed is a text"),
        ("runs.run = 1", "runs.run = 1; allowed is a table"),
        (
            "use = [0, 1" + 400 * "0" + "]",
            "use is an integer of 401 digits; allowed are those of 64 bits",
        ),
        ("facts.walls_m = 3.0", "facts.walls_m = 3.0; allowed is [x_low, x_high, y_low, y_high]"),
        ("forward_speed_mps = 'fast'", "forward_speed_mps = 'fast'; allowed is a number"),
        (
            "facts.walls_m = [4, -4, -3, 3]",
            "facts.walls_m = [4, -4, -3, 3]; allowed is [x_low, x_high, y_low, y_high]",
        ),
    ],
)
def test_a_bad_recording_toml_gets_one_line(tmp_path, text, said):
    path = file(tmp_path, HEADER + "".join(lines()))
    file(tmp_path, text, "recording.toml")
    with pytest.raises(BadInput) as caught:
        read(path)
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_the_one_axis_of_an_ambient_force_needs_no_list(tmp_path):
    path = file(tmp_path, HEADER + "".join(lines()))
    file(tmp_path, "ambient = {axes = 'yaw', force_rms = [0.5]}", "recording.toml")
    assert read(path).notes.ambient == {"axes": ["yaw"], "force_rms": [0.5]}


CELL = st.one_of(
    st.floats().map(repr),
    st.integers().map(str),
    st.text(max_size=6),
    st.sampled_from(["", "nan", "1e999"]),
)
NAME = st.one_of(
    st.sampled_from(["t_s", "x_m", "psi_rad", "phi_rad", "r_radps", "thrust_N"]),
    st.text(max_size=6),
)


@st.composite
def tables(draw):
    """Files that are nearly recordings: enough rows, sometimes good times, cells of every kind."""
    names = draw(st.lists(NAME, min_size=1, max_size=5))
    number = st.floats(-1e6, 1e6).map(repr) if draw(st.booleans()) else CELL
    columns = [draw(st.lists(number, min_size=22, max_size=22)) for _ in names]
    if draw(st.booleans()):
        names, columns = ["t_s", *names], [[str(0.1 * i) for i in range(22)], *columns]
    text = "\n".join([",".join(names), *(",".join(row) for row in zip(*columns, strict=True))])
    return text[: draw(st.integers(0, len(text)))] if draw(st.booleans()) else text


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    content=st.one_of(
        st.binary(max_size=400), tables().map(lambda text: text.encode("utf-8", "replace"))
    )
)
def test_no_content_of_a_file_ends_in_anything_but_a_recording_or_one_line(tmp_path, content):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run = read(file(tmp_path, content), {"thrust_N": (-1.0, 1.0)})
        assert (np.diff(run.t) > 0).all() and len(run) >= 20
    except BadInput as error:
        assert "\n" not in str(error)


VALUE = st.recursive(
    st.one_of(st.integers(), st.floats(), st.booleans(), st.text(max_size=5)),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["run", "x_m", "axes", "wind"]), inner, max_size=3)
    ),
    max_leaves=6,
)
KEY = st.sampled_from(
    ["vessel", "load", "scale", "use", "columns", "noise", "ambient", "facts", "set", "runs", "odd"]
)


def toml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        return (
            '"'
            + "".join(
                f"\\U{ord(letter):08X}" for letter in value if not 0xD800 <= ord(letter) < 0xE000
            )
            + '"'
        )
    return str(value).lower()


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    content=st.one_of(
        st.binary(max_size=60),
        st.dictionaries(KEY, VALUE).map(
            lambda table: "\n".join(
                f"{key} = {toml(value)}" for key, value in table.items()
            ).encode()
        ),
    )
)
def test_no_recording_toml_ends_in_anything_but_notes_or_one_line(tmp_path, content):
    path = file(tmp_path, HEADER + "".join(lines()))
    file(tmp_path, content, "recording.toml")
    try:
        assert isinstance(read(path).notes, Notes)
    except BadInput as error:
        assert "\n" not in str(error)


CELLS = st.sampled_from(
    [
        "1",
        "-0",
        " 2 ",
        "",
        " ",
        "nan",
        "NaN",
        "inf",
        "-Infinity",
        "1e400",
        "1e-400",
        "1_0",
        "0x1",
        "1.",
        ".5",
        "+3",
        "ü",
    ]
    + [
        "AUTO",
        '"4"',
        '"a,b"',
        'a"b',
        '""',
        '"""',
        "nan(1)",
        "\t5",
        "1\x0b",
        "1\x1f",
        "\u20281",
        "9" * 30,
        "true",
        "\r",
    ]
    + ["0.1234567890123456789", "1e5", "1E+5", "1d5", "١", "infinity", "NULL", "\0", "1\n", '"\n"']
) | st.floats().map(repr)
HEADS = st.sampled_from(
    ["a,b,c", " a ,b,c", '"a",b,c', "a,b,a", "a,b,", "a;b;c", "a,b", "\ufeffa,b,c", "a,b\x0b,c"]
)


@settings(max_examples=300, deadline=None, derandomize=True, database=None)
@given(
    HEADS,
    st.lists(st.lists(CELLS, min_size=3, max_size=3), max_size=4),
    st.sampled_from(["\n", "\r\n", "\n\n", "\r"]),
)
def test_native_code_reads_a_csv_as_python_does_line_by_line_or_not_at_all(
    tmp_path_factory: pytest.TempPathFactory, head: str, rows: list[list[str]], end: str
) -> None:
    content = end.join([head, *(",".join(cells) for cells in rows)]).encode() + end.encode()
    path = tmp_path_factory.getbasetemp() / "alike.csv"
    path.write_bytes(content)
    with path.open("rb") as file:
        quick = csv._read_fast(path, file.readline(), content)
    if quick is None:
        return
    slow = csv._read_line_by_line(path, content)
    assert list(quick.rows) == list(slow.rows) and list(quick.columns) == list(slow.columns)
    assert {n: (i, cell.replace("\r\n", "\n")) for n, (i, cell) in quick.text.items()} == slow.text
    for name, values in slow.columns.items():
        np.testing.assert_array_equal(quick.columns[name], values)
        np.testing.assert_array_equal(np.signbit(quick.columns[name]), np.signbit(values))


def test_a_csv_of_numbers_is_read_by_native_code(tmp_path: Path) -> None:
    content = b"t_s,x_m,mode\n0,0.5,AUTO\n1,,AUTO\n"
    quick = csv._read_fast(tmp_path / "run.csv", content[:13], content)
    assert quick is not None and quick.text == {"mode": (2, "AUTO")}
    np.testing.assert_array_equal(quick.columns["x_m"], [0.5, np.nan])


def test_a_hole_is_answered_by_the_part_to_use_and_that_part_is_read(tmp_path: Path) -> None:
    after = [
        line.replace(line.split(",")[0], f"{0.1 * i + 100.0:.1f}", 1)
        for i, line in enumerate(lines(60))
    ]
    path = file(tmp_path, HEADER + "".join(lines(30) + after))
    with pytest.raises(BadInput, match=r"use = \[\[0\.0, 2\.9\], \[100\.0, 105\.9\]\] in rec"):
        read(path)
    (tmp_path / "recording.toml").write_text("use = [100.0, 105.9]\n")
    assert len(read(path).used()) == 60
    (tmp_path / "recording.toml").write_text("use = [[0.0, 2.9], [100.0, 105.9]]\n")
    run = read(path)
    assert [len(part) for part in run.parts()] == [30, 60]
    assert [part.notes.use for part in run.parts()] == [((0.0, 2.9),), ((100.0, 105.9),)]
    assert len(run.used()) == 60 and "the longest one is used here" in run.used().remarks[-1]


@pytest.mark.parametrize(
    "use", ["[[5.0, 9.0], [0.0, 3.0]]", "[[0.0, 3.0], 4.0]", "[]", "[3.0, 1.0]"]
)
def test_parts_to_use_are_intervals_in_order_of_time(tmp_path: Path, use: str) -> None:
    path = file(tmp_path, HEADER + "".join(lines(60)))
    (tmp_path / "recording.toml").write_text(f"use = {use}\n")
    with pytest.raises(BadInput, match="or a list of these in order of time"):
        read(path)


def test_a_part_to_use_with_few_rows_is_refused_by_its_interval(tmp_path: Path) -> None:
    path = file(tmp_path, HEADER + "".join(lines(60)))
    (tmp_path / "recording.toml").write_text("use = [[0.0, 3.0], [5.0, 5.3]]\n")
    with pytest.raises(BadInput, match=r"4 rows in its part to use \[5\.0, 5\.3\]"):
        read(path)


def test_faults_outside_of_the_part_to_use_do_not_matter(tmp_path: Path) -> None:
    good = lines(60)
    bad = [good[0], good[2], good[1].replace("0.5\n", "99\n"), *good[3:]]
    path = file(tmp_path, HEADER + "".join(bad))
    with pytest.raises(BadInput, match="must increase"):
        read(path, LIMITS)
    (tmp_path / "recording.toml").write_text("use = [0.3, 9.0]\n")
    assert len(read(path, LIMITS).used()) == 57


def test_time_in_another_unit_is_no_hole(tmp_path: Path) -> None:
    slow = [
        line.replace(line.split(",")[0], f"{100.0 * i:.1f}", 1) for i, line in enumerate(lines(60))
    ]
    with pytest.raises(BadInput, match="is it in seconds"):
        read(file(tmp_path, HEADER + "".join(slow)))
