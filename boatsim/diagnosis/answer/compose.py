"""Composes the answer of a diagnosis, the content of diagnosis.json."""

from collections.abc import Mapping, Sequence

from boatsim.diagnosis.answer.assumptions import assumptions_entry, excluded_candidates
from boatsim.diagnosis.answer.described_terms import described_entries
from boatsim.diagnosis.answer.effect_entries import (
    added_entry,
    candidate_entries,
    effect_entry,
    effect_meanings,
    parameter_limits,
    possible_entry,
)
from boatsim.diagnosis.answer.effect_groups import EffectGroups, classify_effects
from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.formulas import states_any
from boatsim.diagnosis.answer.incomplete import incomplete_sentence
from boatsim.diagnosis.answer.log_entry import column_sources, finding_entry
from boatsim.diagnosis.answer.schema import (
    Answer,
    EffectEntry,
    Family,
    FitEntry,
    LogEntry,
    MeanEntry,
    NextEntry,
    RecalibrationEntry,
    StrengthEntry,
    StructureEntry,
    UnknownEntry,
    WhereEntry,
)
from boatsim.diagnosis.answer.signs import cause_statistics_entry
from boatsim.diagnosis.answer.stages import Stages
from boatsim.diagnosis.answer.verdict import verdict_sentences
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT, Finding
from boatsim.diagnosis.config import settings_by_name
from boatsim.diagnosis.evaluation import Evaluation
from boatsim.diagnosis.experiment_design.next_experiment import Plan
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate.location import Location
from boatsim.diagnosis.locate.mean_force import MeanForce
from boatsim.diagnosis.locate.missing_force import ForceStrength
from boatsim.diagnosis.locate.residual_structure import Structure
from boatsim.diagnosis.open_set.decision import Decision
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.question import Question
from boatsim.diagnosis.recalibration import Recalibration
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.groups import without_group
from boatsim.version import version
from boatsim.view.formatting import capitalize, join_words

NEXT_SCENARIO = "next.toml"  # scenario of the next experiment, in the folder of the answer


def compose_answer(
    loaded: LoadedRecordings,
    question: Question,
    findings: Sequence[Finding],
    stages: Stages,
    seconds: float,
) -> Answer:
    """Compose the content of diagnosis.json, the answer of a diagnosis, from all its results.

    Args:
        loaded: Recordings and vessels.
        question: Candidates and held-out recordings.
        findings: Findings of the log quality checks.
        stages: Results of the stages.
        seconds: Duration of the diagnosis [s].
    """
    ranking, evaluation, problem = stages.ranking, stages.evaluation, stages.decision.problem
    vessel = problem.program.vessel
    groups = _effect_groups(stages.decision, ranking)
    tested = () if ranking.divergences else question.candidates
    upper, lower = dict[str, dict[str, float]](), dict[str, dict[str, float]]()
    for name, fitted in ranking.last.items():
        own = name_without_prefixes(name)
        upper[own], lower[own] = parameter_limits(problem, fitted, name)
    answer: Answer = {
        "verdict": "",
        "sentence": "",
        "seconds": round(seconds, 3),
        "version": version(),
        "effects": groups.effects,
        "refined": groups.refined,
        "also_possible": groups.also_possible,
        "added": [added_entry(problem, ranking.best, name) for name in ranking.added],
        "by_free_runs": ranking.by_free_runs,
        "unknown": _unknown(ranking, stages.location),
        "described": described_entries(ranking.description, vessel),
        "candidates": candidate_entries(ranking),
        "upper_limits": upper,
        "lower_limits": {name: found for name, found in lower.items() if found},
        "where": _where(stages.location),
        "fit": _fit(evaluation, [mapped.name for mapped in question.held_out]),
        "next_experiment": _next_experiment(stages.plan),
        "patch": "patched.toml",
        "mean_left": {axis: _mean(force) for axis, force in evaluation.mean_force.items()},
        "tried": sorted({name_without_prefixes(without_group(name)) for name in tested}),
        "left_out": excluded_candidates(question),
        "skipped": list(ranking.skipped),
        "facts": dict(problem.recordings[0].facts),
        "rules": assumptions_entry(problem, len(tested)),
        "log": _log(loaded, findings),
        "signs": cause_statistics_entry(stages.decision),
        "config": settings_by_name(problem.config),
    }
    if ranking.recalibration is not None:
        answer["recalibration"] = _recalibration(ranking.recalibration)
    answer["verdict"] = _verdict(ranking, groups.effects, states_any(answer))
    verdict = verdict_sentences(answer, effect_meanings(problem.candidates.values(), vessel))
    verdict = f"{verdict} {incomplete_sentence(ranking.skipped)}".rstrip()
    answer["sentence"] = _with_log_first(verdict, findings, problem, ranking)
    return answer


def _effect_groups(decision: Decision, ranking: Ranking) -> EffectGroups:
    """Return the entries of all selected effects in groups.

    Those that are probably stand-ins for another cause are among the possible ones.
    """
    problem, best = decision.problem, ranking.best
    entries = {}
    for identified in ranking.named:
        entries[identified.name] = effect_entry(problem, best, identified, decision)
    groups = classify_effects(problem, best, entries)
    for identified in ranking.doubtful:
        refuted = identified.name in ranking.contradicted
        groups.also_possible.append(possible_entry(problem, best, identified, decision, refuted))
    return groups


def _verdict(ranking: Ranking, effects: Sequence[EffectEntry], described: bool) -> str:
    if ranking.has_unexplained_force_or_cause and described:
        return "described"
    if ranking.has_unexplained_force_or_cause:
        return "unknown"
    if any(effect["tied_with"] for effect in effects):
        return "ambiguous"
    if effects:
        return "named"
    return "nothing_missing"


