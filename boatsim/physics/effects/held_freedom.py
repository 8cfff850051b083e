"""Held freedom: a rig that clamps the hull in single degrees of freedom."""

from dataclasses import dataclass
from math import cos, sin, sqrt
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Force, Wrench, param, wrench
from boatsim.physics.particulars import GRAVITY

# Natural frequency of the clamped hull over sqrt(g / 2 T), that of a hull which heaves: the clamp
# then gives way by a sixteenth of what buoyancy allows, and needs no shorter steps than a sensor
STIFF = 4.0


@njit(inline="always")
def clamp_force(held: float, inertia: float, place: float, speed: float, frequency: float) -> float:
    """Return the force of a critically damped spring that holds one coordinate at zero.

    Args:
        held: 1 if the coordinate is held, else 0.
        inertia: Mass [kg] or moment of inertia [kg m^2] that the spring holds.
        place: Coordinate [m or rad].
        speed: Its rate [m/s or rad/s].
        frequency: Natural frequency of the clamped hull [rad/s].
    """
    return -held * inertia * frequency * (frequency * place + 2.0 * speed)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force of a rig that holds coordinates of the earth near zero.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    c, s = cos(m.phi), sin(m.phi)
    aside, sinking = c * m.v - s * m.w, s * m.v + c * m.w  # [m/s] level and vertical
    north = m.cos_psi * m.u - m.sin_psi * aside
    east = m.sin_psi * m.u + m.cos_psi * aside
    w = q.frequency
    to_north = clamp_force(q.surge, q.mass, m.x, north, w)
    to_east = clamp_force(q.sway, q.mass, m.y, east, w)
    down = clamp_force(q.heave, q.mass, m.z, sinking, w)
    level = m.cos_psi * to_east - m.sin_psi * to_north
    return wrench(
        X=m.cos_psi * to_north + m.sin_psi * to_east,
        Y=c * level + s * down,
        Z=c * down - s * level,
        K=clamp_force(q.roll, q.roll_inertia, m.phi, m.p, w),
        M=clamp_force(q.pitch, q.yaw_inertia, m.theta, m.q, w),
        N=clamp_force(q.yaw, q.yaw_inertia, m.psi, m.r, w),
    )


def held_parameter(axis: str) -> float:
    """Declare whether a degree of freedom is held as a parameter.

    Args:
        axis: Degree of freedom.
    """
    return param(0.0, low=0.0, high=1.0, unit="", words=f"1: the rig holds {axis}", axis=axis)


@dataclass(frozen=True)
class HeldFreedom(Force):
    """Rig that holds the hull in some degrees of freedom, in some runs, at the origin.

    F_i = -h_i m_i w (w x_i + 2 x_i')

    x_i are north, east and depth of the origin, roll, pitch and heading. A run states what is held
    by `[set.held_freedom]` in its recording.toml. The clamp is a critically damped spring with the
    natural frequency w, stiff against buoyancy but soft enough for every engine.
    """

    formula: ClassVar[str] = r"F_i = -h_i \, m_i \, \omega \left(\omega x_i + 2 \dot x_i\right)"
    symbols: ClassVar = {"frequency": r"\omega"}
    words: ClassVar[str] = "the rig holds the hull in some degrees of freedom"
    shown_by: ClassVar[str] = "an axis that does not move under a force"
    source: ClassVar[str] = "definition: a critically damped spring in each axis"
    tied_to: ClassVar[str] = "a fixed point"
    law: ClassVar = law

    surge: float = held_parameter("surge")
    sway: float = held_parameter("sway")
    heave: float = held_parameter("heave")
    roll: float = held_parameter("roll")
    pitch: float = held_parameter("pitch")
    yaw: float = held_parameter("yaw")
    frequency: float = param(
        UNSET,
        low=0.01,
        high=1000.0,
        unit="rad/s",
        words="natural frequency of the clamped hull; default: 4 sqrt(g / 2 T)",
    )
    mass: float = param(
        UNSET, low=0.0, high=1e12, unit="kg", words="mass that is held; default: twice the body's"
    )
    roll_inertia: float = param(
        UNSET,
        low=0.0,
        high=1e15,
        unit="kg m^2",
        words="roll inertia that is held; default: that of the body",
    )
    yaw_inertia: float = param(
        UNSET,
        low=0.0,
        high=1e15,
        unit="kg m^2",
        words="pitch and yaw inertia that are held; default: twice the yaw inertia of the body",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the inertia that a clamp holds, with added mass, and its natural frequency.

        Args:
            vessel: Vessel with a body and a draught [m].
        """
        body = vessel.body
        return {
            "frequency": STIFF * sqrt(0.5 * GRAVITY / vessel.draught),
            "mass": 2.0 * body.mass,
            "roll_inertia": body.roll_inertia,
            "yaw_inertia": 2.0 * body.yaw_inertia,
        }
