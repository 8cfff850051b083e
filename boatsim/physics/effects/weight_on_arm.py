"""Weight on an arm: a mass at a distance from the roll axis of a body held by bearings."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import (
    Boat,
    CoefficientChange,
    CoefficientRelease,
    factor_parameter,
    shift_parameter,
)
from boatsim.physics.particulars import GRAVITY

SOURCE = "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"


@dataclass(frozen=True)
class WeightOnArm(CoefficientRelease):
    """Point mass m at a distance a from a fixed roll axis, which the vessel file does not contain.

    I_x += m a^2,  moment of `righting_moment` += m g a

    The effect is for a body that bearings hold at its axis and whose moment was measured. Where
    that measurement is right, the motion identifies both changes, and with them the mass and its
    distance. A scale error of the measured moment (`load_gain_error`) looks nearly the same, so the
    effect is tested on request. A mass that was removed has negative changes.
    """

    formula: ClassVar[str] = (
        r"I_x = I_x^0 + \Delta I, \quad m g \, GM = (m g \, GM)^0 + \Delta K, \quad "
        r"a = \frac{g \, \Delta I}{\Delta K}, \quad m = \frac{\Delta K^2}{g^2 \, \Delta I}"
    )
    symbols: ClassVar = {"inertia": r"\Delta I", "moment": r"\Delta K"}
    needs: ClassVar = ("roll",)
    required_facts: ClassVar = {"guided": True}
    confounded_with: ClassVar = ("load_gain_error",)
    words: ClassVar[str] = "a mass at a distance from the roll axis is missing in the vessel file"
    refines: ClassVar[str] = "inertia"
    shown_by: ClassVar[str] = "free oscillations and a known moment"
    source: ClassVar[str] = SOURCE
    starts: ClassVar = (
        {"inertia": 0.5, "moment": 5.0},
        {"inertia": 1.0, "moment": 15.0},
        {"inertia": -0.2, "moment": -3.0},
    )

    inertia: float = shift_parameter(
        "body.roll_inertia",
        words="moment of inertia of the mass about the axis",
        unit="kg m^2",
        spread=1.5,
        low=-1e12,
        high=1e12,
        axis="roll",
    )
    moment: float = shift_parameter(
        "righting_moment.moment",
        words="restoring moment of the mass",
        unit="N m",
        spread=15.0,
        low=-1e12,
        high=1e12,
        axis="roll",
    )

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return the changes of a vessel with a restoring moment and a measured load, else none.

        Args:
            vessel: Vessel on which the effect acts.
        """
        if not vessel.names_of("righting_moment") or not vessel.names_of("applied_load"):
            return []
        return super().changes(vessel)

    def identifiable_ratios(self, vessel: Boat) -> dict[str, tuple[float, str]]:
        """Return the equivalent point mass [kg] and its distance from the roll axis [m].

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            Name -> (value, meaning in words); empty if the changes of inertia and of
            moment differ in sign, which no point mass causes.
        """
        if self.inertia * self.moment <= 0.0:
            return {}
        arm = GRAVITY * self.inertia / self.moment
        mass = self.moment / (GRAVITY * arm)
        return {
            "mass": (mass, "kg, of a point mass with this inertia and moment"),
            "arm": (arm, "m, distance of that point mass from the axis"),
        }


@dataclass(frozen=True)
class RollInertiaError(CoefficientRelease):
    """Roll inertia that differs from its specified value by a factor.

    Motion alone identifies only the ratio of moment and inertia. The inertia itself can be found
    where a moment was measured, so the effect needs a vessel with an `applied_load`.
    """

    formula: ClassVar[str] = r"I_x = k \, I_x^0"
    symbols: ClassVar = {"factor": "k"}
    needs: ClassVar = ("roll",)
    words: ClassVar[str] = "the moment of inertia in roll differs from its value in the vessel file"
    refines: ClassVar[str] = "inertia"
    shown_by: ClassVar[str] = "fast motion under a known moment"
    source: ClassVar[str] = SOURCE

    factor: float = factor_parameter(
        "body.roll_inertia",
        words="moment of inertia over its specified value",
        spread=0.3,
        low=0.1,
        high=10.0,
        axis="roll",
        in_per_cent="the moment of inertia in roll is {share} of its value in the vessel file",
    )

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return the change of the roll inertia of a vessel with a measured load, else none.

        Args:
            vessel: Vessel on which the effect acts.
        """
        if not vessel.names_of("applied_load"):
            return []
        return super().changes(vessel)
