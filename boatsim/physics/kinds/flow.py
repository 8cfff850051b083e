"""Flow effects: motion of the water over the ground."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout

FLOW = ProgramFunction("water_velocity", "p, on", ("north = east = 0.0",), "north, east")


@dataclass(frozen=True)
class WaterFlow(EffectKind):
    """Base class of effects that move the water over the ground, such as a current.

    Their compiled function is `water_velocity(values) -> (north, east)` [m/s].
    """

    parts: ClassVar = (FLOW,)
    laws: ClassVar[tuple[str, ...]] = ("water_velocity",)
    water_velocity: ClassVar[Callable[..., tuple[float, float]]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that add the effect's water velocity to the sum over all effects.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is FLOW:
            for site in program.law_calls(number):
                yield f"a, b = {site.text('water_velocity')}"
                yield "north += a; east += b"
