"""Adds the candidates and the assumptions of a diagnosis to its answer."""

from collections.abc import Sequence

from boatsim.diagnosis.candidates import Library, called
from boatsim.diagnosis.filter import axes_of
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.locate.nominal_forces import full_thrust
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.report.schema import AmbientEntry, Answer, LeftOutEntry, RulesEntry
from boatsim.diagnosis.search.evidence import price


def add(answer: Answer, problem: Problem, library: Library, tried: Sequence[str]) -> None:
    """Put it into the answer; entries of the library that are not among those tried the user took out."""
    taken_out = {n: "--without" for n in library.tried if n not in tried}
    reasons = dict(library.left_out) | taken_out
    by_idea = {called(n): why for n, why in sorted(reasons.items())}
    left_out: list[LeftOutEntry] = [{"name": n, "reason": why} for n, why in by_idea.items()]
    answer["tried"] = sorted({called(n) for n in tried})
    answer["left_out"] = left_out
    answer["facts"] = dict(problem.recordings[0].facts)
    answer["rules"] = _rules(problem, len(tried))


def _rules(problem: Problem, number_tried: int) -> RulesEntry:
    vessel, levels = problem.program.vessel, problem.ambient
    thrust = full_thrust(problem.recordings[0])
    ambient: dict[str, AmbientEntry] = {}
    for axis, rms in zip(axes_of(vessel), levels.force.tolist(), strict=True):
        ambient[axis] = {"rms": float(f"{rms:.3g}"), "unit": FORCE_UNITS[axis]}
        if thrust > 0.0 and FORCE_UNITS[axis] == "N":
            ambient[axis]["share_of_full_thrust"] = float(f"{rms / thrust:.3g}")
    return {
        "ambient": ambient,
        "time_constant_s": float(f"{levels.time_constant:.3g}"),
        "horizon_s": problem.horizon,
        "effect_gain_nats": round(price(number_tried), 2),
        "overridden": dict(vessel.diagnosis.reasons),
    }
