"""Propeller: a thrust with the square of the shaft's rate, at a place on the hull."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Role, Wrench, param
from boatsim.physics.effects.thruster import Thruster, at_mount

TOLD = Thruster.signals_type()


@njit(inline="always")
def thrust(n: float, q: Any) -> float:
    """K n |n|, with another k astern."""
    return float((q.ahead if n > 0.0 else q.astern) * n * abs(n))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """T (cos a, sin a) at (x, y, z)."""
    return at_mount(q.gain * thrust(s.shaft, q), s, q)


@njit(inline="always")
def as_thruster(s: Any, q: Any) -> Any:
    """What a thruster is told that pushes as much."""
    return TOLD(thrust(s.shaft, q), s.angle, s.cos_angle, s.sin_angle)


@dataclass(frozen=True)
class Propeller(Force):
    """A propeller in open water; without a steering channel its angle is a number, 0 straight ahead."""

    words: ClassVar[str] = "a propeller pushes with the square of its rate"
    shown_by: ClassVar[str] = "a staircase of rates"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: K_T at J = 0"
    )
    roles: ClassVar = {
        "shaft": Role("rad/s", "its rate, ahead positive"),
        "angle": Role("rad", "where it pushes, 0 ahead, positive to starboard", fixed=0.0),
    }
    law: ClassVar = law
    as_thruster: ClassVar = as_thruster

    ahead: float = param(1.0, low=0.0, high=1e9, unit="N s^2/rad^2", words="k ahead")
    astern: float = param(1.0, low=0.0, high=1e9, unit="N s^2/rad^2", words="k astern")
    x: float = param(
        0.0, low=-500.0, high=500.0, unit="m", words="mount ahead of the origin of motion"
    )
    y: float = param(0.0, low=-100.0, high=100.0, unit="m", words="to starboard of it")
    z: float = param(0.0, low=-100.0, high=100.0, unit="m", words="below it")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="thrust per stated thrust", calibrates="thrust"
    )
