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
    """Force as a function of other forces: compiled `reaction(motion, wrench, values) -> Wrench`.

    `wrench` is the sum of all laws before it: those of the vessel in the order of its file, then
    the candidates.
    """

    laws: ClassVar[tuple[str, ...]] = ("reaction",)
    reaction: ClassVar[Callable[..., Wrench]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the lines that add the reaction to the sum so far.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is WRENCH:
            for site in program.law_calls(number):
                yield f"f = {site.text('reaction', 'm', SO_FAR)}"
                yield ADD
