"""Push: a steady force and moment on the hull for a while, to see what a controller does about it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Body-fixed, between two instants."""
    there = 1.0 if q.begin <= m.t < q.end else 0.0
    return Wrench(there * q.surge, there * q.sway, 0.0, there * q.yaw)


@dataclass(frozen=True)
class Push(Force):
    """A disturbance of stated size and duration."""

    words: ClassVar[str] = "something pushes the hull for a while"
    shown_by: ClassVar[str] = "holding course and speed"
    law: ClassVar = law

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="ahead")
    sway: float = param(0.0, low=-1e9, high=1e9, unit="N", words="to starboard")
    yaw: float = param(0.0, low=-1e13, high=1e13, unit="N m", words="clockwise")
    begin: float = param(0.0, low=-1e6, high=1e6, unit="s", words="it begins")
    end: float = param(1e6, low=-1e6, high=1e6, unit="s", words="it ends")
