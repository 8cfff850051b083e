"""Held freedom: a rig that clamps the hull in single degrees of freedom."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import UNSET, Boat, Inertia, MassMatrix, mass_matrix, param

# Inertia of a held freedom over that of the body: it then moves a millionth of what it would
RIGID = 1e6


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the mass matrix of a rig so heavy that the hull does not move in the held axes.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg, kg m^2] about the origin of motion.
    """
    return mass_matrix(
        surge=q.surge * q.mass,
        sway=q.sway * q.mass,
        heave=q.heave * q.mass,
        roll=q.roll * q.roll_inertia,
        pitch=q.pitch * q.yaw_inertia,
        yaw=q.yaw * q.yaw_inertia,
    )


def held_parameter(axis: str) -> float:
    """Declare whether a degree of freedom is held as a parameter.

    Args:
        axis: Degree of freedom.
    """
    return param(0.0, low=0.0, high=1.0, unit="", words=f"1: the rig holds {axis}", axis=axis)


@dataclass(frozen=True)
class HeldFreedom(Inertia):
    """Rig that holds the hull in some degrees of freedom, in some runs.

    M_ii = h_i 10^6 m_i

    A run states what is held by `[set.held_freedom]` in its recording.toml. The hull gets a million
    times its inertia there, so that no force moves it; all engines follow that without a shorter
    step, which a stiff spring would need.
    """

    formula: ClassVar[str] = r"\mathbf{M}_{ii} = h_i \, 10^6 \, m_i"
    words: ClassVar[str] = "the rig holds the hull in some degrees of freedom"
    shown_by: ClassVar[str] = "an axis that does not move under a force"
    source: ClassVar[str] = "limit of a large inertia"
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia

    surge: float = held_parameter("surge")
    sway: float = held_parameter("sway")
    heave: float = held_parameter("heave")
    roll: float = held_parameter("roll")
    pitch: float = held_parameter("pitch")
    yaw: float = held_parameter("yaw")
    mass: float = param(
        UNSET, low=0.0, high=1e30, unit="kg", words="a million times the mass of the body"
    )
    roll_inertia: float = param(
        UNSET, low=0.0, high=1e30, unit="kg m^2", words="a million times the roll inertia"
    )
    yaw_inertia: float = param(
        UNSET, low=0.0, high=1e30, unit="kg m^2", words="a million times the yaw inertia"
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the inertia of a held freedom, a million times that of the body.

        Args:
            vessel: Vessel with a body.
        """
        body = vessel.body
        return {
            "mass": RIGID * body.mass,
            "roll_inertia": RIGID * body.roll_inertia,
            "yaw_inertia": RIGID * body.yaw_inertia,
        }
