"""Inertia effects: mass that accelerates with the hull."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.signals import MASS_ENTRIES, Array, MassMatrix

INERTIAS = ProgramFunction("add_inertias", "p, on, water, hull", ("pass",), "")


@dataclass(frozen=True)
class Inertia(EffectKind):
    """Mass matrix: compiled `inertia(values) -> MassMatrix`.

    The Coriolis force of the mass is the law of the effect.

    `moves_with` is "water" for added mass, which feels the acceleration relative to the water, or
    "hull" for ballast.
    """

    parts: ClassVar = (INERTIAS,)
    laws: ClassVar[tuple[str, ...]] = ("inertia",)
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar[Callable[..., MassMatrix]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the lines that add the entries to the mass matrix of the water or of the hull.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is INERTIAS:
            into = getattr(type(program.effects[number]), "moves_with", "water")
            for site in program.law_calls(number):
                yield f"g = {site.text('inertia')}"
                yield f"for j in range({len(MASS_ENTRIES)}): {into}[j] += g[j]"

    def matrix(self) -> Array:
        """Return the mass matrix (6, 6) over `AXES` [kg, kg m, kg m^2]."""
        return MassMatrix(*type(self).inertia(self.values())).matrix()
