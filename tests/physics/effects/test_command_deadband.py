"""Dead band of commands as a share of full command, with full thrust unchanged."""

from types import SimpleNamespace

import pytest

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics import vessel
from boatsim.physics.effects.command_deadband import apply_command_deadband


@pytest.mark.parametrize(
    ("command", "thrust"),
    [
        (0.0, 0.0),
        (0.8, 0.0),
        (1.0, 0.25),
        (2.4, 2.0),
        (4.0, 4.0),
        (-0.4, 0.0),
        (-1.2, -1.0),
        (-2.0, -2.0),
    ],
)
def test_full_thrust_is_kept_in_both_directions(command: float, thrust: float) -> None:
    values = SimpleNamespace(share=0.2, full_ahead=4.0, full_astern=2.0)
    assert apply_command_deadband.py_func(command, values) == pytest.approx(thrust)


def test_it_is_tested_only_where_the_limits_differ() -> None:
    """Elsewhere it differs from a dead band by friction only in the thrust of all commands."""
    assert (
        "command_deadband" not in candidate_library(vessel.load_vessel("trial_boat")).tested_names
    )
    assert "command_deadband" in candidate_library(vessel.load_vessel("blueboat")).tested_names
