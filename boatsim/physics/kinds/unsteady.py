"""Unsteady effects: forces with a random time history."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.kinds.force import Force
from boatsim.physics.signals import OscillatingForce

OSCILLATION = ProgramFunction(
    "oscillating_force", "p, on", (f"s = OscillatingForce({'0.0, ' * 7}1.0)",), "s"
)


@dataclass(frozen=True)
class RandomForce(Force):
    """Random force: compiled `oscillating_force(values) -> OscillatingForce`.

    `law` is the force of one realisation.

    The simulator uses the realisation of `law`. The diagnosis filter tracks the oscillators of
    `oscillating_force` instead and disables the law by `realisation` = 0.
    """

    random: ClassVar[bool] = True
    parts: ClassVar = (OSCILLATION,)
    laws: ClassVar[tuple[str, ...]] = ("law", "oscillating_force")
    oscillating_force: ClassVar[Callable[..., OscillatingForce]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the line that sets the oscillators; the realisation is an ordinary force.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is OSCILLATION:
            for site in program.law_calls(number):
                yield f"s = {site.text('oscillating_force')}"
