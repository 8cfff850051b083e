"""Planing lag: a planing craft gains and loses speed slowly until it planes."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Reaction, Wrench, param, wrench


@njit(inline="always")
def reaction(m: Any, w: Wrench, q: Any) -> Wrench:
    """(kappa - 1) times the surge force there is, m v r included; kappa = u / full_speed within [least, 1]."""
    if q.full_speed <= 0.0:
        return wrench()
    kappa = min(max(m.ur / q.full_speed, q.least), 1.0)
    return wrench(X=(kappa - 1.0) * (w.X + q.hull_mass * m.vr * m.r))


@dataclass(frozen=True)
class PlaningLag(Reaction):
    """Every change of speed is scaled down at low speed, where the wetted area is large; steady speeds stay."""

    needs: ClassVar = ("surge",)
    words: ClassVar[str] = (
        "the craft changes its speed more slowly the less it planes; steady speeds are right"
    )
    shown_by: ClassVar[str] = "throttle steps at low and at high speed"
    source: ClassVar[str] = (
        "C. Svendsen et al., L1 adaptive manoeuvring control, IFAC MCMC 2012, section III-A"
    )
    reaction: ClassVar = reaction
    strength: ClassVar = ("full_speed",)
    starts: ClassVar = ({"full_speed": 2.0, "least": 0.3}, {"full_speed": 8.0, "least": 0.3})

    full_speed: float = param(
        0.0,
        low=0.0,
        high=100.0,
        unit="m/s",
        words="speed from which nothing lags",
        fit=True,
        spread=8.0,
    )
    least: float = param(
        0.2, low=0.02, high=1.0, unit="", words="smallest factor", fit=True, spread=0.3, absent=0.2
    )
    hull_mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="the hull's; if not given, the vessel's own",
        follows="vessel.body.mass",
    )
