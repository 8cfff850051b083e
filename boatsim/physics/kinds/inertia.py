"""Inertia: mass that is carried along."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import Composed, Kind, Part, Station
from boatsim.physics.signals import MASS_ENTRIES, Array, Mass

INERTIAS = Part("inertias", "p, on, water, hull", ("pass",), "")


@dataclass(frozen=True)
class Inertia(Kind):
    """Compiled `inertia(values) -> Mass`; its Coriolis force is the effect's own law.

    `moves_with` says whose acceleration it feels: "water" (added mass: relative to the water) or "hull" (ballast).
    """

    parts: ClassVar = (INERTIAS,)
    laws: ClassVar[tuple[str, ...]] = ("inertia",)
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar[Callable[..., Mass]]

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Add its entries to those of the water or of the hull."""
        if part is INERTIAS:
            into = getattr(type(program.effects[number]), "moves_with", "water")
            for site in program.sites(number):
                yield f"g = {site.call('inertia')}"
                yield f"for j in range({len(MASS_ENTRIES)}): {into}[j] += g[j]"

    def matrix(self) -> Array:
        """(6, 6) over `AXES`: kg, kg m, kg m^2."""
        return Mass(*type(self).inertia(self.values())).matrix()
