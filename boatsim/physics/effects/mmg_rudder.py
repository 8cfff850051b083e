"""MMG rudder: rudder force in the propeller slipstream and the hull force it induces."""

from dataclasses import dataclass
from math import atan2, pi, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Force, Role, Wrench, param, wrench
from boatsim.physics.effects.mmg_propeller import drift_angle, inflow_speed, open_water_thrust

NEVER = pi  # [rad] default: no stall at any angle of attack


@njit(inline="always")
def slipstream_speed(m: Any, q: Any, shaft: float) -> float:
    """Return the speed of the water along a rudder partly in the propeller slipstream [m/s].

    Args:
        m: Motion of the hull.
        q: Parameters of the effect.
        shaft: Shaft rate, positive ahead [1/s].
    """
    V, washed = inflow_speed(m, q), q.diameter / q.span
    faster = sqrt(max(V * V + 8.0 / pi * open_water_thrust(shaft, V, q), 0.0)) - V
    behind = V + q.kappa * faster
    return float(q.epsilon * sqrt(max(washed * behind * behind + (1.0 - washed) * V * V, 0.0)))


@njit(inline="always")
def law(m: Any, q: Any, s: Any) -> Wrench:
    """Return the rudder force of the MMG standard method, with the hull force that it induces.

    The force acts normal to the rudder. Hull and propeller straighten the flow that meets the
    rudder, by a factor for each side.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.
        s: Signals bound to the roles of the effect.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    # U beta_R
    across = sqrt(m.ur * m.ur + m.vr * m.vr) * drift_angle(m) - q.flow_at * m.r * q.length
    along = slipstream_speed(m, q, s.shaft)
    across = across * (q.straightening_port if across > 0.0 else q.straightening_starboard)
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
    """One rudder behind the propeller, MMG standard method; a positive angle turns to starboard.

    F_N = 0.5 rho A_R f_alpha (u_R^2 + v_R^2) sin(alpha_R),  alpha_R = delta - atan2(v_R, u_R)
    X = -(1 - t_R) F_N sin(delta),  Y = -(1 + a_H) F_N cos(delta)
    N = -(x_R + a_H x_H) F_N cos(delta),  v_R = U gamma_R beta_R,  beta_R = beta - l_R' r'
    u_R = epsilon sqrt(eta (u_P + kappa du)^2 + (1 - eta) u_P^2)
    du = sqrt(u_P^2 + 8 K_T n^2 D_P^2 / pi) - u_P

    eta = D_P / H_R is the share of the span in the slipstream.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= -(1 - t_R) F_N \sin\delta, \quad Y = -(1 + a_H) F_N "
        r"\cos\delta \\ N &= -(x_R + a_H x_H) F_N \cos\delta \\ F_N &= \tfrac{1}{2} \rho "
        r"A_R f_\alpha \left(u_R^2 + v_R^2\right) \sin\alpha_R, \quad \alpha_R = \delta - "
        r"\operatorname{atan2}(v_R, u_R) \\ v_R &= U \gamma_R (\beta - l'_R r') \\ u_R &= "
        r"\epsilon \sqrt{\eta \left(u_P + \kappa \Delta u\right)^2 + (1 - \eta) u_P^2}, "
        r"\quad \eta = D_P / H_R \\ \Delta u &= \sqrt{u_P^2 + 8 K_T n^2 D_P^2 / \pi} - "
        r"u_P \end{aligned}"
    )
    symbols: ClassVar = {
        "density": r"\rho",
        "diameter": "D_P",
        "area": "A_R",
        "span": "H_R",
        "slope": r"f_\alpha",
        "steering_deduction": "t_R",
        "hull_share": "a_H",
        "hull_at": "x_H",
        "rudder_at": "x_R",
        "flow_at": "l'_R",
        "epsilon": r"\epsilon",
        "kappa": r"\kappa",
    }
    words: ClassVar[str] = "a rudder in the slipstream of a propeller (MMG)"
    shown_by: ClassVar[str] = "turning circles and zig-zags"
    source: ClassVar[str] = (
        "H. Yasukawa, Y. Yoshimura, J. Mar. Sci. Technol. 20, 2015 (MMG standard method)"
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
        follows="mmg_hull.density",
    )
    diameter: float = param(
        UNSET,
        low=0.0,
        high=20.0,
        unit="m",
        words="propeller diameter, D_P",
        follows="mmg_propeller.diameter",
    )
    wake: float = param(
        UNSET,
        low=0.0,
        high=1.0,
        unit="",
        words="wake fraction on a straight course, w_P0",
        follows="mmg_propeller.wake",
    )
    wake_C1: float = param(
        UNSET,
        low=0.0,
        high=20.0,
        unit="",
        words="C_1, decrease of the wake with the drift angle",
        follows="mmg_propeller.wake_C1",
    )
    wake_C2_port: float = param(
        UNSET,
        low=0.0,
        high=3.0,
        unit="",
        words="C_2 for flow from port, beta_P > 0",
        follows="mmg_propeller.wake_C2_port",
    )
    wake_C2_starboard: float = param(
        UNSET,
        low=0.0,
        high=3.0,
        unit="",
        words="C_2 for flow from starboard, beta_P < 0",
        follows="mmg_propeller.wake_C2_starboard",
    )
    propeller_at: float = param(
        UNSET,
        low=-1.0,
        high=1.0,
        unit="",
        words="x_P', propeller ahead of midship, in lengths",
        follows="mmg_propeller.propeller_at",
    )
    k0: float = param(
        UNSET, low=-2.0, high=2.0, unit="", words="K_T at J = 0", follows="mmg_propeller.k0"
    )
    k1: float = param(
        UNSET,
        low=-2.0,
        high=2.0,
        unit="",
        words="coefficient of J in K_T",
        follows="mmg_propeller.k1",
    )
    k2: float = param(
        UNSET,
        low=-2.0,
        high=2.0,
        unit="",
        words="coefficient of J^2 in K_T",
        follows="mmg_propeller.k2",
    )
    gain: float = param(
        1.0,
        low=0.1,
        high=5.0,
        unit="",
        words="rudder force over its specified value",
        calibrates="thrust",
    )
    area: float = param(
        0.0, low=0.0, high=500.0, unit="m^2", words="rudder area without the horn, A_R"
    )
    span: float = param(1.0, low=0.001, high=50.0, unit="m", words="rudder span, H_R")
    slope: float = param(
        0.0, low=0.0, high=10.0, unit="", words="f_alpha, slope of the normal force coefficient"
    )
    steering_deduction: float = param(
        0.0, low=0.0, high=1.0, unit="", words="steering resistance deduction, t_R"
    )
    hull_share: float = param(
        0.0,
        low=0.0,
        high=2.0,
        unit="",
        words="a_H, sway force on the hull per rudder force",
        calibrates="thrust",
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
        words="gamma_R, flow straightening for flow from port, beta_R > 0",
        calibrates="thrust",
    )
    straightening_starboard: float = param(
        1.0,
        low=0.0,
        high=2.0,
        unit="",
        words="gamma_R, flow straightening for flow from starboard",
        calibrates="thrust",
    )
    epsilon: float = param(
        1.0, low=0.0, high=3.0, unit="", words="wake at the rudder over wake at the propeller"
    )
    kappa: float = param(
        0.5,
        low=0.0,
        high=2.0,
        unit="",
        words="kappa, share of the slipstream velocity that reaches the rudder",
    )
    stall: float = param(
        NEVER, low=0.02, high=NEVER, unit="rad", words="angle of attack above which F_N is constant"
    )
