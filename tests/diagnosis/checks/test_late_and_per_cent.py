"""Late sensors and commands in per cent are found with the lines that mend them; good logs of several
vessels, also with physics that their models lack, are left in peace."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from shutil import copy
from typing import Any

import numpy as np
import pytest
from alike import long

from boatsim.diagnosis.checks.late_sensors import check_late_sensors
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import Request, load_recordings
from boatsim.diagnosis.log_check import check_files
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.newboat.particulars import Options, parse_particulars
from boatsim.newboat.write import boat_files
from boatsim.physics.base import Array
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording, read, write_csv
from boatsim.simulate import scenario
from boatsim.simulate.run import run

# Vessel -> goals of a run with turns, changes of speed and astern
GOALS = {
    "trial_boat": {
        "thrust_port_N": (0.4, 0.5, 9.0),
        "thrust_starboard_N": (0.4, 0.4, 7.0),
        "steer_port_rad": (0.0, 0.3, 11.0),
        "steer_starboard_rad": (0.0, 0.3, 11.0),
    },
    "blueboat": {"thrust_port_N": (10.0, 22.0, 13.0), "thrust_starboard_N": (10.0, 20.0, 9.0)},
    "mine": {"thrust_port_N": (10.0, 22.0, 17.0), "thrust_starboard_N": (10.0, 21.0, 11.0)},
}
LACKING = {  # of the model of a good log: nothing, other effects that look late or like per cent
    "nothing": "",
    "water and drives": '[[effect]]\nuse = "current"\nnorth = 0.1\n[[effect]]\nuse = "thrust_lag"\n'
    'time_constant = 0.5\n[[effect]]\nuse = "weak_reverse"\nastern_factor = 0.6\n',
    "antenna astern": '[[effect]]\nuse = "position_frame_error"\nforward = -0.3\n[[effect]]\n'
    'use = "command_delay"\ndelay = 0.3\n',
}


@pytest.fixture(scope="module")
def mine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A boat of `boatsim new` with more thrust ahead than astern."""
    folder = tmp_path_factory.mktemp("boats") / "mine"
    folder.mkdir()
    thrusters = ["-1.2,-0.6,60,40", "-1.2,0.6,60,40"]
    boat = parse_particulars("mine", 3.0, 1.6, 90.0, Options(thrusters=thrusters))
    for name, text in boat_files(boat).items():
        (folder / name).write_text(text)
    return folder / "vessel.toml"


def simulated(folder: Path, vessel: str, goals: Mapping[str, Any], effects: str = "") -> Recording:
    """A run of 100 s of a vessel with further effects."""
    lines = []
    for channel, (mean, size, period) in goals.items():
        lines.append(f"{channel} = {{ mean = {mean}, amplitude = {size}, period = {period} }}")
    text = f'vessel = "{vessel}"\nduration = 100\nlog = 0.05\n{effects}'
    text += '[controller]\nuse = "open_loop"\n[[goal]]\n' + "\n".join(lines) + "\n"
    (folder / "run.toml").write_text(text)
    return run(scenario.load(str(folder / "run.toml"))).recording


def logged(
    log: Recording, folder: Path, vessel: str, goals: Mapping[str, Any], late: Mapping[str, float]
) -> Path:
    """The log of instruments at 10 Hz with noise, of which some are late."""
    rng, t = np.random.default_rng(3), np.arange(3.0, 99.0, 0.1)
    signals: dict[str, Array] = {}
    for name, sd in (("x_m", 0.02), ("y_m", 0.02), ("psi_rad", 0.01), ("r_radps", 0.005)):
        values = log[name]
        if name == "psi_rad":
            values = np.unwrap(values)
        true = np.interp(t - late.get(name, 0.0), log.t, values)
        signals[name] = true + sd * rng.standard_normal(len(t))
    for name in goals:
        signals[name] = log[name][np.searchsorted(log.t, t + 1e-6) - 1]
    write_csv(Recording("log", t - t[0], signals), folder / "log.csv")
    (folder / "recording.toml").write_text(f'vessel = "{vessel}"\n')
    return folder / "log.csv"


def with_commands(path: Path, vessel: str, per_cent: bool) -> None:
    """Write the thrusts of a log as whole per cent of full thrust, or as whole newtons."""
    log, boat = read(path), load_vessel(vessel)
    for name in log.signals.keys() & boat.commands.keys():
        if name.endswith("_N") and per_cent:
            command = boat.commands[name]
            full = np.where(log[name] > 0.0, command.high, -command.low)
            log.signals[name] = 100.0 * log[name] / full
        if name.endswith("_N"):
            log.signals[name] = np.round(log[name])
    write_csv(log, path)


def faults(path: Path) -> list[Mapping[str, Any]]:
    found, refused = check_files([path])
    assert not refused
    return [e for entries in found.values() for e in entries if e["kind"] == "fault"]


GOOD = []
for each in GOALS:
    for lack in LACKING:
        if each == "blueboat" or (each == "mine" and lack != "nothing"):
            GOOD.append(long(each, lack))
        else:
            GOOD.append(pytest.param(each, lack))


@pytest.mark.parametrize(("name", "lacking"), GOOD)
@pytest.mark.slow
def test_a_good_log_is_not_called_late_or_in_per_cent(
    name: str, lacking: str, tmp_path: Path, mine: Path
) -> None:
    vessel = name
    if name == "mine":
        vessel = str(mine)
    log = simulated(tmp_path, vessel, GOALS[name], LACKING[lacking])
    path = logged(log, tmp_path, vessel, GOALS[name], {})
    assert not faults(path)
    if name != "trial_boat":  # whose thrusts are of a newton
        with_commands(path, vessel, per_cent=False)
        assert not faults(path)


