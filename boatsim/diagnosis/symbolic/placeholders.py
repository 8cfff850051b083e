"""Placeholder effects of a compiled program, whose parameters are set to those of a term."""

from collections.abc import Mapping, Sequence

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.problem import Problem
from boatsim.physics.base import Array
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.physics.terms import COURSES

# parameters of a placeholder that never acts: for a term that is an event of another recording
NEVER = {"course": float(COURSES.index("within")), "begin": 0.0, "end": 0.0}


def unused_placeholder(problem: Problem, kind: type[SymbolicTerm], used: Sequence[str]) -> str:
    """Return the name of a placeholder effect that has not been set to a symbolic term yet.

    Placeholders are compiled into the vessel program, so that a term needs no further compilation.

    Args:
        problem: The estimation problem.
        kind: Kind of the term: a force or a change of thrust.
        used: Names of the placeholders that have a term.

    Returns:
        Name of the placeholder; "" if all are used.
    """
    for effect in problem.program.candidates:
        if type(effect) is kind and effect.name not in used:
            return effect.name
    return ""


def set_placeholder_term(
    problem: Problem, placeholder: str, term: SymbolicTerm, recordings: Sequence[MappedRecording]
) -> None:
    """Set a placeholder effect of the compiled vessel program to a term of the symbolic regression.

    A term that is an event of one recording (`term.run`) acts in that recording alone; in all
    others the placeholder is set so that it never acts. Its parameters there are the same for every
    such term, so that the filter repeats no work on recordings in which nothing changes.

    Args:
        problem: The estimation problem.
        placeholder: Name of the placeholder.
        term: A term of the symbolic regression.
        recordings: Recordings whose parameter values are changed.
    """
    vessel = problem.program.vessel
    parameters = term.with_all_parameters(vessel).law_parameters()
    unused = type(term).from_settings({"name": placeholder}).with_all_parameters(vessel)
    inactive = unused.law_parameters() | NEVER
    for recording in recordings:
        acts = term.run in ("", recording.name)
        _set(problem, placeholder, parameters if acts else inactive, recording.values)


def _set(
    problem: Problem, placeholder: str, parameters: Mapping[str, float], values: Array
) -> None:
    for name, value in parameters.items():
        values[problem.program.parameter_index(placeholder, name)] = value
