"""Planing lag: a planing craft changes its speed more slowly at low speed."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Reaction, Wrench, param, wrench


@njit(inline="always")
def reaction(m: Any, w: Wrench, q: Any) -> Wrench:
    """Return the surge force that slows the speed changes of a planing craft at low speed.

    It is (kappa - 1) times the surge force of all other effects, m v r included.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        w: Sum of the forces of the effects before this one [N, N m].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Additional force [N] and moment [N m] in body axes.
    """
    if q.full_speed <= 0.0:
        return wrench()
    kappa = min(max(m.ur / q.full_speed, q.least), 1.0)
    return wrench(X=(kappa - 1.0) * (w.X + q.hull_mass * m.vr * m.r))


@dataclass(frozen=True)
class PlaningLag(Reaction):
    """Reduction of the surge acceleration at low speed, where the wetted area is large.

    X = (kappa - 1) (X_others + m v r),  kappa = u / full_speed limited to [least, 1]

    Steady speeds do not change, because the sum of the other forces is zero there.
    """

    formula: ClassVar[str] = (
        r"X = (\kappa - 1) \left(X_\mathrm{others} + m \, v_r r\right), \quad \kappa = "
        r"\min\left(\max\left(\frac{u_r}{u_1}, \kappa_0\right), 1\right)"
    )
    symbols: ClassVar = {"full_speed": "u_1", "least": r"\kappa_0", "hull_mass": "m"}
    needs: ClassVar = ("surge",)
    ruled_out_by: ClassVar = {"no_water": (True,)}
    words: ClassVar[str] = (
        "the craft changes its speed more slowly below planing speed; steady speeds do not change"
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
        words="speed from which kappa is 1",
        fit=True,
        spread=8.0,
    )
    least: float = param(
        0.2,
        low=0.02,
        high=1.0,
        unit="",
        words="smallest kappa",
        fit=True,
        spread=0.3,
        inactive_value=0.2,
    )
    hull_mass: float = param(
        UNSET,
        low=0.0,
        high=1e9,
        unit="kg",
        words="mass of the hull; default: that of the vessel",
        follows="vessel.body.mass",
    )
