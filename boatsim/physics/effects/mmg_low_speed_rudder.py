"""MMG rudder at low speed: rudder force behind a propeller that may back, ship ahead or astern."""

from dataclasses import dataclass
from math import atan2, cos, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_low_speed_propeller import inflow_speed, propeller_thrust
from boatsim.physics.effects.mmg_propeller import open_water_thrust

NEVER = pi  # [rad] default: no stall at any angle of attack


@njit(inline="always")
def slipstream_speed(m: Any, q: Any, shaft: float) -> float:
    """Return the speed of the water along a rudder behind a propeller [m/s], negative from astern.

    A propeller with thrust ahead accelerates the flow over the part of the span behind it. One that
    backs or brakes draws water away from the rudder. On a ship that goes astern without thrust
    ahead the rudder meets undisturbed water.

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
        shaft: Shaft rate, positive ahead [1/s].
    """
    V, washed, pulls = (
        inflow_speed(m, q),
        q.diameter / q.span,
        open_water_thrust(shaft, inflow_speed(m, q), q),
    )
    if shaft >= 0.0 and pulls > 0.0:
        behind = V + q.k_x / q.epsilon * (sqrt(V * V + 8.0 / pi * pulls) - V)
        return float(q.epsilon * sqrt(max(washed * behind * behind + (1.0 - washed) * V * V, 0.0)))
    if m.ur < 0.0:
        return float(m.ur)
    drawn = q.k_x_astern * sqrt(8.0 / pi * abs(propeller_thrust(m, q, shaft)))
    a = q.epsilon * V + (drawn if shaft >= 0.0 else -drawn)
    square = (
        washed * a * abs(a)
        + (1.0 - washed) * (q.epsilon * V) * (q.epsilon * V)
        + q.c_pr * m.ur * m.ur
    )
    return float(sqrt(square) if square > 0.0 else -sqrt(-square))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the force of a rudder behind a propeller at low speed, with the hull force it induces.

    The force acts normal to the rudder. Hull and propeller straighten the flow that meets the
    rudder, by a factor for each side.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    from_starboard = m.vr + q.rudder_at * q.length * m.r >= 0.0
    straightening = q.straightening_starboard if from_starboard else q.straightening_port
    along, across = (
        slipstream_speed(m, q, s.shaft),
        -straightening * (m.vr + q.flow_at * q.length * m.r),
    )
    attack = s.angle - atan2(across, along)
    attack = min(max(atan2(sin(attack), cos(attack)), -q.stall), q.stall)  # wrapped to half a turn
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