@pytest.mark.parametrize(
    ("name", "late"), [("late_positions", ("x_m", "y_m")), ("velocity_late", ("psi_rad",))]
)
@pytest.mark.slow
def test_late_sensors_are_found_with_the_line_that_mends_them(
    name: str, late: tuple[str, ...], tmp_path: Path, mine: Path
) -> None:
    log = simulated(tmp_path, str(mine), GOALS["mine"])
    path = logged(log, tmp_path, str(mine), GOALS["mine"], dict.fromkeys(late, 0.5))
    [entry] = faults(path)
    assert entry["name"] == name
    assert entry["lines"][0] == "[latency]"
    found = dict(line.split(" = ") for line in entry["lines"][1:])
    assert tuple(found) == late
    assert [float(text) for text in found.values()] == pytest.approx([0.5] * len(late), abs=0.11)
    notes = tmp_path / "recording.toml"
    notes.write_text(notes.read_text() + "\n".join(entry["lines"]) + "\n")
    assert not faults(path)


@pytest.mark.slow
@pytest.mark.parametrize(("smallest", "names"), [(0.1, ["late_positions"]), (0.4, [])])
def test_a_delay_below_the_smallest_one_is_not_reported(
    smallest: float, names: list[str], tmp_path: Path, mine: Path
) -> None:
    log = simulated(tmp_path, str(mine), GOALS["mine"])
    late = dict.fromkeys(("x_m", "y_m"), 0.5)  # 0.4 s of a hull of 1.2 m are 0.63 s of this one
    path = logged(log, tmp_path, str(mine), GOALS["mine"], late)
    checks = replace(DEFAULT.checks, late_min_delay=smallest)
    loaded = load_recordings(Request([path], hold_out=[Path(copy(path, tmp_path / "copy.csv"))]))
    problem = set_up_estimation_problem(loaded, replace(DEFAULT, checks=checks)).problem
    found = check_late_sensors(loaded.fitted, problem)
    assert [finding.name for finding in found] == names


def two_runs(folder: Path, delays: tuple[float, float]) -> list[Path]:
    """Two files with positions that are late by delays of their own [s]."""
    other = {}
    for channel, (mean, size, period) in GOALS["trial_boat"].items():
        other[channel] = (mean, size, 0.8 * period)
    paths = []
    for number, goals in enumerate((GOALS["trial_boat"], other)):
        log = simulated(folder, "trial_boat", goals)
        late = dict.fromkeys(("x_m", "y_m"), delays[number])
        path = logged(log, folder, "trial_boat", goals, late)
        paths.append(path.rename(folder / f"run_{number}.csv"))
    return paths


@pytest.mark.parametrize("delays", [(0.0, 0.0), (0.0, 1.0), (0.4, 1.2), (1.0, 1.0)])
@pytest.mark.slow
def test_each_file_has_a_delay_of_its_own(delays: tuple[float, float], tmp_path: Path) -> None:
    paths = two_runs(tmp_path, delays)
    entries = check_files(paths)[0]
    lines = list[str]()
    for path, delay in zip(paths, delays, strict=True):
        faulty = [entry for entry in entries[path] if entry["kind"] == "fault"]
        assert [entry["name"] for entry in faulty] == ["late_positions"] * (delay > 0.0)
        for entry in faulty:
            table = "[latency]"
            if delays[0] != delays[1]:
                table = f"[runs.{path.stem}.latency]"
            assert entry["lines"][0] == table
            found = [float(line.split(" = ")[1]) for line in entry["lines"][1:]]
            assert found == pytest.approx([delay, delay], abs=0.11)
            if table not in lines:
                lines += entry["lines"]
    notes = tmp_path / "recording.toml"
    notes.write_text(notes.read_text() + "\n".join(lines) + "\n")
    for found_now in check_files(paths)[0].values():
        assert not [entry for entry in found_now if entry["kind"] == "fault"]


@pytest.mark.slow
def test_a_rate_that_is_late_is_shifted_itself(tmp_path: Path, mine: Path) -> None:
    log = simulated(tmp_path, str(mine), GOALS["mine"])
    path = logged(log, tmp_path, str(mine), GOALS["mine"], {"r_radps": 0.5})
    [entry] = faults(path)
    assert entry["lines"][0] == "[latency]"
    [(column, delay)] = [line.split(" = ") for line in entry["lines"][1:]]
    assert column == "r_radps"
    assert float(delay) == pytest.approx(0.5, abs=0.02)


@pytest.mark.slow
def test_per_cent_within_the_newtons_of_the_channel_are_found(tmp_path: Path, mine: Path) -> None:
    log = simulated(tmp_path, str(mine), GOALS["mine"])
    path = logged(log, tmp_path, str(mine), GOALS["mine"], {})
    true = read(path)
    with_commands(path, str(mine), per_cent=True)
    [entry] = faults(path)
    assert entry["name"] == "command_unit" and "per cent" in entry["evidence"]
    notes = tmp_path / "recording.toml"
    notes.write_text(notes.read_text() + "\n".join(entry["lines"]) + "\n")
    assert not faults(path)
    again = read(path)
    for name in GOALS["mine"]:
        assert np.abs(again[name] - true[name]).max() < 0.31  # half a per cent of 60 N
