"""Dry friction: Coulomb friction of bearings, rails or gears, with stiction."""

from dataclasses import dataclass
from math import exp, sqrt, tanh
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.particulars import GRAVITY

FAR = 60.0  # regularisation speeds beyond which the friction is that of sliding
# Regularisation speeds over sqrt(g L) and sqrt(g / L): slow enough that a body that should stick
# moves by less than a degree in a second, and fast enough that steps of 0.02 s stay stable for a
# friction of up to a tenth of the weight
CREEP = 0.003
CREEP_RATE = 0.003


@njit(inline="always")
def dry_friction_force(speed: float, level: float, creep: float, static_ratio: float) -> float:
    """Return the dry friction against a speed, smooth through zero, with more friction at rest.

    The hull creeps at a fraction of `creep` where it would stick. The additional friction at rest
    decays within ten times that speed (Stribeck curve).

    Args:
        speed: Velocity of the axis [m/s or rad/s].
        level: Sliding friction [N or N m].
        creep: Speed of the smooth transition [m/s or rad/s].
        static_ratio: Largest friction at rest over the sliding friction [-].
    """
    z = speed / creep
    if abs(z) > FAR:
        return -level if z > 0.0 else level
    size = level
    if static_ratio != 1.0:
        # the peak has nearly its full height: exp is still 0.96 where tanh reaches 0.96
        size *= 1.0 + (static_ratio - 1.0) * exp(-0.01 * z * z)
    return -size * tanh(z)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the dry friction of bearings or rails in each axis, against the motion over ground.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(
        X=dry_friction_force(m.u, q.surge, q.creep, q.static_ratio),
        Y=dry_friction_force(m.v, q.sway, q.creep, q.static_ratio),
        Z=dry_friction_force(m.w, q.heave, q.creep, q.static_ratio),
        K=dry_friction_force(m.p, q.roll, q.creep_rate, q.static_ratio),
        M=dry_friction_force(m.q, q.pitch, q.creep_rate, q.static_ratio),
        N=dry_friction_force(m.r, q.yaw, q.creep_rate, q.static_ratio),
    )


def level_parameter(axis: str, spread: float, rotates: bool = False) -> float:
    """Declare the sliding friction of one axis as a parameter of the effect.

    Args:
        axis: Degree of freedom.
        spread: Prior standard deviation, for a hull of 1.2 m and 4.6 kg.
        rotates: Whether it is a moment.
    """
    unit, high = "N", 1e9
    if rotates:
        unit, high = "N m", 1e12
    return param(
        0.0,
        low=0.0,
        high=high,
        unit=unit,
        words=f"sliding friction in {axis}",
        fit=True,
        spread=spread,
        axis=axis,
        calibrates="damping",
    )


@dataclass(frozen=True)
class DryFriction(Force):
    """Friction that does not depend on the speed, of what guides the hull: bearings, rails, gears.

    X_i = -F_i (1 + (s - 1) exp(-(nu_i / 10 e)^2)) tanh(nu_i / e)

    F_i is the sliding friction of an axis, s = `static_ratio` the friction at rest over it. The
    speed is that over ground. e is the regularisation speed, `creep` for velocities and
    `creep_rate` for rates: the force falls to zero within it, so that the filter can differentiate
    the law and every integrator can step it. Instead of sticking, the hull creeps at less than e.

    Each axis has a guide of its own. On a body that slides over a plane the friction opposes the
    direction of the motion instead, which this law does not describe.
    """

    formula: ClassVar[str] = (
        r"X_i = -F_i \left(1 + (s - 1) \, \exp\left(-(\nu_i / 10 e)^2\right)\right) "
        r"\tanh\frac{\nu_i}{e}"
    )
    symbols: ClassVar = {
        "surge": "F_u",
        "sway": "F_v",
        "heave": "F_w",
        "roll": "F_p",
        "pitch": "F_q",
        "yaw": "F_r",
        "static_ratio": "s",
        "creep": "e",
        "creep_rate": "e",
    }
    requires: ClassVar = {"guided": (True,)}
    words: ClassVar[str] = "dry friction of bearings or rails opposes the motion at any speed alike"
    tied_to: ClassVar[str] = "bearings or rails fixed to the ground"
    shown_by: ClassVar[str] = "a decay to rest, and small forces that do not move the hull"
    source: ClassVar[str] = (
        "B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools "
        "and compensation methods for the control of machines with friction, Automatica 30 (1994)"
    )
    law: ClassVar = law

    # spreads: a friction coefficient of 0.05 times the weight, and that at a twelfth of the length
    surge: float = level_parameter("surge", 2.0)
    sway: float = level_parameter("sway", 2.0)
    yaw: float = level_parameter("yaw", 2.0, rotates=True)
    roll: float = level_parameter("roll", 2.0, rotates=True)
    heave: float = level_parameter("heave", 2.0)
    pitch: float = level_parameter("pitch", 2.0, rotates=True)
    static_ratio: float = param(
        1.0, low=1.0, high=5.0, unit="", words="largest friction at rest over the sliding friction"
    )
    creep: float = param(
        UNSET,
        low=1e-6,
        high=100.0,
        unit="m/s",
        words="regularisation speed, below which the friction falls to zero; default: 0.003 "
        "sqrt(g L)",
    )
    creep_rate: float = param(
        UNSET,
        low=1e-6,
        high=100.0,
        unit="rad/s",
        words="regularisation rate, below which the friction falls to zero; default: 0.003 "
        "sqrt(g / L)",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default regularisation speeds, small shares of the Froude speed and rate.

        Args:
            vessel: Vessel with a length [m].

        Returns:
            `creep` [m/s] and `creep_rate` [rad/s].
        """
        return {
            "creep": CREEP * sqrt(GRAVITY * vessel.length),
            "creep_rate": CREEP_RATE * sqrt(GRAVITY / vessel.length),
        }
