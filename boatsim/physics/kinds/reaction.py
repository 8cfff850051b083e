"""Reaction effects: forces that depend on the sum of the other forces."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.kinds.force import ADD, COMPONENTS, WRENCH
from boatsim.physics.signals import Wrench

SO_FAR = f"Wrench({', '.join(COMPONENTS)})"


@dataclass(frozen=True)
class Reaction(EffectKind):
    """Base class of effects whose force is a function of the sum of other forces.

    Their compiled function is `reaction(motion, wrench, values) -> Wrench`, where `wrench` is the
    sum of all laws before it: those of the vessel in the order of its file, then the candidates.
    """

    laws: ClassVar[tuple[str, ...]] = ("reaction",)
    reaction: ClassVar[Callable[..., Wrench]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that compute the effect's force from the sum so far, and add it.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is WRENCH:
            for site in program.law_calls(number):
                yield f"f = {site.text('reaction', 'm', SO_FAR)}"
                yield ADD
