"""Thrust of one of several drives that differs from its specified value."""

from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.base import Boat, CoefficientChange, CoefficientRelease
from boatsim.physics.param import factor_parameter


@dataclass(frozen=True)
class DriveGainError(CoefficientRelease):
    """Thrust of one thruster that differs by a factor from its specified value.

    A diagnosis tests it for each thruster of a vessel with more than two; of two thrusters,
    `thrust_imbalance` and `thrust_gain_error` describe the same. `on` names the thrusters.
    """

    formula: ClassVar[str] = r"g_i = k \, g_i^0"
    symbols: ClassVar = {"factor": "k"}
    once_per: ClassVar[str] = "thruster"
    of_two: ClassVar[str] = "thrust_imbalance"
    of_all: ClassVar = ("thrust_gain_error",)
    words: ClassVar[str] = "one thruster is stronger or weaker than specified"
    shown_by: ClassVar[str] = "a staircase of this thruster alone"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 11.2"
    )

    factor: float = factor_parameter(
        "thruster.gain",
        words="thrust over specified thrust",
        spread=0.3,
        low=0.02,
        high=3.0,
        in_per_cent="the thrust is {share} of the specified thrust",
    )

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return the gains of the thrusters that `on` names; of all without such a list.

        Args:
            vessel: Vessel on which the effect acts.
        """
        found = super().changes(vessel)
        if not self.on:
            return found
        return [change for change in found if change.owner in self.on]
