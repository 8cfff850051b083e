"""Columns of the two sides that are exchanged, and signs of single drives that are reversed."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.checks.reinterpretations import reinterpretations
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.log_check import check_files
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Recording
from validation.log_faults import FAULTS, Columns, simulate_log, write

THRUST = ("thrust_port_N", "thrust_starboard_N")
STEERING = ("steer_port_rad", "steer_starboard_rad")
SEED = 5


def faults(log: Columns, vessel: str, folder: Path) -> list[Mapping[str, Any]]:
    write(log, folder / "run.csv")
    found, refused = check_files([folder / "run.csv"], vessel)
    assert not refused
    return [entry for entry in found[folder / "run.csv"] if entry["kind"] == "fault"]


def exchanged(log: Columns, one: str, other: str) -> Columns:
    return log | {one: log[other], other: log[one]}


@pytest.fixture(scope="module")
def log() -> Columns:
    return simulate_log(load_vessel("trial_boat"), SEED)


def test_a_good_log_has_no_fault(log: Columns, tmp_path: Path) -> None:
    assert not faults(log, "trial_boat", tmp_path)


@pytest.mark.parametrize("channels", [THRUST, STEERING])
@pytest.mark.slow
def test_exchanged_columns_of_one_unit_are_found(
    log: Columns, channels: tuple[str, str], tmp_path: Path
) -> None:
    (entry,) = faults(exchanged(log, *channels), "trial_boat", tmp_path)
    assert entry["name"] == "thrusters_exchanged"
    one, other = channels
    assert entry["lines"] == ["[columns]", f'{one} = "{other}"', f'{other} = "{one}"']
    assert "that the better fit is chance" in entry["evidence"]


@pytest.mark.parametrize("channel", [THRUST[1], STEERING[0]])
@pytest.mark.slow
def test_a_reversed_sign_of_one_drive_is_found_with_the_drive(
    log: Columns, channel: str, tmp_path: Path
) -> None:
    (entry,) = faults(log | {channel: -log[channel]}, "trial_boat", tmp_path)
    assert entry["name"] in ("thrust_reversed", "rudder_reversed")
    assert entry["lines"] == ["[columns]", f'{channel} = "-{channel}"']


def exchanges_of(boat: Vessel) -> list[set[frozenset[str]]]:
    """Pairs of columns that each reinterpretation exchanges."""
    times = np.arange(20.0)
    signals = dict.fromkeys(("x_m", "y_m", "psi_rad", *boat.commands), np.zeros(20))
    found = reinterpretations([Recording("run", times, signals)], boat, DEFAULT.checks)
    named = [each for each in found if each.name == "thrusters_exchanged"]
    return [{frozenset((c.column, c.source)) for c in each.changes} for each in named]


def four_drives() -> Vessel:
    """A vessel whose four drives have numbers and no sides in their names."""
    places = {"1": (0.6, -0.3), "2": (0.6, 0.3), "3": (-0.6, -0.3), "4": (-0.6, 0.3)}
    effects = []
    for name, (x, y) in places.items():
        on = {"thrust": f"drive_{name}_N", "angle": 0.0}
        effects.append({"use": "thruster", "name": f"drive_{name}", "on": on, "x": x, "y": y})
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "sway", "yaw"),
        length=1.5,
        beam=0.9,
        draught=0.1,
        body={"mass": 30.0, "roll_inertia": 2.0, "yaw_inertia": 4.0},
        effects=effects,
        channels={f"drive_{name}_N": {"low": -8.0, "high": 8.0} for name in places},
    )


def test_sides_without_names_follow_from_the_places_of_the_drives() -> None:
    bow, stern = frozenset({"drive_1_N", "drive_2_N"}), frozenset({"drive_3_N", "drive_4_N"})
    assert exchanges_of(four_drives()) == [{bow, stern}, {bow}, {stern}]


def test_two_drives_with_sides_in_their_names_have_one_exchange() -> None:
    boat = load_vessel("otter")
    assert exchanges_of(boat) == [{frozenset(boat.commands)}]
    assert exchanges_of(replace(boat, effects=())) == [{frozenset(boat.commands)}]


MIRRORED = "y and the heading are counted to port"


@pytest.mark.parametrize("title", ["thrusters exchanged", "y to port, heading too"])
@pytest.mark.parametrize("fix", ["gnss", "camera"])
def test_positions_of_satellites_are_not_mirrored(title: str, fix: str, tmp_path: Path) -> None:
    """On a boat with two fixed thrusters both faults give the same log."""
    boat = load_vessel("blueboat")
    (tmp_path / "recording.toml").write_text(f'[facts]\nposition_fix = "{fix}"\n')
    log = FAULTS[title].apply(simulate_log(boat, SEED), boat)
    (entry,) = faults(log, "blueboat", tmp_path)
    one, other = THRUST
    exchanged_lines = [f'{one} = "{other}"', f'{other} = "{one}"']
    alternatives = {each["words"]: each["lines"] for each in entry["alternatives"]}
    if fix == "gnss":
        assert entry["name"] == "thrusters_exchanged"
        assert entry["lines"] == ["[columns]", *exchanged_lines]
        assert alternatives[MIRRORED] == ['y_m = "-y_m"', 'psi_rad = "-psi_rad"']
        assert "x east, y north (ENU)" in alternatives
        assert f"{MIRRORED}, but it is less likely: a satellite receiver" in entry["evidence"]
    else:
        assert entry["name"] == "mirrored"
        assert alternatives[f"{one} and {other} are exchanged"] == exchanged_lines
        assert "The log does not show which" in entry["evidence"]


@pytest.mark.slow
def test_a_log_that_only_mirroring_explains_is_mirrored_with_satellites_too(
    log: Columns, tmp_path: Path
) -> None:
    boat = load_vessel("trial_boat")
    (tmp_path / "recording.toml").write_text('[facts]\nposition_fix = "gnss"\n')
    (entry,) = faults(FAULTS["y to port, heading too"].apply(log, boat), "trial_boat", tmp_path)
    assert entry["name"] == "mirrored"
