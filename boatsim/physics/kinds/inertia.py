"""Inertia effects: mass that accelerates with the hull."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.signals import MASS_ENTRIES, Array, Mass

INERTIAS = Part("inertias", "p, on, water, hull", ("pass",), "")


@dataclass(frozen=True)
class Inertia(Kind):
    """Mass matrix: compiled `inertia(values) -> Mass`; its Coriolis force is the law of the effect.

    `moves_with` is "water" for added mass, which feels the acceleration relative to the water, or
    "hull" for ballast.
    """

    parts: ClassVar = (INERTIAS,)
    laws: ClassVar[tuple[str, ...]] = ("inertia",)
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar[Callable[..., Mass]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the lines that add the entries to the mass matrix of the water or of the hull.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is INERTIAS:
            into = getattr(type(program.effects[number]), "moves_with", "water")
            for site in program.sites(number):
                yield f"g = {site.call('inertia')}"
                yield f"for j in range({len(MASS_ENTRIES)}): {into}[j] += g[j]"

    def matrix(self) -> Array:
        """Return the mass matrix (6, 6) over `AXES` [kg, kg m, kg m^2]."""
        return Mass(*type(self).inertia(self.values())).matrix()
