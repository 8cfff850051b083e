"""Jet steering: a deflected water jet pushes the stern aside, turns the hull and heels it."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Side force, roll and yaw moment in proportion to the deflection."""
    return Wrench(0.0, q.sway * m.jet_rad, q.roll * m.jet_rad, q.yaw * m.jet_rad)


@dataclass(frozen=True)
class JetSteering(Force):
    """Linear steering of a jet drive at one speed; positive `jet_rad` turns to starboard where `yaw` is positive."""

    words: ClassVar[str] = "the deflected jet steers in proportion to its angle"
    shown_by: ClassVar[str] = "a zig-zag"
    source: ClassVar[str] = "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, eq. 15"
    law: ClassVar = law

    sway: float = param(0.0, low=-1e9, high=1e9, unit="N/rad", words="Y_delta", calibrates="thrust", axis="sway")
    roll: float = param(0.0, low=-1e9, high=1e9, unit="N m/rad", words="K_delta", calibrates="thrust", axis="roll")
    yaw: float = param(0.0, low=-1e9, high=1e9, unit="N m/rad", words="N_delta", calibrates="thrust", axis="yaw")
