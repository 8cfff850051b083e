"""Entries of the answer on the candidates that were tested and on what was assumed."""

from boatsim.diagnosis.answer.schema import DisturbanceLevelEntry, LeftOutEntry, RulesEntry
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.locate.missing_force import FORCE_UNITS
from boatsim.diagnosis.locate.nominal_forces import full_thrust
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.question import Question
from boatsim.diagnosis.search.evidence import required_gain

BY_USER = "--without"  # reason for a candidate that the user excluded


def excluded_candidates(question: Question) -> list[LeftOutEntry]:
    """Return the candidate effects that were not tested, with the reasons, for diagnosis.json.

    Args:
        question: The candidates of the diagnosis.
    """
    reasons = dict(question.library.excluded)
    for name in question.library.tested_names:
        if name not in question.candidates:
            reasons[name] = BY_USER
    entries: dict[str, LeftOutEntry] = {}
    for name, reason in sorted(reasons.items()):
        entries[name_without_prefixes(name)] = {
            "name": name_without_prefixes(name),
            "reason": reason,
        }
    return list(entries.values())


def assumptions_entry(problem: Problem, tested: int) -> RulesEntry:
    """Return the assumptions made before any data were evaluated, for diagnosis.json.

    They are the disturbance level, its correlation time, the length of free runs, the required
    evidence and what the vessel file overrides.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        tested: Number of candidates that were tested.
    """
    vessel, levels = problem.program.vessel, problem.ambient
    thrust = full_thrust(problem.recordings[0])
    ambient: dict[str, DisturbanceLevelEntry] = {}
    for axis, rms in zip(dof_in_state_order(vessel), levels.force.tolist(), strict=True):
        ambient[axis] = {"rms": float(f"{rms:.3g}"), "unit": FORCE_UNITS[axis]}
        if thrust > 0.0 and FORCE_UNITS[axis] == "N":
            ambient[axis]["share_of_full_thrust"] = float(f"{rms / thrust:.3g}")
    return {
        "ambient": ambient,
        "time_constant_s": float(f"{levels.time_constant:.3g}"),
        "horizon_s": problem.horizon,
        "effect_gain_nats": round(required_gain(tested, problem.config.select), 2),
        "overridden": dict(vessel.diagnosis.reasons),
    }
