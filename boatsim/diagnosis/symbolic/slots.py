"""Terms written into the slots of a compiled program: one compiled law is any of them."""

from collections.abc import Sequence

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.problem import Problem
from boatsim.physics.base import Array
from boatsim.physics.described_laws import Described
from boatsim.physics.terms import COURSES

NEVER = (
    float(COURSES.index("within")),
    0.0,
    0.0,
)  # course, begin and end of what is an event of another recording


def free_slot(problem: Problem, kind: type[Described], taken: Sequence[str]) -> str:
    """Name of a slot of this kind that no term stands in; "" if all are taken."""
    there = (e.name for e in problem.program.candidates if type(e) is kind)
    return next((n for n in there if n not in taken), "")


def write(problem: Problem, name: str, term: Described, tracks: Sequence[MappedRecording]) -> None:
    """Put a term's numbers into a slot, in the values of all recordings that may be looked at."""
    numbers = term.completed(problem.program.vessel).by_name()
    for track in tracks:
        _put(problem, name, numbers, track.values)
        if term.run not in ("", track.name):
            event = dict(zip(("course", "begin", "end"), NEVER, strict=True))
            _put(problem, name, event, track.values)


def _put(problem: Problem, name: str, numbers: dict[str, float], values: Array) -> None:
    for key, x in numbers.items():
        values[problem.program.index(name, key)] = x
