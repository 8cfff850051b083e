"""Laws that use filtered values of an input signal, such as the rate of a measured elevation."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.channel import ADVANCE, TIME_TO_DISCONTINUITY, WHOLE
from boatsim.physics.kinds.effect import EffectKind, InsertionPoint, ProgramFunction, ProgramLayout


@dataclass(frozen=True)
class FilteredSignal(EffectKind):
    """Base class of effects that pass the signal of their first role through a filter with states.

    `filtered` names the results. The law receives them as further fields of its signals.

    `filter_signal(x, act, held, own, memory, at, dt, values)`, compiled, is called after the step
    of the actuators. x is the `SignalSegment` of the first role over the step dt [s]. It advances
    the `filter_states` states memory[at] and following, and sets act[own + i], act[held + own + i]
    and act[2 held + own + i] to the results at begin, middle and end of the step. A very long step
    leads to the steady state. `longest_filter_step(values)` is the time [s] for which three points
    describe the results.
    """

    laws: ClassVar[tuple[str, ...]] = ("filter_signal", "longest_filter_step")
    filter_signal: ClassVar[Callable[..., None]]
    longest_filter_step: ClassVar[Callable[..., float]]

    @property
    def lookahead(self) -> float:
        """Time [s] by which a recorded signal leads, so that the filter's delay does not matter."""
        return 0.0

    @classmethod
    def program_lines(
        cls, part: ProgramFunction, station: InsertionPoint, number: int, program: ProgramLayout
    ) -> Iterator[str]:
        """Yield the source lines that advance the filter of an effect's input signal.

        Args:
            part: Function of the compiled program that receives the lines.
            station: Insertion point in that function.
            number: Index of the effect among all effects of the program.
            program: Layout of the program that is generated for the vessel.
        """
        if station.channel != WHOLE or part not in (ADVANCE, TIME_TO_DISCONTINUITY):
            return
        values = program.law_calls(number)[0].values
        if part is TIME_TO_DISCONTINUITY:
            yield f"left = min(left, longest_filter_step{number}({values}))"
            return
        source = program.filtered_signal_index(number)
        own = program.history_index(number)
        at = f"np.int64({program.memory_offset(number, WHOLE)})"
        rows = f"act[{source}], act[held + {source}], act[2 * held + {source}]"
        places = f"act, held, np.int64({own}), memory, {at}"
        yield f"filter_signal{number}(SignalSegment({rows}), {places}, dt, {values})"
