"""Reversal pause: standstill of a drive between thrust in one direction and in the other."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    ChannelEffect,
    SignalSegment,
    param,
    preset_effect,
    segment_mean,
)
from boatsim.physics.kinds.channel import COMMANDS

SAME = 1e-9  # [s] times closer than this are the same instant


@njit(inline="always")
def standstill_left(x: float, memory: Array, at: int, pause: float) -> float:
    """Return how long [s] a drive still stands under a command that is held from now on.

    Args:
        x: Command; under zero the drive stands without a pause.
        memory: Memory of the program; `memory[at]` is the time since the last command ahead and
            `memory[at + 1]` the time since the last one astern [s].
        at: Index in `memory`.
        pause: Pause between both directions [s].
    """
    if x == 0.0:
        return 0.0
    left = pause - (memory[at + 1] if x > 0.0 else memory[at])
    return left if left > SAME else 0.0


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the command of a drive that stands still for a pause after each change of its sign.

    Of a step in which the pause ends, the command counts for the remaining share of the step, so
    that the impulse of the thrust is a continuous function of the pause.

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
    order = segment_mean(x)
    left = standstill_left(order, memory, at, q.pause)
    memory[at] = 0.0 if order > 0.0 else memory[at] + dt
    memory[at + 1] = 0.0 if order < 0.0 else memory[at + 1] + dt
    if left == 0.0:
        return x
    mean = order * max(dt - left, 0.0) / dt
    return SignalSegment(mean, mean, mean)


@njit(inline="always")
def present_output(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the command that the drive follows at present: zero during the pause.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The present signal of the actuator after the effect.
    """
    return 0.0 if standstill_left(x, memory, at, q.pause) > 0.0 else x


@njit(inline="always")
def time_to_discontinuity(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time until the pause of a drive ends.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] for which three points of a `SignalSegment` describe the signal exactly; infinite
        if it is constant.
    """
    left = standstill_left(x, memory, at, q.pause)
    return left if left > 0.0 else inf


@dataclass(frozen=True)
class ReversalPause(ChannelEffect):
    """Drive that stands still for a pause T before it pushes in the other direction.

    y(t) = 0 if x had the opposite sign at any time in (t - T, t), else x(t)

    Motor controllers and reversing gears do this. The time under a zero command counts as part of
    the pause. Each change of sign starts a pause of its own, so that the thrust is a continuous
    function of T in the mean over any time.
    """

    formula: ClassVar[str] = (
        r"y(t) = \begin{cases} 0 & x(s) \, x(t) < 0 \text{ for an } s \in (t - T, t) \\ x(t) & "
        r"\text{otherwise} \end{cases}"
    )
    symbols: ClassVar = {"pause": "T"}
    words: ClassVar[str] = "the drives stand still for a time before they push the other way"
    shown_by: ClassVar[str] = "thrust that changes from ahead to astern and back without a stop"
    source: ClassVar[str] = (
        "the neutral time of motor controllers and reversing gears; a simple empirical form"
    )
    acts_on: ClassVar[str] = "thrust|shaft"
    slots: ClassVar[int] = 2
    stage: ClassVar[int] = COMMANDS
    acts_astern: ClassVar[bool] = True
    has_derivative: ClassVar[bool] = False
    transform_signal: ClassVar = transform_signal
    present_output: ClassVar = present_output
    time_to_discontinuity: ClassVar = time_to_discontinuity
    starts: ClassVar = ({"pause": 0.2},)

    pause: float = param(
        0.0,
        low=0.0,
        high=60.0,
        unit="s",
        words="time for which the drive stands still",
        fit=True,
        spread=0.5,
    )


DriveReversalPause = preset_effect(
    ReversalPause,
    "DriveReversalPause",
    words="one drive stands still for a time before it pushes the other way",
    shown_by="thrust of this drive that changes from ahead to astern and back without a stop",
    once_per="actuator",
    of_all=("reversal_pause",),
    frees={
        "pause": {
            "words": "time for which this drive stands still, beyond that of the vessel's file",
            "spread": 0.5,
        },
    },
)
