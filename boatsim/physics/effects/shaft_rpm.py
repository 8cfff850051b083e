"""Shaft rpm: recordings that give the propeller's rate in revolutions a minute."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param

MINUTE = 60.0  # [s]


@njit(inline="always")
def channel(x: float, side: float, rpm: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Revolutions a second from those a minute; a command in 1/s adds to it."""
    return x + q.gear * rpm / MINUTE


@dataclass(frozen=True)
class ShaftRpm(Channel):
    """The propeller turns at a command `n_rpm`."""

    words: ClassVar[str] = "the propeller's rate is given per minute"
    shown_by: ClassVar[str] = "any manoeuvre"
    acts_on: ClassVar[str] = "shaft"
    source_family: ClassVar[str] = "rpm"
    channel: ClassVar = channel

    gear: float = param(1.0, low=-10.0, high=10.0, unit="", words="propeller per commanded revolution")
