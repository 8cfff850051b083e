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
    """Base class of random forces, such as wave forces, with a narrow-band spectrum.

    `oscillating_force(values) -> OscillatingForce`, compiled, gives the rms, frequency and damping
    ratio of the oscillators that model the force in the diagnosis filter. `law` is the force of one
    realisation.

    The simulator uses the realisation of `law`. The diagnosis filter tracks the oscillators of
    `oscillating_force_name` instead and disables the law by `realisation` = 0.
    """

    random: ClassVar[bool] = True
    of_surroundings: ClassVar[bool] = True
    parts: ClassVar = (OSCILLATION,)
    laws: ClassVar[tuple[str, ...]] = ("law", "oscillating_force")
    oscillating_force: ClassVar[Callable[..., OscillatingForce]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source line that gives a random force's oscillators to the diagnosis filter.

        The force of its realisation is added like that of any other force effect.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is OSCILLATION:
            for site in program.law_calls(number):
                yield f"s = {site.text('oscillating_force')}"
