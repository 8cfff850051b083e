"""Lateral centre shift: sideways damping does not act at the mass centre."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """The vessel's -Y_v acting on the cross flow at the shifted place, less the same at the origin."""
    extra = -q.sway * q.shift * m.r
    return Wrench(0.0, extra, 0.0, q.shift * (extra - q.sway * m.vr))


@dataclass(frozen=True)
class LateralCentreShift(Force):
    """Centre of the linear sway damping ahead of or behind the origin of motion (skeg, trim, load)."""

    words: ClassVar[str] = "the water's sideways resistance acts ahead of or behind the mass centre"
    shown_by: ClassVar[str] = "pushing sideways, and coasting after a turn"
    source: ClassVar[str] = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 6.4 (Y_r, N_v)"
    law: ClassVar = law

    shift: float = param(0.0, low=-200.0, high=200.0, unit="m", words="positive forward", fit=True, spread=0.1)
    sway: float = param(0.0, low=0.0, high=1e9, unit="N s/m", words="the vessel's", follows="linear_damping.sway")
