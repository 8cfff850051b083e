"""Gust off centre: the disturbance that the model knows acts ahead of or behind the place it is put at."""

from dataclasses import dataclass
from math import pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param
from boatsim.physics.effects import gust


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Moment of the gust's side force on the lever that is missing."""
    return Wrench(0.0, 0.0, 0.0, gust.law(m, q).N)


@dataclass(frozen=True)
class GustOffCentre(Force):
    """A yaw moment in proportion to the side force of the vessel's own gust."""

    words: ClassVar[str] = "the known disturbance also turns the boat: it acts away from the mass centre"
    shown_by: ClassVar[str] = "the same manoeuvre with the disturbance from another side"
    source: ClassVar[str] = "Y. Huang and Z. Ji, Autonomous boat dynamics, eq. 7, with a lever"
    law: ClassVar = law

    arm: float = param(0.0, low=-200.0, high=200.0, unit="m", words="lever that is missing", fit=True, spread=0.1)
    mean: float = param(0.0, low=-1e7, high=1e7, unit="N", words="the gust's", follows="gust.mean")
    amplitude: float = param(0.0, low=0.0, high=1e7, unit="N", words="the gust's", follows="gust.amplitude")
    frequency: float = param(1.0, low=0.0, high=100.0, unit="rad/s", words="the gust's", follows="gust.frequency")
    phase: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="the gust's", follows="gust.phase")
    toward: float = param(0.0, low=-2 * pi, high=2 * pi, unit="rad", words="the gust's", follows="gust.toward")
    turns_with_hull: float = param(0.0, low=0.0, high=1.0, unit="", words="the gust's", follows="gust.turns_with_hull")
