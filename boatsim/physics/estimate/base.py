"""What all rules take and give: a hull as its owner knows it, and a number with the rule it came from."""

from typing import NamedTuple

DENSITY = 1000.0  # [kg/m^3] fresh water
VISCOSITY = 1.19e-6  # [m^2/s] fresh water at 14 deg C
SLENDER = 5.0  # length per beam of one hull from which regressions over ships hold


class Estimate(NamedTuple):
    """A number and the rule behind it, as a file says it."""

    value: float
    rule: str


class Hull(NamedTuple):
    """One boat of one hull, or of two alike side by side."""

    length: float  # [m] of the waterline
    beam: float  # [m] overall
    mass: float  # [kg]
    draught: float  # [m]
    hulls: int  # 1 or 2
    breadth: float  # [m] of one hull

    @property
    def block(self) -> float:
        """Block coefficient of one hull."""
        return self.mass / (DENSITY * self.hulls * self.length * self.breadth * self.draught)

    @property
    def slender(self) -> bool:
        """Whether it is long enough for what was measured on ships."""
        return self.length >= SLENDER * self.breadth

    @property
    def spacing(self) -> float:
        """From centre line to centre line of two hulls [m]."""
        return self.beam - self.breadth if self.hulls == 2 else 0.0
