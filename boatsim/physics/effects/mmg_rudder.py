"""MMG rudder: a blade in the propeller's race, and what it makes the hull ahead of it do."""

from dataclasses import dataclass
from math import atan2, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_propeller import drift_angle, inflow, open_water

NEVER = pi  # [rad] any angle of attack


@njit(inline="always")
def race(m: Any, q: Any, shaft: float) -> float:
    """Speed of the water along the blade [m/s]: the part of its span behind the propeller is in the race."""
    V, washed = inflow(m, q), q.diameter / q.span
    faster = sqrt(max(V * V + 8.0 / pi * open_water(shaft, V, q), 0.0)) - V
    behind = V + q.kappa * faster
    return float(q.epsilon * sqrt(max(washed * behind * behind + (1.0 - washed) * V * V, 0.0)))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Force normal to the blade; hull and propeller straighten the flow that meets it."""
    across = (
        sqrt(m.ur * m.ur + m.vr * m.vr) * drift_angle(m) - q.flow_at * m.r * q.length
    )  # U beta_R
    along, across = (
        race(m, q, s.shaft),
        across * (q.straightening_port if across > 0.0 else q.straightening_starboard),
    )
    attack = min(max(s.angle - atan2(across, along), -q.stall), q.stall)
    F = (
        0.5
        * q.gain
        * q.density
        * q.area
        * q.slope
        * (along * along + across * across)
        * sin(attack)
    )
    lever = (q.rudder_at + q.hull_share * q.hull_at) * q.length  # [m]
    return wrench(
        X=-(1.0 - q.steering_deduction) * F * s.sin_angle,
        Y=-(1.0 + q.hull_share) * F * s.cos_angle,
        N=-lever * F * s.cos_angle,
    )


@dataclass(frozen=True)
class MmgRudder(Force):
    """One rudder behind the propeller; a positive angle turns the ship to starboard."""

    words: ClassVar[str] = "a rudder steers in the propeller's race (MMG)"
    shown_by: ClassVar[str] = "turning circles and zig-zags"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015 (MMG standard method)"
    )
    roles: ClassVar = {
        "angle": Role("rad", "the rudder, positive turns to starboard"),
        "shaft": Role("1/s", "the propeller's rate, ahead positive"),
    }
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="of the ship", follows="vessel.length"
    )
    density: float = param(
        UNSET, low=0.0, high=1100.0, unit="kg/m^3", words="of the water", follows="mmg_hull.density"
    )
    diameter: float = param(
        UNSET, low=0.0, high=20.0, unit="m", words="D_P", follows="mmg_propeller.diameter"
    )
    wake: float = param(
        UNSET, low=0.0, high=1.0, unit="", words="w_P0", follows="mmg_propeller.wake"
    )
    wake_C1: float = param(
        UNSET, low=0.0, high=20.0, unit="", words="C_1", follows="mmg_propeller.wake_C1"
    )
    wake_C2_port: float = param(
        UNSET,
        low=0.0,
        high=3.0,
        unit="",
        words="C_2, beta_P > 0",
        follows="mmg_propeller.wake_C2_port",
    )
    wake_C2_starboard: float = param(
        UNSET,
        low=0.0,
        high=3.0,
        unit="",
        words="C_2, beta_P < 0",
        follows="mmg_propeller.wake_C2_starboard",
    )
    propeller_at: float = param(
        UNSET, low=-1.0, high=1.0, unit="", words="x_P'", follows="mmg_propeller.propeller_at"
    )
    k0: float = param(
        UNSET, low=-2.0, high=2.0, unit="", words="K_T at J = 0", follows="mmg_propeller.k0"
    )
    k1: float = param(
        UNSET, low=-2.0, high=2.0, unit="", words="of J in K_T", follows="mmg_propeller.k1"
    )
    k2: float = param(
        UNSET, low=-2.0, high=2.0, unit="", words="of J^2 in K_T", follows="mmg_propeller.k2"
    )
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="force per stated one", calibrates="thrust"
    )
    area: float = param(0.0, low=0.0, high=500.0, unit="m^2", words="A_R, without the horn")
    span: float = param(1.0, low=0.001, high=50.0, unit="m", words="H_R")
    slope: float = param(
        0.0, low=0.0, high=10.0, unit="", words="f_alpha, of the normal force coefficient"
    )
    steering_deduction: float = param(0.0, low=0.0, high=1.0, unit="", words="t_R")
    hull_share: float = param(
        0.0,
        low=0.0,
        high=2.0,
        unit="",
        words="a_H, sway force on the hull per rudder force",
        calibrates="thrust",
    )
    hull_at: float = param(
        0.0, low=-1.0, high=1.0, unit="", words="x_H', where it acts, lengths ahead of midship"
    )
    rudder_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_R', lengths ahead of midship"
    )
    flow_at: float = param(
        -1.0, low=-2.0, high=2.0, unit="", words="l_R', effective place in the flow"
    )
    straightening_port: float = param(
        1.0,
        low=0.0,
        high=2.0,
        unit="",
        words="gamma_R for water from port, beta_R > 0",
        calibrates="thrust",
    )
    straightening_starboard: float = param(
        1.0,
        low=0.0,
        high=2.0,
        unit="",
        words="gamma_R for water from starboard",
        calibrates="thrust",
    )
    epsilon: float = param(
        1.0, low=0.0, high=3.0, unit="", words="wake at the rudder over wake at the propeller"
    )
    kappa: float = param(
        0.5, low=0.0, high=2.0, unit="", words="share of the race's speed that reaches the rudder"
    )
    stall: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle of attack at which F_N stops growing"
    )
