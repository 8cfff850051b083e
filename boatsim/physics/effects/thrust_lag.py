"""Thrust lag: motor and propeller take time to follow the command."""

from dataclasses import dataclass
from math import exp
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """First-order lag, exact for a held command; the mean over the step keeps its impulse exact."""
    if q.time_constant < 1e-4:
        memory[at] = x
        return x
    decay = exp(-dt / q.time_constant)
    gap = memory[at] - x
    memory[at] = x + gap * decay
    return x + gap * (1.0 - decay) * q.time_constant / dt


@dataclass(frozen=True)
class ThrustLag(Channel):
    """First-order lag of the thrust behind its command."""

    words: ClassVar[str] = "thrust builds up with a lag behind its command"
    shown_by: ClassVar[str] = "quick steps of the thrust"
    acts_on: ClassVar[str] = "thrust"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel

    time_constant: float = param(
        0.15, low=0.0, high=60.0, unit="s", words="time to 63 % of a step", fit=True, spread=0.6
    )