def _unknown(ranking: Ranking, location: Location) -> UnknownEntry:
    entry: UnknownEntry = {
        "flag": ranking.has_unexplained_force_or_cause,
        "gain_nats": round(ranking.left_over, 3),
        "told_from_nats": round(ranking.told_from, 3),
    }
    if ranking.has_unexplained_force_or_cause:
        entry["rest"] = _strengths(location.remaining)
    if ranking.stands_in and not ranking.exceeds_assumed_disturbance:
        entry["stand_ins"] = [name_without_prefixes(one.name) for one in ranking.doubtful]
    if ranking.held_out_remains and not (ranking.exceeds_assumed_disturbance or ranking.stands_in):
        entry["held_out_only"] = True
    if ranking.structure.significant:
        entry["structure"] = _structure(ranking.structure)
    if ranking.divergences:
        entry["diverges"] = []
        for place in ranking.divergences:
            entry["diverges"].append(
                {
                    "run": place.run,
                    "from_s": round(place.from_s, 3),
                    "axis": place.axis,
                    "rms": place.rms,
                    "unit": place.unit,
                }
            )
    return entry


def _structure(found: Structure) -> StructureEntry:
    return {
        "axis": found.axis,
        "goes_with": found.goes_with,
        "gain_nats": round(found.gain, 3),
        "p_value": float(f"{found.p_value:.2g}"),
        "tried": found.tested,
    }


def _where(location: Location) -> WhereEntry:
    """Return the axes, intervals and regions in which a force is missing."""
    entry: WhereEntry = {"axes": _strengths(location.strengths), "intervals": [], "region": []}
    for i in location.intervals:
        entry["intervals"].append(
            {"run": i.run, "from_s": i.from_s, "to_s": i.to_s, "axis": i.axis}
        )
    for r in location.regions:
        entry["region"].append(
            {"variable": r.variable, "statement": r.statement, "p_value": r.p_value}
        )
    return entry


def _strengths(forces: Mapping[str, ForceStrength]) -> dict[str, StrengthEntry]:
    """Return the sizes of a missing force by axis."""
    entries: dict[str, StrengthEntry] = {}
    for axis, force in forces.items():
        entries[axis] = {"rms": force.rms, "sd": force.sd, "unit": force.unit}
    return entries


def _mean(force: MeanForce) -> MeanEntry:
    """Return a mean force that remains unexplained."""
    entry: MeanEntry = {"mean": force.mean, "sd": force.sd, "unit": force.unit}
    if force.share_of_full_thrust is not None:
        entry["share_of_full_thrust"] = float(f"{force.share_of_full_thrust:.3g}")
    return entry


def _next_experiment(plan: Plan | None) -> NextEntry:
    """Return the experiment to record next; empty without a plan."""
    if plan is None:
        return {}
    return {
        "manoeuvre": plan.manoeuvre,
        "scenario": NEXT_SCENARIO,
        "separates": list(plan.separates),
        "expected_gain_nats": round(plan.expected_log_bayes_factor, 2),
    }


def _log(loaded: LoadedRecordings, findings: Sequence[Finding]) -> list[LogEntry]:
    """Return the problems of the recordings."""
    by_file = {str(path): vessel for path, vessel in loaded.vessels.items()}
    entries = []
    for finding in findings:
        vessel = by_file.get(finding.run, loaded.vessel)
        entries.append(finding_entry(finding, column_sources(finding.run, vessel)))
    return entries


def _with_log_first(
    verdict: str, findings: Sequence[Finding], problem: Problem, ranking: Ranking
) -> str:
    """Return the verdict, preceded by the findings that certainly concern the whole log.

    If no fit follows the recordings, it is preceded by all faults of the log.
    """
    config = problem.config.checks
    affecting = [finding for finding in findings if finding.invalidates_log(config)]
    certain = list(dict.fromkeys(finding.description for finding in affecting))
    if ranking.divergences:
        faults = [finding.description for finding in findings if finding.kind == "fault"]
        certain = list(dict.fromkeys(faults))
    if not certain:
        return verdict
    rest = f"{verdict[:1].lower()}{verdict[1:]}"
    return (
        f"{capitalize(LOG_NOT_BOAT)}: {join_words(certain)}. If the log is used unchanged: {rest}"
    )


def _fit(evaluation: Evaluation, held_out: Sequence[str]) -> FitEntry:
    """Return the errors of the free runs; those of roll and heave only where they were recorded."""
    errors = evaluation.errors
    fit: FitEntry = {
        "horizon_s": evaluation.horizon,
        "held_out": list(held_out),
        "position_rms_m": dict(errors.get("position_rms_m", {})),
        "heading_rms_rad": dict(errors.get("heading_rms_rad", {})),
    }
    if "roll_rms_rad" in errors:
        fit["roll_rms_rad"] = dict(errors["roll_rms_rad"])
    if "heave_rms_m" in errors:
        fit["heave_rms_m"] = dict(errors["heave_rms_m"])
    return fit


def _recalibration(found: Recalibration) -> RecalibrationEntry:
    """Return which refitted coefficients are adopted."""
    refitted: dict[Family, float] = {}
    for family in FAMILIES:
        if family in found.refitted:
            refitted[family] = found.refitted[family]
    return {
        "adopted": found.adopted,
        "by_free_runs": found.by_free_runs,
        "undetermined": list(found.undetermined),
        "refitted": refitted,
    }
