"""Laws that use past values of an actuator signal, which the program stores for them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.channel import ADVANCE, TIME_TO_DISCONTINUITY, WHOLE
from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout


@dataclass(frozen=True)
class SignalHistory(EffectKind):
    """Base class of effects whose law uses past values of an actuator signal.

    `update_signal_history(act, held, own, memory, at, dt, values)`, compiled, is called after the
    step of the actuators. It sets act[own], act[held + own] and act[2 held + own] to the values
    that the law uses at begin, middle and end of the step dt [s], from the actuators there and from
    memory[at]. `longest_history_step(values)` is the time [s] for which three points describe these
    values.
    """

    laws: ClassVar[tuple[str, ...]] = ("update_signal_history", "longest_history_step")
    update_signal_history: ClassVar[Callable[..., None]]
    longest_history_step: ClassVar[Callable[..., float]]

    @property
    def uses_history(self) -> bool:
        """Whether this effect uses past values of an actuator; otherwise it needs no memory."""
        return True

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that store the past actuator values which the effect's law uses.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if (
            station.channel != WHOLE
            or part not in (ADVANCE, TIME_TO_DISCONTINUITY)
            or not (own := program.history_index(number))
        ):
            return
        values = program.law_calls(number)[0].values
        if part is ADVANCE:
            at = f"np.int64({program.memory_offset(number, WHOLE)})"
            places = f"act, held, np.int64({own}), memory, {at}"
            yield f"update_signal_history{number}({places}, dt, {values})"
        else:
            yield f"left = min(left, longest_history_step{number}({values}))"
