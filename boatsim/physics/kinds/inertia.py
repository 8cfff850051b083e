"""Inertia effects: mass that accelerates with the hull."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.signals import MASS_ENTRIES, Array, MassMatrix

INERTIAS = ProgramFunction("add_inertias", "p, on, water, hull", ("pass",), "")


@dataclass(frozen=True)
class Inertia(EffectKind):
    """Base class of effects that add a mass matrix: compiled `inertia(values) -> MassMatrix`.

    The Coriolis force of the mass is the law of the effect.

    `moves_with` is "water" for added mass, which feels the acceleration relative to the water, or
    "hull" for ballast.
    """

    parts: ClassVar[tuple[ProgramFunction, ...]] = (INERTIAS,)
    laws: ClassVar[tuple[str, ...]] = ("inertia",)
    moves_with: ClassVar[str] = "water"
    inertia: ClassVar[Callable[..., MassMatrix]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that add the effect's mass matrix to the sum over all effects.

        Added mass of the water and masses on board have separate sums.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is INERTIAS:
            kind = type(program.effects[number])
            into = getattr(kind, "moves_with", "water")
            for site in program.law_calls(number):
                if kind.sees_held:  # a mass depends on no signal
                    site = site._replace(signals=())
                yield f"g = {site.text('inertia')}"
                yield f"for j in range({len(MASS_ENTRIES)}): {into}[j] += g[j]"

    def matrix(self) -> Array:
        """Return the mass matrix (6, 6) of this effect over `AXES` [kg, kg m, kg m^2]."""
        return MassMatrix(*type(self).inertia(self.values())).matrix()
