"""Directions of drives: whole turns change nothing, and only large ones at high rates are degrees."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.checks.command_unit import direction_in_degrees
from boatsim.diagnosis.checks.wrapped_angles import unwrap_directions
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.commands import clipped_recorded_commands
from boatsim.physics.effects.thruster import Thruster
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.physics.vessel.schema import CommandChannel
from boatsim.recordings.table import Recording, read

T = np.arange(400) * 0.1  # [s]


def ferry(reach: float = np.pi) -> Vessel:
    """A vessel with one azimuth thruster."""
    channels = {
        "port_N": CommandChannel(low=-5.0, high=5.0),
        "port_rad": CommandChannel(low=-reach, high=reach),
    }
    drive = Thruster(name="azimuth", on={"thrust": "port_N", "angle": "port_rad"}, x=-0.5)
    return replace(load_vessel("otter"), commands=channels, effects=(drive,))


def test_a_drive_that_turns_all_round_has_no_limit_of_its_direction_in_a_log() -> None:
    assert ferry().full_turns == ("port_rad",)
    assert ferry().recorded_limits() == {"port_N": (-5.0, 5.0), "port_rad": (-np.inf, np.inf)}
    assert ferry(1.5).full_turns == ()
    assert ferry(1.5).recorded_limits()["port_rad"] == (-1.5, 1.5)


def test_a_rudder_keeps_its_limit_because_its_law_is_no_function_of_sine_and_cosine() -> None:
    boat = load_vessel("mariner")
    assert boat.full_turns == ()
    assert boat.recorded_limits() == boat.limits()


def test_turns_that_a_log_counts_on_are_read_and_kept(tmp_path: Path) -> None:
    angle = 0.3 * T
    table = {"x_m": T, "y_m": T, "psi_rad": 0.0 * T, "port_N": 0.0 * T, "port_rad": angle}
    file = tmp_path / "run.csv"
    rows = np.column_stack([T, *table.values()])
    np.savetxt(file, rows, delimiter=",", header=",".join(["t_s", *table]), comments="")
    signals = read(file, ferry().recorded_limits()).signals
    commands = clipped_recorded_commands(ferry(), signals, len(T))
    assert commands[:, 1] == pytest.approx(angle)


def test_a_wrapped_direction_takes_the_shorter_way_round() -> None:
    angle = 0.3 * T
    wrapped = np.angle(np.exp(1j * angle))
    recording = Recording("run", T, {"port_rad": wrapped})
    assert unwrap_directions(recording, ferry())["port_rad"] == pytest.approx(angle)
    assert unwrap_directions(recording, ferry(3.0))["port_rad"] == pytest.approx(wrapped)


def test_a_direction_is_in_degrees_only_if_it_is_large_and_fast() -> None:
    degrees = 90.0 * np.sin(0.5 * T)
    assert direction_in_degrees(T, degrees, DEFAULT.checks)
    assert direction_in_degrees(T, (36.0 * T) % 360.0, DEFAULT.checks)
    assert not direction_in_degrees(T, np.radians(degrees), DEFAULT.checks)
    assert not direction_in_degrees(T, 0.8 * T, DEFAULT.checks)  # five turns, counted on
