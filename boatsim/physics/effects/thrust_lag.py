"""Thrust lag: first-order lag of motor and propeller."""

from dataclasses import dataclass
from math import inf, log
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, followed, lagged, param

NONE = 1e-4  # [s] a shorter lag counts as none
SAME = 1e-9  # share of a command: a smaller thrust of the other sign counts as zero


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Return the lagged signal, exact for a command that is a parabola over the step.

    Args:
        x: Signal that enters: its values at the begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Raw command that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal that leaves the effect, over the same step.
    """
    if q.time_constant < NONE:
        memory[at] = x.end
        return x
    return lagged(x, q.time_constant, memory, at, dt)


@njit(inline="always")
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time over which a `Course` follows the lag, at most until the thrust reverses.

    Thrust laws have a kink at zero thrust.

    Args:
        x: Signal that enters now, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] during which the three points of a `Course` describe the signal exactly; infinite
        if it is constant.
    """
    if q.time_constant < NONE:
        return inf
    y = memory[at]
    reverses = q.time_constant * log((x - y) / x) if x * y < 0.0 and abs(y) > SAME * abs(x) else inf
    return min(followed(q.time_constant), reverses)


@dataclass(frozen=True)
class ThrustLag(Channel):
    """First-order lag of the thrust behind its command: time_constant y' = x - y."""

    words: ClassVar[str] = "thrust follows its command with a first-order lag"
    refines: ClassVar[str] = "lag"
    shown_by: ClassVar[str] = "fast steps of the thrust"
    acts_on: ClassVar[str] = "thrust|shaft"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel
    pause: ClassVar = pause

    time_constant: float = param(
        0.15,
        low=0.0,
        high=60.0,
        unit="s",
        words="time constant: time to 63 % of a step",
        fit=True,
        spread=0.6,
    )