def propeller_parameter(name: str) -> float:
    """Declare a rudder parameter whose default is the propeller's parameter of the same name."""
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
    """One rudder behind the propeller; a positive angle turns a ship that goes ahead to starboard.

    F_N = 0.5 rho A_R f_alpha (u_R^2 + v_R^2) sin(alpha_R),  alpha_R = delta - atan2(v_R, u_R)
    X = -(1 - t_R) F_N sin(delta),  Y = -(1 + a_H) F_N cos(delta)
    N = -(x_R + a_H x_H) F_N cos(delta)

    u_R is the flow along the rudder (see the source for its cases), v_R = -gamma_R (v + l_R r).
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= -(1 - t_R) F_N \sin\delta, \quad Y = -(1 + a_H) F_N "
        r"\cos\delta \\ N &= -(x_R + a_H x_H) F_N \cos\delta \\ F_N &= \tfrac{1}{2} \rho "
        r"A_R f_\alpha \left(u_R^2 + v_R^2\right) \sin\alpha_R, \quad \alpha_R = \delta - "
        r"\operatorname{atan2}(v_R, u_R) \\ v_R &= -\gamma_R (v_r + l_R r) \end{aligned}"
    )
    symbols: ClassVar = {
        "density": r"\rho",
        "area": "A_R",
        "slope": r"f_\alpha",
        "steering_deduction": "t_R",
        "hull_share": "a_H",
        "hull_at": "x_H",
        "rudder_at": "x_R",
        "flow_at": "l_R",
    }
    words: ClassVar[str] = (
        "a rudder in the slipstream of a propeller that may back (MMG, low speed)"
    )
    shown_by: ClassVar[str] = "turning from rest, and backing"
    source: ClassVar[str] = (
        "Y. Miyauchi, A. Maki, N. Umeda, D. M. Rachman, Y. Akimoto, J. Mar. Sci. Technol. 27, 2022"
    )
    roles: ClassVar = {
        "angle": Role("rad", "rudder angle, positive turns to starboard"),
        "shaft": Role("1/s", "shaft rate, positive ahead"),
    }
    law: ClassVar = law

    length: float = param(
        UNSET, low=0.0, high=500.0, unit="m", words="length of the ship", follows="vessel.length"
    )
    density: float = param(
        UNSET,
        low=0.0,
        high=1100.0,
        unit="kg/m^3",
        words="density of the water",
        follows="mmg_low_speed_hull.density",
    )
    diameter: float = param(
        UNSET,
        low=0.0,
        high=20.0,
        unit="m",
        words="propeller diameter, D_P",
        follows="mmg_low_speed_propeller.diameter",
    )
    thrust_deduction: float = propeller_parameter("thrust_deduction")
    wake: float = propeller_parameter("wake")
    wake_tau: float = propeller_parameter("wake_tau")
    wake_C_P: float = propeller_parameter("wake_C_P")
    propeller_at: float = propeller_parameter("propeller_at")
    k0: float = propeller_parameter("k0")
    k1: float = propeller_parameter("k1")
    k2: float = propeller_parameter("k2")
    astern_C1: float = propeller_parameter("astern_C1")
    astern_C2: float = propeller_parameter("astern_C2")
    astern_from: float = propeller_parameter("astern_from")
    astern_stop: float = propeller_parameter("astern_stop")
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="rudder force over its specified value",
        calibrates="thrust",
    )
    area: float = param(0.0, low=0.0, high=500.0, unit="m^2", words="rudder area, A_R")
    span: float = param(1.0, low=0.001, high=50.0, unit="m", words="rudder span, H_R")
    slope: float = param(
        0.0, low=0.0, high=10.0, unit="", words="f_alpha, slope of the normal force coefficient"
    )
    steering_deduction: float = param(
        0.0, low=0.0, high=1.0, unit="", words="steering resistance deduction, t_R"
    )
    hull_share: float = param(
        0.0, low=0.0, high=2.0, unit="", words="a_H, sway force on the hull per rudder force"
    )
    hull_at: float = param(
        0.0,
        low=-1.0,
        high=1.0,
        unit="",
        words="x_H', place of that force ahead of midship, in lengths",
    )
    rudder_at: float = param(
        -0.5, low=-1.0, high=1.0, unit="", words="x_R', rudder ahead of midship, in lengths"
    )
    flow_at: float = param(
        -1.0,
        low=-2.0,
        high=2.0,
        unit="",
        words="l_R', effective longitudinal position in the flow, in lengths",
    )
    straightening_port: float = param(
        1.0,
        low=0.0,
        high=2.0,
        unit="",
        words="gamma_R, flow straightening with the stern moving to port",
    )
    straightening_starboard: float = param(
        1.0,
        low=0.0,
        high=2.0,
        unit="",
        words="gamma_R, flow straightening with the stern moving to starboard",
    )
    epsilon: float = param(
        1.0, low=0.0, high=3.0, unit="", words="wake at the rudder over wake at the propeller"
    )
    k_x: float = param(
        0.5,
        low=0.0,
        high=2.0,
        unit="",
        words="kappa epsilon, slipstream of a propeller with thrust ahead",
    )
    k_x_astern: float = param(
        0.0,
        low=0.0,
        high=2.0,
        unit="",
        words="kappa epsilon, slipstream of a propeller that backs or brakes",
    )
    c_pr: float = param(
        0.0,
        low=-2.0,
        high=2.0,
        unit="",
        words="C_PR, reduction of the flow by a backing propeller, times u^2",
    )
    stall: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle of attack above which F_N is constant"
    )
