"""Astern time constant: yaw time constant of a jet craft that differs when it goes astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Wrench, param, wrench
from boatsim.physics.effects.reversing_jet import ahead_thrust_fraction


@njit(inline="always")
def law(m: Any, q: Any, s: Any, t: Any) -> Wrench:
    """Return the yaw moment that changes the yaw time constant T of a jet craft to factor T astern.

    The time constant is that of the yaw equation r' = (K delta - r) / T. The moment is (1 / factor
    - 1) times that of jet and yaw damping, and zero going ahead.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals of the reversing_jet on which the effect acts.
        t: Parameters of that reversing_jet.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    if m.ur >= 0.0:
        return wrench()
    return wrench(
        N=(1.0 / q.factor - 1.0) * (t.yaw * ahead_thrust_fraction(s) * s.angle - q.yaw * m.r)
    )


@dataclass(frozen=True)
class AsternTimeConstant(Force):
    """Yaw time constant astern over that ahead; the steady rate of turn does not change.

    N = (1 / factor - 1) (N_delta cos(2 beta) delta - d_r r)  for u_r < 0

    `factor` is the ratio of the time constants, `yaw` the linear yaw damping d_r [N m s] of the
    vessel.
    """

    formula: ClassVar[str] = (
        r"N = \left(\frac{1}{k} - 1\right) \left(N_\delta \cos(2 \beta) \, \delta - d_r "
        r"r\right) \quad \text{for } u_r < 0"
    )
    symbols: ClassVar = {"factor": "k", "yaw": "d_r"}
    words: ClassVar[str] = (
        "going astern the craft turns with another time constant than going ahead"
    )
    shown_by: ClassVar[str] = "nozzle steps while going astern, and the same going ahead"
    source: ClassVar[str] = (
        "L. R. S. Theisen, R. Galeazzi, M. Blanke, IFAC CAMS 2013, section 3.2: 1/T is not "
        "consistent"
    )
    per_instance_of: ClassVar[str] = "reversing_jet"
    law: ClassVar = law
    starts: ClassVar = ({"factor": 0.7}, {"factor": 1.4})

    factor: float = param(
        1.0,
        low=0.1,
        high=10.0,
        unit="",
        words="time constant astern over time constant ahead",
        fit=True,
        spread=0.4,
        inactive_value=1.0,
        in_per_cent="the time constant astern is {share} of the one ahead",
    )
    yaw: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m s",
        words="linear yaw damping of the vessel",
        follows="linear_damping.yaw",
    )
