"""Laws of the faults that one drive of several has alone."""

import numpy as np
import pytest
from driven_boats import platform_of_three_drives

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.open_water import OpenWater

STEP = 0.02  # [s] of the simulation


def final_state(boat: Vessel, commands: dict[str, float], steps: int = 100) -> Array:
    """Pose and velocities after a time under constant commands, from rest."""
    engine = OpenWater(boat, STEP)
    engine.reset(commands=commands)
    for _ in range(steps):
        engine.command(commands)
        engine.advance()
    now = engine.state
    return np.array([now.x, now.y, now.psi, now.u, now.v, now.r])


@pytest.mark.parametrize(("command", "thrust"), [(5.0, 3.4), (1.2, 0.0), (-1.6, 0.0), (-4.0, -2.4)])
def test_a_dead_band_reduces_the_thrust_of_its_drive_alone(command: float, thrust: float) -> None:
    boat = platform_of_three_drives()
    dead = boat.with_effect({"use": "drive_deadband", "width": 1.6, "on": ["port_N"]})
    others = {"bow_N": 1.0, "starboard_N": 3.0}
    found = final_state(dead, {"port_N": command, **others})
    assert found == pytest.approx(final_state(boat, {"port_N": thrust, **others}))


def test_a_dead_band_is_a_candidate_for_each_of_several_drives() -> None:
    several = candidate_library(platform_of_three_drives()).tested_names
    names = {f"drive_deadband_{drive}_N" for drive in ("bow", "port", "starboard")}
    assert names == {name for name in several if "drive_deadband" in name}
    two = candidate_library(vessel.load_vessel("trial_boat"))
    assert "drive_deadband" in two.inapplicable
