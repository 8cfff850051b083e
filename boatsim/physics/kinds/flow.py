"""Flow effects: motion of the water over the ground."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout

FLOW = ProgramFunction("water_velocity", "p, on", ("north = east = 0.0",), "north, east")


@dataclass(frozen=True)
class WaterFlow(EffectKind):
    """Velocity of the water: compiled `water_velocity(values) -> (north, east)` [m/s]."""

    parts: ClassVar = (FLOW,)
    laws: ClassVar[tuple[str, ...]] = ("water_velocity",)
    water_velocity: ClassVar[Callable[..., tuple[float, float]]]

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the lines that add the velocity of the water.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if part is FLOW:
            for site in program.law_calls(number):
                yield f"a, b = {site.text('water_velocity')}"
                yield "north += a; east += b"
