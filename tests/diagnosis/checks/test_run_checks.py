"""What is wrong with a log is named with the line that puts it right; good logs are left in
peace."""

import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long, slow
from answers import diagnosed
from real_boat import Real, recorded
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.diagnosis.checks.data_cleaning import drop_faulty_values
from boatsim.diagnosis.checks.finding import Change, apply_corrections, columns_table_lines
from boatsim.diagnosis.checks.position_jumps import jump_rows
from boatsim.diagnosis.loading import open_recording, vessel_of_recording_file
from boatsim.diagnosis.log_check import check_files
from boatsim.diagnosis.pipeline import diagnose
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.recordings.expression import parse
from boatsim.recordings.table import Recording, read, write_csv
from validation.log_faults import FAULTS, Columns, simulate_log, write

TRIALS = Path(__file__).parents[2] / "data" / "trials"
BOAT = vessel.load_vessel("trial_boat")
QUICK = (
    "y to port, heading too",
    "heading in degrees",
    "latitude as metres",
    "commands in per cent",
    "time in ms",
)
LINES = [
    name
    for name in FAULTS
    if name not in ("position held", "outliers in bursts", "gaps bridged", "clock stalls")
]


# Other faults of the same columns have lines of the same form.
REPEATED = ("y to port alone", "x and y exchanged", "thrusters exchanged", "heading turned 90 deg")


def marked_line(name: str) -> Any:
    """Return a fault whose line is tested, among the slow or long tests if it takes longer."""
    if name in QUICK:
        return name
    return long(name) if name in REPEATED else slow(name)


def columns_of(recording: Recording) -> Columns:
    return {"t_s": recording.t, **recording.signals}


def good(runs: int = 2) -> list[Columns]:
    return [columns_of(read(TRIALS / "T003" / f"run_{k + 1}.csv")) for k in range(runs)]


def files(folder: Path, logs: Sequence[Columns]) -> list[Path]:
    folder.mkdir(exist_ok=True)
    paths = [folder / f"run_{k}.csv" for k in range(1, len(logs) + 1)]
    for path, log in zip(paths, logs, strict=True):
        write(log, path)
    return paths


def found_in(paths: Sequence[Path], name: str = "trial_boat") -> list[Mapping[str, Any]]:
    found, refused = check_files(paths, name)
    assert not refused or any(found.values()), refused
    return [e for entries in found.values() for e in entries if e["kind"] != "limit"]


def corrected(folder: Path, entry: Mapping[str, Any]) -> None:
    (folder / "recording.toml").write_text("\n".join(entry["lines"]) + "\n")


@pytest.mark.parametrize(
    "title", [n if n in QUICK else pytest.param(n, marks=pytest.mark.slow) for n in FAULTS]
)
def test_each_fault_is_found_and_named(title: str, tmp_path: Path) -> None:
    fault = FAULTS[title]
    found = found_in(files(tmp_path, [fault.apply(log, BOAT) for log in good()]))
    assert {e["name"] for e in found} & set(fault.named), found
    assert {e["name"] for e in found if e["kind"] == "fault"} <= set(fault.named), found
    assert all(e["sure"] > 0.5 and e["evidence"] and (e["lines"] or e["remedy"]) for e in found)
    assert any(c.isdigit() for c in found[0]["evidence"])


@pytest.mark.parametrize("title", [marked_line(name) for name in LINES])
def test_the_line_written_into_the_recording_toml_puts_it_right(title: str, tmp_path: Path) -> None:
    logs = good()
    paths = files(tmp_path, [FAULTS[title].apply(log, BOAT) for log in logs])
    entry = next(e for e in found_in(paths) if e["lines"])
    if title == "heading turned 40 deg":
        (degrees,) = re.findall(r"psi_rad - (\d+) \* deg", entry["lines"][-1])
        assert abs(float(degrees) - 40.0) <= 4.0
    corrected(tmp_path, entry)
    assert not found_in(paths)
    if title in ("position leaps", "ENU axes", "heading turned 40 deg", "latitude as metres"):
        return  # a part of it, another north, a degree or an origin off
    again = columns_of(read(paths[0]))
    for name, values in logs[0].items():
        off = again[name] - values
        turns = 2.0 * np.pi * np.round(off[0] / (2.0 * np.pi)) if name == "psi_rad" else 0.0
        assert np.abs(off - turns).max() < 1e-9, name


