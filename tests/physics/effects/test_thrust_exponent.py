"""Thrust exponent: thrust by a power of the command, with full thrust unchanged."""

from types import SimpleNamespace

import pytest

from boatsim.physics import vessel
from boatsim.physics.effects.thrust_exponent import apply_exponent


@pytest.mark.parametrize(
    ("exponent", "command", "thrust"),
    [
        (2.0, 4.0, 4.0),
        (2.0, 2.0, 1.0),
        (2.0, -1.0, -0.5),
        (2.0, -2.0, -2.0),
        (0.5, 1.0, 2.0),
        (0.5, 0.0, 0.0),
        (1.0, 3.0, 3.0),
        (1.0, -0.4, -0.4),
    ],
)
def test_full_thrust_is_kept_and_part_thrust_follows_the_power(
    exponent: float, command: float, thrust: float
) -> None:
    values = SimpleNamespace(exponent=exponent, full_ahead=4.0, full_astern=2.0)
    assert apply_exponent.py_func(command, values) == pytest.approx(thrust)


def test_full_thrust_is_the_limit_of_the_commands() -> None:
    boat = vessel.load_vessel("trial_boat", extra=[{"use": "thrust_exponent"}])
    effect = boat.effect("thrust_exponent")
    assert effect is not None
    low, high = boat.limits()["thrust_port_N"]
    assert effect.derived_parameters(boat) == {"full_ahead": high, "full_astern": -low}
