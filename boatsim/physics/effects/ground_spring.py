"""Ground spring: springs or lines that hold the hull near a place, in single axes of the earth."""

from dataclasses import dataclass
from math import cos, sin
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Force, Wrench, param, wrench


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the restoring force of springs or cables between the hull and a point of a rig.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    # the point of attachment lies below the origin and swings with the roll angle
    s, c = sin(m.phi), cos(m.phi)
    east = m.y - q.below * s * m.cos_psi
    north = m.x + q.below * s * m.sin_psi
    slack = q.place_north + q.velocity_north * m.t
    toward_north = -q.stiffness_north * (north - slack)
    toward_east = -q.stiffness_east * (east - q.place_east)
    level = m.cos_psi * toward_east - m.sin_psi * toward_north
    down = -q.down * m.z
    return wrench(
        X=m.cos_psi * toward_north + m.sin_psi * toward_east,
        Y=c * level + s * down,
        Z=c * down - s * level,
        K=-q.below * c * level - q.roll * m.phi,
        N=-q.turn * m.psi,
    )


@dataclass(frozen=True)
class GroundSpring(Force):
    """Springs, lines or cables of a rig between the hull and the ground, linear, axis by axis.

    F_east = -k_E (y_P - y_0),  F_north = -k_N (x_P - x_0 - V t),  Z = -k_D z,  K = -k_phi phi,
    N = -k_psi psi

    P is the point of attachment, `below` [m] the origin: the force to the side also heels the hull,
    and heel strains the spring. A towing carriage moves to the north with `velocity_north`.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} F_E &= -k_E \, (y - b \, \phi - y_0), \quad F_N = -k_N \, (x - x_0 - V "
        r"t), "
        r"\quad Z = -k_D \, z \\ K &= -b \, F_E - k_\phi \, \phi, \quad N = -k_\psi \, \psi "
        r"\end{aligned}"
    )
    symbols: ClassVar = {
        "stiffness_north": "k_N",
        "stiffness_east": "k_E",
        "down": "k_D",
        "roll": r"k_\phi",
        "turn": r"k_\psi",
        "place_north": "x_0",
        "place_east": "y_0",
        "velocity_north": "V",
        "below": "b",
    }
    required_facts: ClassVar = {"guided": True}
    ruled_out_by: ClassVar = {"moored": (False,)}
    words: ClassVar[str] = "a spring or cable of the rig pulls the hull back to its place"
    shown_by: ClassVar[str] = "a release from a place aside"
    source: ClassVar[str] = (
        "O. M. Faltinsen, Sea Loads on Ships and Offshore Structures, 1990, chapter 8: linear "
        "restoring of moorings"
    )
    tied_to: ClassVar[str] = "a fixed point"
    law: ClassVar = law
    strength: ClassVar = ("stiffness_north", "stiffness_east", "turn")

    stiffness_east: float = param(
        0.0,
        low=0.0,
        high=1e12,
        unit="N/m",
        words="stiffness to the east, sway at heading 0",
        fit=True,
        spread=4.0,
        axis="sway",
        calibrates="restoring",
    )
    stiffness_north: float = param(
        0.0,
        low=0.0,
        high=1e12,
        unit="N/m",
        words="stiffness to the north, surge at heading 0",
        fit=True,
        spread=4.0,
        axis="surge",
        calibrates="restoring",
    )
    turn: float = param(
        0.0,
        low=0.0,
        high=1e13,
        unit="N m",
        words="stiffness against turning",
        fit=True,
        spread=2.0,
        axis="yaw",
        calibrates="restoring",
    )
    down: float = param(
        0.0, low=0.0, high=1e12, unit="N/m", words="stiffness in heave", calibrates="restoring"
    )
    roll: float = param(
        0.0, low=0.0, high=1e13, unit="N m", words="stiffness in roll", calibrates="restoring"
    )
    place_east: float = param(
        0.0, low=-1e6, high=1e6, unit="m", words="place to the east at which the spring is slack"
    )
    place_north: float = param(
        0.0, low=-1e6, high=1e6, unit="m", words="place to the north at which the spring is slack"
    )
    velocity_north: float = param(
        0.0,
        low=-50.0,
        high=50.0,
        unit="m/s",
        words="velocity of the rig to the north, as of a towing carriage",
    )
    below: float = param(
        0.0,
        low=-100.0,
        high=100.0,
        unit="m",
        words="point of attachment, below the origin",
    )
