"""Gust: a force that swells and fades in a fixed direction."""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Mean + amplitude sin(frequency t + phase) towards a bearing of the world, or of the hull."""
    force = q.mean + q.amplitude * sin(q.frequency * m.t + q.phase)
    ahead, abeam = force * cos(q.toward), force * sin(q.toward)
    if q.turns_with_hull == 0.0:
        ahead, abeam = m.cos_psi * ahead + m.sin_psi * abeam, m.cos_psi * abeam - m.sin_psi * ahead
    return Wrench(ahead, abeam, 0.0, q.arm * abeam)


@dataclass(frozen=True)
class Gust(Force):
    """A known disturbance: steady part and one sine, felt alike from every side."""

    words: ClassVar[str] = "a force that comes and goes as a sine pushes in one direction"
    shown_by: ClassVar[str] = "lying still without thrust"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7"
    law: ClassVar = law

    mean: float = param(0.0, low=-1e7, high=1e7, unit="N", words="steady part")
    amplitude: float = param(0.0, low=0.0, high=1e7, unit="N", words="of the sine")
    frequency: float = param(0.4 * pi, low=0.0, high=100.0, unit="rad/s", words="of the sine")
    phase: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="of the sine at t = 0")
    toward: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="where it pushes to")
    arm: float = param(0.0, low=-200.0, high=200.0, unit="m", words="side force acts this far forward")
    turns_with_hull: float = param(0.0, low=0.0, high=1.0, unit="", words="1: the direction is one of the hull")
