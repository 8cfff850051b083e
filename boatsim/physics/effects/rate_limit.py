"""Rate limit: limited rate of a signal, with a first-order lag near its command."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    ChannelEffect,
    ParameterChanges,
    SignalSegment,
    longest_lag_step,
    param,
    preset_effect,
    segment_mean,
)
from boatsim.physics.effects.servo import NONE, ramp_time, servo_motion

SAME = 1e-9  # share of a ramp: a smaller distance to zero counts as zero
NEVER = 1e6  # [1/s] rate without a limit
INSTANT = 50.0  # [rad/s] upper bound of the rate of a steering; it counts as immediate
USUAL = 2.0  # [rad/s] on the reference hull, 115 deg/s; about which a fit expects it
IMMEDIATE = 1e9  # [1/s] upper bound of the rate of a drive; it counts as immediate


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return a signal that follows its command with a limited rate, then as a first-order lag.

    With a rate of `instant` or more it equals the command.

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
    if q.rate >= q.instant:
        memory[at] = x.end
        return x
    return servo_motion(segment_mean(x), memory, at, dt, q.rate, q.lag)


@njit(inline="always")
def time_to_discontinuity(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time until a rate-limited signal reaches its command or passes zero.

    Thrust laws have a kink at zero. After the ramp it is the time over which a `SignalSegment`
    follows the first-order lag.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] for which three points of a `SignalSegment` describe the signal exactly; infinite
        if it is constant.
    """
    y = memory[at]
    gap = abs(x - y)
    if gap == 0.0 or q.rate >= q.instant:
        return inf
    left = ramp_time(gap, q.rate, q.lag)
    if left <= 0.0:
        return longest_lag_step(q.lag if q.lag >= NONE else 0.0)
    return min(left, abs(y) / q.rate) if x * y < 0.0 and abs(y) > SAME * gap else left


@dataclass(frozen=True)
class RateLimit(ChannelEffect):
    """Rate limit of a throttle handle, a rudder or a thrust.

    y' = rate sign(x - y)  while |x - y| > rate lag,  then  y' = (x - y) / lag

    With a rate of `instant` or more the command is followed without delay. x is the command, y the
    signal that reaches the actuator.
    """

    formula: ClassVar[str] = (
        r"\dot y = \begin{cases} R \operatorname{sgn}(x - y) & |x - y| > R \, T \\ (x - "
        r"y) / T & \text{otherwise} \end{cases}"
    )
    symbols: ClassVar = {"rate": "R", "lag": "T"}
    words: ClassVar[str] = "a signal follows its command at a limited rate"
    refines: ClassVar[str] = "lag"
    shown_by: ClassVar[str] = "large steps of the command"
    acts_on: ClassVar[str] = ""
    slots: ClassVar[int] = 1
    transform_signal: ClassVar = transform_signal
    time_to_discontinuity: ClassVar = time_to_discontinuity

    rate: float = param(
        NEVER,
        low=1e-6,
        high=NEVER,
        unit="1/s",
        words="largest rate of change, in the unit of the channel per second",
    )
    instant: float = param(
        NEVER,
        low=1e-3,
        high=NEVER,
        unit="1/s",
        words="rate from which the command is followed without delay",
    )
    lag: float = param(
        0.0, low=0.0, high=60.0, unit="s", words="time constant of the lag near the command"
    )


# Fit of a rate of turn [rad/s]
ANGLE_RATE: ParameterChanges = {
    "low": 0.0005,
    "high": INSTANT,
    "unit": "rad/s",
    "spread": 2.0,
    "inactive_value": INSTANT,
    "usual": USUAL,
}
ANGLE_STARTS = ({"rate": 0.1}, {"rate": 0.4}, {"rate": 1.2})

SteeringRateLimit = preset_effect(
    RateLimit,
    "SteeringRateLimit",
    words="the rate of the steering machine is limited",
    shown_by="hard-over steering reversals",
    source="J. van Amerongen, Adaptive Steering of Ships, PhD, Delft 1982 (steering machine)",
    acts_on="angle",
    limits=("rate",),
    ruled_out_by={"steering_measured": (True,)},
    starts=ANGLE_STARTS,
    frees={
        "rate": {**ANGLE_RATE, "words": "largest rate of turn of the steering"},
        "lag": {"spread": 0.3},
    },
    fixed={"instant": INSTANT},
)


# Fit of a rate of thrust [largest commands of the drive per second]
THRUST_RATE: ParameterChanges = {
    "high": IMMEDIATE,
    "spread": 1.0,
    "inactive_value": IMMEDIATE,
    "usual": 1.0,
}

DriveRateLimit = preset_effect(
    RateLimit,
    "DriveRateLimit",
    words="the thrust or shaft speed of one drive changes at a limited rate",
    shown_by="large steps of this drive alone",
    acts_on="thrust|shaft",
    once_per="actuator",
    of_all=("thrust_rate_limit",),
    limits=("rate",),
    thresholds={"rate": (0.1, 0.4, 1.5)},
    frees={
        "rate": {
            **THRUST_RATE,
            "words": "largest rate of change of this drive, in the unit of its channel per second",
        },
    },
    fixed={"instant": IMMEDIATE},
)

ThrustRateLimit = preset_effect(
    RateLimit,
    "ThrustRateLimit",
    words="the thrusts or shaft speeds of all drives change at the same limited rate",
    shown_by="large steps of the thrusts",
    acts_on="thrust|shaft",
    once_per="actuator",
    jointly=True,
    limits=("rate",),
    thresholds={"rate": (0.1, 0.4, 1.5)},
    frees={
        "rate": {
            **THRUST_RATE,
            "words": "largest rate of change, in the unit of the channels per second",
        },
    },
    fixed={"instant": IMMEDIATE},
)


AzimuthRateLimit = preset_effect(
    RateLimit,
    "AzimuthRateLimit",
    words="the direction of one drive turns at a limited rate",
    shown_by="large steps of the direction of this drive alone",
    acts_on="angle",
    once_per="actuator",
    of_all=("steering_rate_limit",),
    limits=("rate",),
    ruled_out_by={"steering_measured": (True,)},
    starts=ANGLE_STARTS,
    frees={
        "rate": {**ANGLE_RATE, "words": "largest rate of turn of this drive"},
    },
    fixed={"instant": INSTANT},
)
