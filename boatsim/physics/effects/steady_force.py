"""Steady force: a constant force or moment that turns with the hull."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The same whatever the hull does."""
    return Wrench(q.surge, q.sway, q.roll, q.yaw)


@dataclass(frozen=True)
class SteadyForce(Force):
    """A disturbance for tests of controllers; in a diagnosis a bias that nothing the hull does changes."""

    words: ClassVar[str] = "a constant force or moment acts on the hull, always in the same direction of the hull"
    shown_by: ClassVar[str] = "the same turn to port and to starboard"
    law: ClassVar = law
    strength: ClassVar = ("surge", "sway", "yaw", "roll")

    surge: float = param(0.0, low=-1e9, high=1e9, unit="N", words="positive ahead", fit=True, spread=0.1, axis="surge")
    sway: float = param(
        0.0, low=-1e9, high=1e9, unit="N", words="positive to starboard", fit=True, spread=0.1, axis="sway"
    )
    yaw: float = param(
        0.0, low=-1e12, high=1e12, unit="N m", words="positive to starboard", fit=True, spread=0.04, axis="yaw"
    )
    roll: float = param(
        0.0, low=-1e12, high=1e12, unit="N m", words="positive to starboard", fit=True, spread=0.02, axis="roll"
    )
