"""Flow effects: motion of the water over the ground."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar, TypeGuard

import numpy as np

from boatsim.physics.debugging import python_function
from boatsim.physics.kinds.effect import (
    Effect,
    EffectKind,
    InsertionPoint,
    ProgramFunction,
    ProgramLayout,
)
from boatsim.physics.waves.water_path import WaterPath

FLOW = ProgramFunction(
    "water_velocity", "t, x, y, p, on, act, at", ("north = east = 0.0",), "north, east"
)
CHANGES = ("north_t", "north_x", "north_y", "east_t", "east_x", "east_y")
CHANGE = ProgramFunction(
    "water_change", "t, x, y, p, on", (f"{' = '.join(CHANGES)} = 0.0",), ", ".join(CHANGES)
)
DISPLACEMENT = ProgramFunction(
    "water_displacement", "t, p, on", ("north = east = 0.0",), "north, east"
)
# Lines that add the change of one effect, (a, b, c, d, e, f), to the sums
ADD_CHANGE = "; ".join(f"{name} += {one}" for name, one in zip(CHANGES, "abcdef", strict=True))


@dataclass(frozen=True)
class WaterFlow(EffectKind):
    """Base class of effects that move the water over the ground, such as a current.

    The compiled function of a uniform, steady flow is `water_velocity(values) -> (north, east)`
    [m/s].

    A flow that `varies` with time and place has three compiled functions, whose further arguments
    are the parameters and tables p of all effects and the place of its own table in them:

    - `water_velocity(t, x, y, values, p, first) -> (north, east)` [m/s];
    - `water_change(t, x, y, values, p, first)`, the derivatives of the velocity north by t [m/s^2],
      x and y [1/s], and then those of the velocity east;
    - `water_displacement(t, values, p, first) -> (north, east)` [m], how far the water on which
      waves travel has moved since t = 0. Plane waves need one displacement for all places.

    A flow with `roles` is measured: `water_velocity(values, signals) -> (north, east)` [m/s]. It
    `varies`, but its derivatives are not known: its water exerts no force by its acceleration, and
    waves travel on still water.
    """

    parts: ClassVar = (FLOW, CHANGE, DISPLACEMENT)
    laws: ClassVar[tuple[str, ...]] = ("water_velocity", "water_change", "water_displacement")
    varies: ClassVar[bool] = False  # whether the velocity depends on time and place
    water_velocity: ClassVar[Callable[..., tuple[float, float]]]
    water_change: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    water_displacement: ClassVar[Callable[..., tuple[float, float]] | None] = None

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
        effect = program.effects[number]
        measured = bool(type(effect).roles)
        varies = is_varying_flow(effect) and not measured
        if measured and part is not FLOW:
            return
        for site in program.law_calls(number):
            if part is FLOW:
                place = ("t", "x", "y") if varies else ()
                yield f"a, b = {site.text('water_velocity', *place)}"
                yield "north += a; east += b"
            elif part is DISPLACEMENT and varies:
                yield f"a, b = {site.text('water_displacement', 't')}"
                yield "north += a; east += b"
            elif part is DISPLACEMENT:
                yield f"a, b = {site.text('water_velocity')}"
                yield "north += a * t; east += b * t"
            elif part is CHANGE and varies:
                yield f"a, b, c, d, e, f = {site.text('water_change', 't', 'x', 'y')}"
                yield ADD_CHANGE

    def velocity_at(self, t: float, x: float, y: float) -> tuple[float, float]:
        """Return the velocity of the water over the ground, from Python.

        Args:
            t: Time [s].
            x: Place north or ahead at the start [m].
            y: Place east or to starboard at the start [m].

        Returns:
            Velocity to north and east [m/s].
        """
        if not type(self).varies:
            north, east = python_function(type(self).water_velocity)(self.values())
            return float(north), float(east)
        table = np.array([*self.table(), 0.0])  # no array is empty
        return type(self).water_velocity(t, x, y, self.values(), table, np.int64(0))

    def water_path(self) -> WaterPath:
        """Return the motion of the water on which waves travel; the effect has all parameters.

        A flow that varies overrides it, in agreement with its `water_displacement`.
        """
        return WaterPath.steady(*self.velocity_at(0.0, 0.0, 0.0))


def is_varying_flow(effect: Effect) -> TypeGuard[WaterFlow]:
    """Return whether an effect moves the water with a velocity that depends on time and place.

    Args:
        effect: An effect.
    """
    return isinstance(effect, WaterFlow) and type(effect).varies
