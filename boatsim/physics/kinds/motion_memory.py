"""Motion memory: forces that depend on the past motion of the hull, by states of their own."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.physics.kinds.channel import WHOLE
from boatsim.physics.kinds.effect import Effect, InsertionPoint, ProgramFunction, ProgramLayout
from boatsim.physics.kinds.force import Force
from boatsim.physics.signals import Motion, Wrench

ADVANCE_MOTION_MEMORY = ProgramFunction(
    "advance_motion_memory",
    "m, memory, dt, p, on, act, held",
    ("pass",),
    "",
    compiled="merged",
)


@dataclass(frozen=True)
class MotionMemory(Force):
    """Base class of forces of the past motion, as of the waves that a hull radiates.

    `remember_motion(m, act, held, own, memory, at, dt, values, p, first)`, compiled, is called at
    the begin of each step, with the motion m there. It advances the `memory_states` states
    memory[at] and following over the last step, whose motion and length it has stored among them,
    and sets act[own + i], act[held + own + i] and act[2 held + own + i], i below `memory_signals`,
    to what the law needs at begin, middle and end of the step dt [s] that begins. The law receives
    these as `act`, `at` and `own`, and the present velocity as usual: a force that is linear in the
    velocity of the stage couples motion and memory without delay. p[first] is the first entry of
    the effect's table. All states are zero at the start of a simulation.
    """

    parts: ClassVar[tuple[ProgramFunction, ...]] = (ADVANCE_MOTION_MEMORY,)
    laws: ClassVar[tuple[str, ...]] = ("law", "remember_motion")
    sees_held: ClassVar[bool] = True
    sees_table: ClassVar[bool] = True
    memory_signals: ClassVar[int] = 0
    remember_motion: ClassVar[Callable[..., None]]

    @property
    def memory_states(self) -> int:
        """Number of floats that the effect stores from step to step, at least one."""
        return 1

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source line that advances the states of an effect's memory.

        The force is added like that of any other force effect.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if part is not ADVANCE_MOTION_MEMORY:
            return
        values = program.law_calls(number)[0].values
        own = f"np.int64({program.history_index(number)})"
        at = f"np.int64({program.memory_offset(number, WHOLE)})"
        table = f"p, np.int64({program.table_place(number)})"
        yield f"remember_motion{number}(m, act, held, {own}, memory, {at}, dt, {values}, {table})"

    def wrench(self, m: Motion, *given: tuple[float, ...], **signals: float) -> Wrench:
        """Return the force of this effect at one given motion after rest.

        Args:
            m: Motion of the hull.
            given: Not used.
            signals: Not used.
        """
        act = np.zeros(max(type(self).memory_signals, 1))
        table = np.array([*self.table(), 0.0])
        first = np.int64(0)
        return Wrench(*type(self).law(m, self.values(), act, first, first, table, first))


def effects_with_motion_memory(effects: Iterable[Effect]) -> str:
    """Return the names of the effects of a vessel that have a memory of the motion, for messages.

    Args:
        effects: Effects of the vessel.
    """
    return ", ".join(effect.name for effect in effects if isinstance(effect, MotionMemory))
