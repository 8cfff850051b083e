"""Recall effects: laws that use past values of an actuator, which the program stores for them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.channel import ACTUATE, PAUSE, WHOLE
from boatsim.physics.kinds.effect import Composed, Kind, Part, Station


@dataclass(frozen=True)
class Recall(Kind):
    """Past values: compiled `recall(act, held, own, memory, at, dt, values)`.

    It is called after the step of the actuators.

    It sets act[own], act[held + own] and act[2 held + own] to the values that the law uses at
    begin, middle and end of the step dt [s], from the actuators there and from memory[at].
    `reach(values)` is the time [s] for which three points describe these values.
    """

    laws: ClassVar[tuple[str, ...]] = ("recall", "reach")
    recall: ClassVar[Callable[..., None]]
    reach: ClassVar[Callable[..., float]]

    @property
    def looks_back(self) -> bool:
        """Whether this instance uses past values; otherwise it needs no memory."""
        return True

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Yield the lines that track the actuator whose past values the law uses.

        Args:
            part: Function of the program.
            station: Place in it.
            number: Index of the effect.
            program: Program that is composed.
        """
        if (
            station.channel != WHOLE
            or part not in (ACTUATE, PAUSE)
            or not (own := program.own(number))
        ):
            return
        values = program.sites(number)[0].values
        if part is ACTUATE:
            at = f"np.int64({program.memory(number, WHOLE)})"
            yield f"recall{number}(act, held, np.int64({own}), memory, {at}, dt, {values})"
        else:
            yield f"left = min(left, reach{number}({values}))"
