"""Findings on motions and commands that a recording lacks."""

import numpy as np
import pytest

from boatsim.diagnosis.checks.excitation import check_excitation
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

VESSEL = load_vessel("joystick_boat")
T = np.arange(0.0, 20.0, 0.1)


def evidence(commands: dict[str, float], swings: tuple[str, ...]) -> str:
    """What is said of commands (values) of which some swing by half their range."""
    signals = {"psi_rad": 0.1 * T}
    for name, value in commands.items():
        span = VESSEL.commands[name].high - VESSEL.commands[name].low
        signals[name] = value + 0.25 * span * np.sin(T) * (name in swings)
    found = check_excitation(Recording("run", T, signals), VESSEL, DEFAULT.checks)
    return next((one.evidence for one in found if one.name == "never_moved"), "")


PWM = {"pwm_port": 50.0, "pwm_starboard": 0.0}


@pytest.mark.parametrize(
    ("swings", "said"),
    [
        ((), "no command moves"),
        (("pwm_port",), "pwm_starboard never move"),
        (("pwm_port", "pwm_starboard"), ""),
    ],
)
def test_commands_that_never_move_are_reported(swings: tuple[str, ...], said: str) -> None:
    assert evidence(PWM, swings) == said


def test_a_recording_without_commands_is_not_one_whose_commands_stand_still() -> None:
    assert evidence({}, ()) == ""
