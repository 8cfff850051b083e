"""Servo: steering machine with a range, a rate limit and a first-order lag."""

from dataclasses import dataclass
from math import exp, pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    ChannelEffect,
    SignalSegment,
    longest_lag_step,
    param,
    segment_mean,
    segment_with_mean,
)

NONE = 1e-4  # [s] a shorter lag counts as none


@njit(inline="always")
def ramp_time(gap: float, rate: float, lag: float) -> float:
    """Return how long [s] a rate-limited servo moves at its largest rate towards its command.

    After that time its first-order lag alone would not be faster.

    Args:
        gap: Difference between command and present angle.
        rate: Largest rate [1/s].
        lag: Time constant of the lag [s].
    """
    slow = rate * lag if lag >= NONE else 0.0
    return max(abs(gap) - slow, 0.0) / rate


@njit(inline="always")
def servo_motion(
    goal: float, memory: Array, at: int, dt: float, rate: float, lag: float
) -> SignalSegment:
    """Return how a servo moves towards a constant command over one step.

    It moves at the largest rate, then as a first-order lag.

    Args:
        goal: Command, held over the step.
        memory: Memory of the program; the present value is `memory[at]`, which is advanced.
        at: Index in `memory`.
        dt: Length of the step [s].
        rate: Largest rate [1/s].
        lag: Time constant [s].

    Returns:
        Values at begin, middle and end with the exact mean over the step.
    """
    y = memory[at]
    gap = goal - y
    needed = ramp_time(gap, rate, lag)
    turning = min(needed, dt)
    turned = rate * turning if gap > 0.0 else -rate * turning
    rest, left = gap - turned, dt - turning
    area = 0.5 * turned * turning + turned * left  # [rad s] integral of the angle relative to y
    if lag >= NONE:
        decay = exp(-left / lag)
        area += rest * (left - lag * (1.0 - decay))
        rest *= decay
    elif needed <= dt:
        # exactly zero, so that rounding does not leave a ramp that needs another step
        rest = 0.0
    memory[at] = goal - rest
    return segment_with_mean(y, y + area / dt, memory[at])


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the steering angle of a servo that follows its command within its range.

    The servo has a rate limit and a first-order lag.

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
    return servo_motion(min(max(segment_mean(x), -q.range), q.range), memory, at, dt, q.rate, q.lag)


@njit(inline="always")
def time_to_discontinuity(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time until a servo's motion at the largest rate ends.

    After that it is the time for which three points describe the first-order lag.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] for which three points of a `SignalSegment` describe the signal exactly; infinite
        if it is constant.
    """
    left = ramp_time(min(max(x, -q.range), q.range) - memory[at], q.rate, q.lag)
    return left if left > 0.0 else longest_lag_step(q.lag if q.lag >= NONE else 0.0)


@dataclass(frozen=True)
class Servo(ChannelEffect):
    """Steering angle that follows its command with a range, a rate limit and a first-order lag.

    y' = rate sign(x - y)  while |x - y| > rate lag,  then  y' = (x - y) / lag,  |x| <= range
    """

    formula: ClassVar[str] = (
        r"\dot y = \begin{cases} R \operatorname{sgn}(x - y) & |x - y| > R \, T \\ (x - "
        r"y) / T & \text{otherwise} \end{cases}, \quad |x| \le x_\mathrm{max}"
    )
    symbols: ClassVar = {"range": r"x_\mathrm{max}", "rate": "R", "lag": "T"}
    words: ClassVar[str] = "the steering follows its command with limited rate and range"
    shown_by: ClassVar[str] = "fast steering reversals"
    source: ClassVar[str] = (
        "J. van Amerongen, Adaptive Steering of Ships, PhD, Delft 1982 (steering machine); "
        "values: checked "
        "specification of Bayless 2017, section 4: 0.06 s, 400 deg/s [A], 0 to 45 deg (T9)"
    )
    acts_on: ClassVar[str] = "angle"
    slots: ClassVar[int] = 1
    transform_signal: ClassVar = transform_signal
    time_to_discontinuity: ClassVar = time_to_discontinuity

    range: float = param(pi / 4, low=0.0, high=pi, unit="rad", words="largest angle to either side")
    rate: float = param(
        400.0 * pi / 180.0, low=0.001, high=1e3, unit="rad/s", words="largest rate of turn"
    )
    lag: float = param(0.06, low=0.0, high=60.0, unit="s", words="time constant")