@pytest.mark.parametrize("title", [long("heading in degrees"), "y to port, heading too"])
@pytest.mark.slow
def test_the_diagnosis_of_the_corrected_log_is_that_of_the_good_one(
    title: str, tmp_path: Path
) -> None:
    true = diagnose(files(tmp_path / "good", good(3)), vessel="trial_boat").findings.answer
    paths = files(tmp_path / "bad", [FAULTS[title].apply(log, BOAT) for log in good(3)])
    corrected(tmp_path / "bad", next(e for e in found_in(paths) if e["lines"]))
    answer = diagnose(paths, vessel="trial_boat").findings.answer
    assert (answer["verdict"], answer["sentence"]) == (true["verdict"], true["sentence"])
    for key, rms in true["fit"]["position_rms_m"].items():
        assert answer["fit"]["position_rms_m"][key] == pytest.approx(rms, rel=1e-3)


def test_enu_axes_are_the_other_line_of_a_mirrored_log(tmp_path: Path) -> None:
    """Where no north is known a log mirrored and one in ENU axes are one, but for a turn of the
    world."""
    logs = good()
    paths = files(tmp_path, [FAULTS["ENU axes"].apply(log, BOAT) for log in logs])
    entry = next(e for e in found_in(paths) if e["lines"])
    assert entry["name"] == "mirrored"
    corrected(tmp_path, {"lines": ["[columns]", *entry["alternatives"][0]["lines"]]})
    again = columns_of(read(paths[0]))
    assert all(np.allclose(again[n], values, atol=1e-9) for n, values in logs[0].items())


@pytest.mark.parametrize("trial", ["T002", "T003", "T019"])
def test_a_trial_is_a_good_log(trial: str) -> None:
    assert not found_in(sorted((TRIALS / trial).glob("run_*.csv")))


@pytest.mark.parametrize(
    "real",
    [
        Real(),
        Real(late=0.3),
        Real(stream=(0.1, -0.08)),
        long(Real(power=(1.0, 0.6))),
        long(Real(bent=(0.1, 0.1))),
        Real(munk=1.0),
    ],
    ids=["as written", "late", "current", "weak thruster", "bent", "munk"],
)
@pytest.mark.slow
def test_what_a_boat_does_is_no_fault_of_its_log(real: Real, tmp_path: Path) -> None:
    runs = [replace(recorded(real, s), name=f"run_{s}") for s in (1, 2)]
    for run in runs:
        write_csv(run, tmp_path / f"{run.name}.csv")
    assert not found_in(sorted(tmp_path.glob("*.csv")))


