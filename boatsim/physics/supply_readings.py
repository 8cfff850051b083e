"""Functions that the effects of a measured voltage and of a measured current have in common."""

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import Boat, ChannelEffect, SignalSegment


@njit(inline="always")
def scaled_signal(x: SignalSegment, factor: float) -> SignalSegment:
    """Return a signal of an actuator times a factor, at each of the three instants of a step.

    Args:
        x: Signal at begin, middle and end of the step.
        factor: The factor, constant over the step.
    """
    return SignalSegment(x.begin * factor, x.middle * factor, x.end * factor)


def nominal_reading(effect: ChannelEffect, vessel: Boat, quantity: str) -> float:
    """Return the neutral value of the measured quantities that feed an effect, in their unit.

    Args:
        effect: The effect.
        vessel: Vessel on which it acts.
        quantity: Name of the quantity in messages, such as "voltage".

    Raises:
        BadInput: The neutral values are not above 0, or are not the same.
    """
    unit = type(effect).measured_unit
    neutral = {name: vessel.neutral_value(name) for name in effect.fed_by}
    for name, value in neutral.items():
        if not value > 0.0:
            raise BadInput(
                f"{vessel.name}: measured.{name}: neutral = {value:g}; allowed is the nominal "
                f"{quantity}, more than 0, or {effect.name} needs nominal"
            )
    if len(set(neutral.values())) > 1:
        listed = ", ".join(f"{name} {value:g} {unit}" for name, value in neutral.items())
        raise BadInput(
            f"{vessel.name}: {effect.name}: nominal {quantity}s {listed}; allowed is one for all: "
            "add one effect for each"
        )
    return next(iter(neutral.values()), 0.0)
