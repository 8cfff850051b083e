"""Righting arm: restoring roll moment of buoyancy."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics import particulars
from boatsim.physics.base import (
    UNSET,
    Boat,
    CoefficientRelease,
    Force,
    Wrench,
    factor_parameter,
    param,
    shift_parameter,
    wrench,
)


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the restoring roll moment -stiffness (phi - list + cubic phi^3) of buoyancy.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    return wrench(K=-q.stiffness * (m.phi - q.list + q.cubic * m.phi * m.phi * m.phi))


@dataclass(frozen=True)
class RightingArm(Force):
    """Restoring moment in roll, m g GM at small heel, with a cubic term.

    K = -stiffness (phi - list + cubic phi^3)
    """

    formula: ClassVar[str] = r"K = -m g \, GM \left(\phi - \phi_0 + c \, \phi^3\right)"
    symbols: ClassVar = {"stiffness": r"m g \, GM", "cubic": "c", "list": r"\phi_0"}
    words: ClassVar[str] = "the restoring moment of buoyancy is proportional to the heel"
    shown_by: ClassVar[str] = "a roll decay"
    law: ClassVar = law

    stiffness: float = param(
        UNSET,
        low=0.0,
        high=1e13,
        unit="N m",
        words="roll stiffness, m g GM",
        calibrates="restoring",
        axis="roll",
    )
    cubic: float = param(
        0.0,
        low=-20.0,
        high=20.0,
        unit="1/rad^2",
        words="relative change of the stiffness per heel squared",
        axis="roll",
    )
    list: float = param(0.0, low=-0.5, high=0.5, unit="rad", words="heel at rest", axis="roll")
    metacentric_height: float = param(
        0.0,
        low=0.0,
        high=50.0,
        unit="m",
        words="metacentric height GM, from which the stiffness follows",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the default roll stiffness m g GM, from the vessel's mass and metacentric height.

        Args:
            vessel: Vessel with a body.
        """
        return {"stiffness": vessel.body.mass * particulars.GRAVITY * self.metacentric_height}


@dataclass(frozen=True)
class MetacentricHeightError(CoefficientRelease):
    """Righting moment that differs from its specified value by a factor."""

    formula: ClassVar[str] = r"GM = k \, GM^0"
    symbols: ClassVar = {"factor": "k"}
    words: ClassVar[str] = (
        "the metacentric height differs from its value by more than its specified uncertainty"
    )
    refines: ClassVar[str] = "restoring"
    shown_by: ClassVar[str] = "the period of a roll decay"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, chapter 4"
    )

    # a period off is a separate local maximum of the likelihood
    starts: ClassVar = ({"factor": 0.5}, {"factor": 0.8}, {"factor": 1.25}, {"factor": 2.0})

    factor: float = factor_parameter(
        "righting_arm.stiffness",
        words="metacentric height over its specified value",
        axis="roll",
        in_per_cent="the metacentric height is {share} of its value in the vessel file",
    )


@dataclass(frozen=True)
class RightingArmStiffening(CoefficientRelease):
    """Cubic term of the righting arm, so that the roll period depends on the amplitude."""

    formula: ClassVar[str] = (
        r"c = c^0 + \mathrm{cubic}, \quad K = -m g \, GM \left(\phi - \phi_0 + c \, "
        r"\phi^3\right)"
    )
    words: ClassVar[str] = (
        "the righting moment is not in proportion to the heel, so the roll period changes with "
        "amplitude"
    )
    refines: ClassVar[str] = "restoring"
    shown_by: ClassVar[str] = "a roll decay from a large heel"

    cubic: float = shift_parameter(
        "righting_arm.cubic",
        words="relative change of the stiffness per heel squared",
        unit="1/rad^2",
        spread=3.0,
        low=-20.0,
        high=20.0,
        axis="roll",
    )