@pytest.mark.slow  # the whole library is tried on a log that nothing explains
def test_a_mirrored_log_is_the_first_thing_that_a_diagnosis_says(tmp_path: Path) -> None:
    fault = FAULTS["y to port, heading too"]
    # half of each log is enough
    halves = [{n: v[: len(v) // 2] for n, v in log.items()} for log in good()]
    logs = [fault.apply(log, BOAT) for log in halves]
    runs = [
        Recording(f"run_{k}", log["t_s"], {n: v for n, v in log.items() if n != "t_s"})
        for k, log in enumerate(logs)
    ]
    answer = diagnosed(runs, tmp_path, "trial_boat")
    assert answer["sentence"].startswith(
        "Probably your log, not your boat: y and the heading are counted to port"
    )
    assert [e["name"] for e in answer["log"]] == ["mirrored"]
    assert answer["log"][0]["lines"] == ["[columns]", 'y_m = "-y_m"', 'psi_rad = "-psi_rad"']


def test_the_command_leaves_with_its_codes_and_one_line(tmp_path: Path) -> None:
    ask = CliRunner()
    well = files(tmp_path / "well", good())[0]
    assert ask.invoke(app, ["check", str(well), "--vessel", "trial_boat"]).exit_code == 0
    ill = files(tmp_path / "ill", [FAULTS["heading in degrees"].apply(good()[0], BOAT)])[0]
    told = ask.invoke(app, ["check", str(ill), "--vessel", "trial_boat"])
    assert told.exit_code == 1
    assert (
        "probably your log, not your boat" in told.output
        and 'psi_rad = "psi_rad * deg"' in told.output
    )
    bad = tmp_path / "bad.csv"
    bad.write_text("a,b\n1,2\n")
    assert ask.invoke(app, ["check", str(bad), "--vessel", "trial_boat"]).exit_code == 2
    refused = ask.invoke(
        app, ["diagnose", str(ill), "--vessel", "trial_boat", "--out", str(tmp_path / "out")]
    )
    assert refused.exit_code == 2 and 'psi_rad = "psi_rad * deg"' in refused.stderr


@pytest.mark.slow
def test_nothing_is_advised_that_the_boat_can_not_do(tmp_path: Path) -> None:
    """Thrusters that cannot be turned are not told to turn, and one that can only push is not told
    to go astern."""
    boat = vessel.load_vessel("blueboat")
    log = simulate_log(boat, 1)
    for name in boat.commands:
        log[name] = np.abs(log[name])
    path = files(tmp_path, [log])[0]
    told = [e for e in check_files([path], "blueboat")[0][path] if e["kind"] == "limit"]
    assert "never_astern" in {e["name"] for e in told}
    assert not any("steer" in f"{e['evidence']} {e.get('remedy')}" for e in told)


def rated(log: Columns, rng: np.random.Generator) -> Columns:
    """The log with the speeds that follow from a smoothed course, as an estimator gives them."""
    kernel = np.ones(5) / 5.0
    x, y, psi = (np.convolve(log[n], kernel, "same") for n in ("x_m", "y_m", "psi_rad"))
    dx, dy, r = (np.gradient(v, log["t_s"]) for v in (x, y, psi))
    c, s = np.cos(psi), np.sin(psi)
    made = {"u_mps": c * dx + s * dy, "v_mps": c * dy - s * dx, "r_radps": r}
    inside = slice(8, -8)
    noisy = {n: v + 0.003 * rng.standard_normal(len(v)) for n, v in made.items()}
    return {n: v[inside] for n, v in {**log, **noisy}.items()}


def late(values: Array, rows: int) -> Array:
    return np.concatenate((np.full(rows, values[0]), values[:-rows]))


RATES = {
    "velocity_sign": lambda c: c | {"v_mps": -c["v_mps"]},
    "velocity_unit": lambda c: c | {"u_mps": c["u_mps"] * 3600.0 / 1852.0},
    "velocity_late": lambda c: c | {"r_radps": late(c["r_radps"], 6)},
    "velocity_elsewhere": lambda c: c | {"v_mps": c["v_mps"] + 0.5 * c["r_radps"]},
}


@pytest.mark.parametrize("name", RATES)
def test_recorded_velocities_that_contradict_the_positions_are_found(
    name: str, tmp_path: Path
) -> None:
    log = rated(good()[0], np.random.default_rng(1))
    path = files(tmp_path, [log])[0]
    assert not found_in([path])
    write(RATES[name](log), path)
    found = found_in([path])
    assert name in [e["name"] for e in found], found
    corrected(tmp_path, next(e for e in found if e["name"] == name))
    assert name not in [e["name"] for e in found_in([path])]


def test_a_clock_that_leaps_while_the_boat_stays_is_told_from_a_pause(tmp_path: Path) -> None:
    log = good()[0]
    half = len(log["t_s"]) // 2
    leapt = log | {"t_s": log["t_s"] + 40.0 * (np.arange(len(log["t_s"])) >= half)}
    found = found_in(files(tmp_path, [leapt]))
    assert [e["name"] for e in found] == ["clock_leaps"]
    corrected(tmp_path, found[0])
    assert not found_in([tmp_path / "run_1.csv"])
    shutil.rmtree(tmp_path)
    away = leapt | {"x_m": leapt["x_m"] + 15.0 * (leapt["t_s"] > log["t_s"][half] + 1.0)}
    assert "clock_leaps" not in [e["name"] for e in found_in(files(tmp_path, [away]))]


def test_hard_turns_and_crash_stops_are_no_leaps() -> None:
    rng, t = np.random.default_rng(3), np.arange(0.0, 60.0, 0.1)
    heading = 0.8 * np.cumsum(np.where(np.sin(0.6 * t) > 0.0, 1.0, -1.0)) * 0.1
    speed = np.where((t > 20.0) & (t < 40.0), 1.0, 0.0)
    path = 0.1 * np.cumsum(
        speed[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0
    )
    path += 0.003 * rng.standard_normal(path.shape)
    assert not len(jump_rows(t, path))
    moved = path + np.where(t[:, None] > 30.0, [[1.0, 0.0]], 0.0)
    assert jump_rows(t, moved).tolist() == [int(np.flatnonzero(t <= 30.0)[-1])]


@pytest.mark.parametrize("seconds", [0.5, 4.0, 10.0])
def test_fixes_that_leap_away_and_come_back_are_dropped_and_no_part_is_cut_off(
    seconds: float, tmp_path: Path
) -> None:
    log = good()[0]
    begin = 0.6 * log["t_s"][-1]
    away = (log["t_s"] > begin) & (log["t_s"] <= begin + seconds)
    path = files(tmp_path, [log | {"x_m": log["x_m"] + 9.0 * away, "y_m": log["y_m"] - 7.0 * away}])
    recording, vessel = open_recording(path[0], "trial_boat", ())
    cleaned = drop_faulty_values(recording, vessel)
    assert (np.isnan(cleaned["x_m"]) == away).all() and (cleaned.t == recording.t).all()
    said = [e["name"] for e in found_in(path)]
    assert said == ["outliers"]


@pytest.mark.parametrize(
    "change", [Change("psi_rad", "psi_rad", -1.0, np.pi / 2), Change("x_m", "y_m", 0.01, -12.5)]
)
def test_a_line_says_what_the_change_does(change: Change) -> None:
    """On top of what the column is made of already."""
    t = np.linspace(0.0, 1.0, 30)
    raw = {"heading_deg": 30.0 * t, "east": 7.0 * t}
    sources = {"psi_rad": parse("heading_deg * deg"), "y_m": parse("east * ft")}
    ours = {name: e.convert(raw[e.signal]) for name, e in sources.items()}
    line = columns_table_lines([change], sources)[0]
    name, _, text = line.partition(" = ")
    made = parse(text.strip('"'))
    wanted = apply_corrections(Recording("run", t, ours), [change])[change.column]
    assert name == change.column and np.allclose(made.convert(raw[made.signal]), wanted, atol=1e-9)


def test_all_mistakes_of_a_file_are_said_at_once(tmp_path: Path) -> None:
    path = files(tmp_path, good())[0]
    (tmp_path / "recording.toml").write_text(
        'vessel = "trial_boat"\nuse = [5, 1]\nscale = "big"\ncolumns = 3\n'
    )
    with pytest.raises(BadInput) as told:
        read(path)
    assert all(key in str(told.value) for key in ("use = [5, 1]", "scale = 'big'", "columns = 3"))
    (tmp_path / "recording.toml").unlink()
    log = good()[0]
    write(
        log
        | {
            "psi_rad": np.degrees(log["psi_rad"]) % 360.0,
            "thrust_port_N": 5.0 + log["thrust_port_N"],
        },
        path,
    )
    with pytest.raises(BadInput) as told:
        read(path, BOAT.limits())
    assert (
        "psi_rad" in str(told.value)
        and "thrust_port_N" in str(told.value)
        and "\n" not in str(told.value)
    )


def test_the_vessel_of_a_recording_toml_lies_where_that_file_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(BOAT.file.parent, tmp_path / "boats" / "mine")
    (tmp_path / "runs").mkdir()
    path = files(tmp_path / "runs", good())[0]
    (tmp_path / "runs" / "recording.toml").write_text('vessel = "../boats/mine"\n')
    monkeypatch.chdir(Path(__file__).parents[2])
    assert (
        vessel_of_recording_file(path, None, []).file
        == (tmp_path / "boats" / "mine" / "vessel.toml").resolve()
    )


def test_columns_under_other_names_are_found_again(tmp_path: Path) -> None:
    log = good()[0]
    other = {"psi_rad": "heading_deg", "x_m": "north", "thrust_port_N": "thrust_left"}
    made = {other.get(n, n): np.degrees(v) if n == "psi_rad" else v for n, v in log.items()}
    paths = files(tmp_path, [made])
    found = found_in(paths)
    assert [e["name"] for e in found] == ["column_names"]
    assert set(found[0]["lines"]) == {
        "[columns]",
        'psi_rad = "heading_deg * deg"',
        'x_m = "north"',
        'thrust_port_N = "thrust_left"',
    }
    corrected(tmp_path, found[0])
    assert not found_in(paths)
