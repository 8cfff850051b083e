"""Types that all rules share: a hull by its main particulars, and an estimate with its rule."""

from typing import NamedTuple

DENSITY = 1000.0  # [kg/m^3] fresh water
VISCOSITY = 1.19e-6  # [m^2/s] fresh water at 14 deg C
SLENDER = 5.0  # length per beam of one hull from which regressions over ships hold


class Estimate(NamedTuple):
    """Estimated coefficient of a boat with the rule behind it, as written to a vessel file."""

    value: float
    rule: str


class HullParticulars(NamedTuple):
    """Main particulars of a boat with one hull, or with two equal hulls side by side."""

    length: float  # [m] of the waterline
    beam: float  # [m] overall
    mass: float  # [kg]
    draught: float  # [m]
    hulls: int  # 1 or 2
    breadth: float  # [m] of one hull

    @property
    def block_coefficient(self) -> float:
        """Block coefficient of one hull: displaced volume / (length breadth draught)."""
        return self.mass / (DENSITY * self.hulls * self.length * self.breadth * self.draught)

    @property
    def is_slender(self) -> bool:
        """Whether the hull is slender enough for regression formulas that were fitted to ships."""
        return self.length >= SLENDER * self.breadth

    @property
    def hull_spacing(self) -> float:
        """Distance between the centrelines of a catamaran's two hulls [m]; 0 for one hull."""
        return self.beam - self.breadth if self.hulls == 2 else 0.0
