"""Recall: a law that may look back at what an actuator did of late, which the program then follows for it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

from boatsim.physics.kinds.channel import ACTUATE, PAUSE, WHOLE
from boatsim.physics.kinds.effect import Composed, Kind, Part, Station


@dataclass(frozen=True)
class Recall(Kind):
    """Compiled `recall(act, held, own, memory, at, dt, values)`, once all actuators have made their step of dt [s].

    It fills act[own], act[held + own], act[2 held + own], what its law sees at begin, middle and end of the step, from
    the actuators there and from memory[at]. `reach(values)` is for how many s three points tell the course of that.
    """

    laws: ClassVar[tuple[str, ...]] = ("recall", "reach")
    recall: ClassVar[Callable[..., None]]
    reach: ClassVar[Callable[..., float]]

    @property
    def looks_back(self) -> bool:
        """Whether this instance does; one that does not remembers nothing, and costs nothing."""
        return True

    @classmethod
    def lines(cls, part: Part, station: Station, number: int, program: Composed) -> Iterator[str]:
        """Follow the actuator that the law looks back at."""
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
