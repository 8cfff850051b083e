"""Thrust lag: first-order lag of motor and propeller."""

from dataclasses import dataclass
from math import inf, log
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    ChannelEffect,
    SignalSegment,
    first_order_lag,
    longest_lag_step,
    param,
    preset_effect,
)

NONE = 1e-4  # [s] a shorter lag counts as none
SAME = 1e-9  # share of a command: a smaller thrust of the other sign counts as zero


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust that follows its command with a first-order lag.

    The result is exact for a command that is a parabola over the step.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Raw command that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    if q.time_constant < NONE:
        memory[at] = x.end
        return x
    return first_order_lag(x, q.time_constant, memory, at, dt)


@njit(inline="always")
def time_to_discontinuity(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time for which three points describe a thrust with a first-order lag.

    It ends when the thrust changes its sign, where thrust laws have a kink.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] for which three points of a `SignalSegment` describe the signal exactly; infinite
        if it is constant.
    """
    if q.time_constant < NONE:
        return inf
    y = memory[at]
    reverses = q.time_constant * log((x - y) / x) if x * y < 0.0 and abs(y) > SAME * abs(x) else inf
    return min(longest_lag_step(q.time_constant), reverses)


@dataclass(frozen=True)
class ThrustLag(ChannelEffect):
    """First-order lag of the thrust behind its command: time_constant y' = x - y."""

    formula: ClassVar[str] = r"\tau \, \dot y = x - y"
    symbols: ClassVar = {"time_constant": r"\tau"}
    words: ClassVar[str] = "thrust follows its command with a first-order lag"
    refines: ClassVar[str] = "lag"
    shown_by: ClassVar[str] = "fast steps of the thrust"
    acts_on: ClassVar[str] = "thrust|shaft"
    slots: ClassVar[int] = 1
    transform_signal: ClassVar = transform_signal
    time_to_discontinuity: ClassVar = time_to_discontinuity

    time_constant: float = param(
        0.15,
        low=0.0,
        high=60.0,
        unit="s",
        words="time constant: time to 63 % of a step",
        fit=True,
        spread=0.6,
    )


DriveLag = preset_effect(
    ThrustLag,
    "DriveLag",
    words="the thrust of one drive follows its command with a lag of its own",
    shown_by="fast steps of this drive alone",
    once_per="actuator",
    of_all=("thrust_lag",),
    frees={
        "time_constant": {
            "words": "time constant of this drive, beyond that of the vessel's file: time to 63 % "
            "of a step",
            "spread": 0.6,
        },
    },
)


AzimuthLag = preset_effect(
    ThrustLag,
    "AzimuthLag",
    words="the direction of one drive alone follows its command with a lag",
    shown_by="fast steps of the direction of this drive alone",
    acts_on="angle",
    once_per="actuator",
    of_all=("steering_lag",),
    ruled_out_by={"steering_measured": (True,)},
    frees={
        "time_constant": {
            "words": "time constant of the direction of this drive, beyond that of the vessel's "
            "file: time to 63 % of a step",
            "spread": 0.6,
        },
    },
)


SteeringLag = preset_effect(
    ThrustLag,
    "SteeringLag",
    words="the directions of all drives follow their commands with the same lag",
    shown_by="fast steps of the directions",
    acts_on="angle",
    once_per="actuator",
    jointly=True,
    ruled_out_by={"steering_measured": (True,)},
    frees={
        "time_constant": {
            "words": "time constant of the directions, beyond that of the vessel's file: time to "
            "63 % of a step",
            "spread": 0.6,
        },
    },
)
