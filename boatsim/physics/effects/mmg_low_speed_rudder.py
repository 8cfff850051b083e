"""MMG rudder at low speed: a blade in the race of a propeller that may back, on a ship that may go astern."""

from dataclasses import dataclass
from math import atan2, cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_low_speed_propeller import inflow, push
from boatsim.physics.effects.mmg_propeller import open_water

NEVER = pi  # [rad] any angle of attack


@njit(inline="always")
def race(m: Any, q: Any, shaft: float) -> float:
    """Speed of the water along the blade [m/s], negative from astern.

    A propeller that pushes ahead washes the part of the span behind it; one that backs or brakes draws water away from
    it; on a ship that goes astern with no push ahead the blade leads, in undisturbed water.
    """
    V, washed, pulls = inflow(m, q), q.diameter / q.span, open_water(shaft, inflow(m, q), q)
    if shaft >= 0.0 and pulls > 0.0:
        behind = V + q.k_x / q.epsilon * (sqrt(V * V + 8.0 / pi * pulls) - V)
        return float(q.epsilon * sqrt(max(washed * behind * behind + (1.0 - washed) * V * V, 0.0)))
    if m.ur < 0.0:
        return float(m.ur)
    drawn = q.k_x_astern * sqrt(8.0 / pi * abs(push(m, q, shaft)))
    a = q.epsilon * V + (drawn if shaft >= 0.0 else -drawn)
    square = (
        washed * a * abs(a)
        + (1.0 - washed) * (q.epsilon * V) * (q.epsilon * V)
        + q.c_pr * m.ur * m.ur
    )
    return float(sqrt(square) if square > 0.0 else -sqrt(-square))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Force normal to the blade; hull and propeller straighten the flow that meets it, by the side it comes from."""
    from_starboard = m.vr + q.rudder_at * q.length * m.r >= 0.0
    straightening = q.straightening_starboard if from_starboard else q.straightening_port
    along, across = race(m, q, s.shaft), -straightening * (m.vr + q.flow_at * q.length * m.r)
    attack = s.angle - atan2(across, along)
    attack = min(max(atan2(sin(attack), cos(attack)), -q.stall), q.stall)  # within half a turn
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


def propellers(name: str) -> float:
    """A number of the propeller in whose race the blade stands."""
    return param(
        UNSET,
        low=-10.0,
        high=20.0,
        unit="",
        words=f"the propeller's {name}",
        follows=f"mmg_low_speed_propeller.{name}",
    )


@dataclass(frozen=True)
class MmgLowSpeedRudder(Force):
    """One rudder behind the propeller; a positive angle turns a ship that goes ahead to starboard."""

    words: ClassVar[str] = (
        "a rudder steers in the race of a propeller that may back (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "turning from rest, and backing"
    source: ClassVar[str] = (
        "Y. Miyauchi, A. Maki, N. Umeda, D. M. Rachman, Y. Akimoto, J. Mar. Sci. Technol. 27, 2022"
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
        UNSET,
        low=0.0,
        high=1100.0,
        unit="kg/m^3",
        words="of the water",
        follows="mmg_low_speed_hull.density",
    )
    diameter: float = param(
        UNSET, low=0.0, high=20.0, unit="m", words="D_P", follows="mmg_low_speed_propeller.diameter"
    )
    thrust_deduction: float = propellers("thrust_deduction")
    wake: float = propellers("wake")
    wake_tau: float = propellers("wake_tau")
    wake_C_P: float = propellers("wake_C_P")
    propeller_at: float = propellers("propeller_at")
    k0: float = propellers("k0")
    k1: float = propellers("k1")
    k2: float = propellers("k2")
    astern_C1: float = propellers("astern_C1")
    astern_C2: float = propellers("astern_C2")
    astern_from: float = propellers("astern_from")
    astern_stop: float = propellers("astern_stop")
    gain: float = param(
        1.0, low=0.1, high=5.0, unit="", words="force per stated one", calibrates="thrust"
    )
    area: float = param(0.0, low=0.0, high=500.0, unit="m^2", words="A_R")
    span: float = param(1.0, low=0.001, high=50.0, unit="m", words="H_R")
    slope: float = param(
        0.0, low=0.0, high=10.0, unit="", words="f_alpha, of the normal force coefficient"
    )
    steering_deduction: float = param(0.0, low=0.0, high=1.0, unit="", words="t_R")
    hull_share: float = param(
        0.0, low=0.0, high=2.0, unit="", words="a_H, sway force on the hull per rudder force"
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
        1.0, low=0.0, high=2.0, unit="", words="gamma_R, the stern sliding to port"
    )
    straightening_starboard: float = param(
        1.0, low=0.0, high=2.0, unit="", words="gamma_R, sliding to starboard"
    )
    epsilon: float = param(
        1.0, low=0.0, high=3.0, unit="", words="wake at the rudder over wake at the propeller"
    )
    k_x: float = param(0.5, low=0.0, high=2.0, unit="", words="kappa epsilon, of a race ahead")
    k_x_astern: float = param(
        0.0, low=0.0, high=2.0, unit="", words="the same of a propeller that backs or brakes"
    )
    c_pr: float = param(
        0.0, low=-2.0, high=2.0, unit="", words="C_PR, what backing takes from the flow, of u^2"
    )
    stall: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle of attack at which F_N stops growing"
    )
