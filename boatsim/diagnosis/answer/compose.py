"""Composes the answer of a diagnosis, the content of diagnosis.json."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from boatsim.control.base import wrap
from boatsim.diagnosis.answer.assumptions import assumptions_entry, excluded_candidates
from boatsim.diagnosis.answer.confirmation import effect_error_entry, reason_unconfirmed
from boatsim.diagnosis.answer.described_terms import described_entries
from boatsim.diagnosis.answer.effect_groups import classify_effects
from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.incomplete import incomplete_sentence
from boatsim.diagnosis.answer.log_entry import column_sources, finding_entry
from boatsim.diagnosis.answer.parameters import parameter_key, reported_sd
from boatsim.diagnosis.answer.schema import (
    Acting,
    Answer,
    CandidateEntry,
    EffectEntry,
    Family,
    FitEntry,
    LogEntry,
    ParameterEntry,
    PossibleEntry,
    RecalibrationEntry,
    StructureEntry,
    UnknownEntry,
    WhereEntry,
)
from boatsim.diagnosis.answer.signs import cause_statistics_entry, reason_for_doubt
from boatsim.diagnosis.answer.verdict import verdict_sentences
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT, Finding
from boatsim.diagnosis.config import AnswerConfig, settings_by_name
from boatsim.diagnosis.evaluation import Evaluation
from boatsim.diagnosis.experiment_design import next_experiment
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate import missing_force as locate
from boatsim.diagnosis.locate.regions import find_missing_force_conditions
from boatsim.diagnosis.locate.residual_structure import Structure
from boatsim.diagnosis.open_set.decision import Decision
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.question import Question
from boatsim.diagnosis.recalibration import Recalibration
from boatsim.diagnosis.search.pruning import IdentifiedEffect
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import ChannelEffect, Effect
from boatsim.physics.groups import group_of, without_group
from boatsim.physics.vessel import Vessel
from boatsim.version import version
from boatsim.view.formatting import capitalize, join_words, sentence_in_per_cent

NEXT_SCENARIO = "next.toml"  # scenario of the next experiment, in the folder of the answer


def compose_answer(
    loaded: LoadedRecordings,
    question: Question,
    findings: Sequence[Finding],
    decision: Decision,
    ranking: Ranking,
    evaluation: Evaluation,
    plan: next_experiment.Plan | None,
    seconds: float,
) -> Answer:
    """Compose the content of diagnosis.json, the answer of a diagnosis, from all its results.

    Args:
        loaded: Recordings and vessels.
        question: Candidates and held-out recordings.
        findings: Findings of the log quality checks.
        decision: Signs and probabilities of the names, and the problem with its correlation time.
        ranking: The decided selection, with its description.
        evaluation: Free runs and unexplained forces.
        plan: The next experiment; None if no manoeuvre would add evidence.
        seconds: Duration of the diagnosis [s].
    """
    problem = decision.problem
    vessel = problem.program.vessel
    entries = {}
    for identified in ranking.named:
        entries[identified.name] = _effect(problem, ranking.best, identified, decision)
    groups = classify_effects(problem, ranking.best, entries)
    possible = groups.also_possible
    for identified in ranking.doubtful:
        possible.append(_possible(problem, ranking.best, identified, decision))
    formulas = described_entries(ranking.description, vessel)
    tested = () if ranking.divergences else question.candidates
    upper, lower = dict[str, dict[str, float]](), dict[str, dict[str, float]]()
    for name, fitted in ranking.last.items():
        upper[name_without_prefixes(name)], lower[name_without_prefixes(name)] = _limits(
            problem, fitted, name
        )
    answer: Answer = {
        "verdict": _verdict(ranking, groups.effects, bool(formulas)),
        "sentence": "",
        "seconds": round(seconds, 3),
        "version": version(),
        "effects": groups.effects,
        "refined": groups.refined,
        "also_possible": possible,
        "unknown": _unknown(problem, ranking, evaluation),
        "described": formulas,
        "candidates": candidate_entries(ranking),
        "upper_limits": upper,
        "lower_limits": {name: found for name, found in lower.items() if found},
        "where": _where(problem, ranking, evaluation),
        "fit": _fit(evaluation, [mapped.name for mapped in question.held_out]),
        "next_experiment": next_experiment.plan_entry(plan, NEXT_SCENARIO),
        "patch": "patched.toml",
        "mean_left": dict(evaluation.mean_force),
        "tried": sorted({name_without_prefixes(without_group(name)) for name in tested}),
        "left_out": excluded_candidates(question),
        "skipped": list(ranking.skipped),
        "facts": dict(problem.recordings[0].facts),
        "rules": assumptions_entry(problem, len(tested)),
        "log": _log(loaded, findings),
        "signs": cause_statistics_entry(decision),
        "config": settings_by_name(problem.config),
    }
    if ranking.recalibration is not None:
        answer["recalibration"] = _recalibration(ranking.recalibration)
    verdict = verdict_sentences(answer, effect_meanings(problem.candidates.values(), vessel))
    verdict = f"{verdict} {incomplete_sentence(ranking.skipped)}".rstrip()
    answer["sentence"] = _with_log_first(verdict, findings, problem, ranking)
    return answer


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


def _unknown(problem: Problem, ranking: Ranking, evaluation: Evaluation) -> UnknownEntry:
    entry: UnknownEntry = {
        "flag": ranking.has_unexplained_force_or_cause,
        "gain_nats": round(ranking.left_over, 3),
        "told_from_nats": round(ranking.told_from, 3),
    }
    if ranking.has_unexplained_force_or_cause:
        entry["rest"] = locate.missing_force_rms(problem, evaluation.remaining)
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


def _where(problem: Problem, ranking: Ranking, evaluation: Evaluation) -> WhereEntry:
    """Return the axes, intervals and regions in which a force is missing."""
    entry: WhereEntry = {
        "axes": locate.missing_force_rms(problem, evaluation.missing),
        "intervals": [],
        "region": [],
    }
    for i in locate.significant_intervals(problem, evaluation.missing):
        entry["intervals"].append(
            {"run": i.run, "from_s": i.from_s, "to_s": i.to_s, "axis": i.axis}
        )
    if ranking.divergences:  # a linear test for regions would not hold
        return entry
    for r in find_missing_force_conditions(problem, ranking.recalibrated):
        entry["region"].append(
            {"variable": r.variable, "statement": r.statement, "p_value": r.p_value}
        )
    return entry


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


def effect_meanings(candidates: Iterable[Effect], vessel: Vessel) -> dict[str, str]:
    """Return the meaning in words of candidate effects and of their parameters.

    Keys are the name of the effect, and "effect.parameter".

    Args:
        candidates: Candidate effects.
        vessel: Vessel to whose numbers the values of some parameters are relative.
    """
    found, parameters = dict[str, str](), dict[str, str]()
    for effect in candidates:
        name, kind = name_without_prefixes(effect.name), type(effect)
        found[name] = kind.words
        for key, param in kind.params().items():
            if param.fit:
                parameters[f"{name}.{parameter_key(key, param.unit)}"] = param.words
    for effect in candidates:
        for key, (_, words) in effect.identifiable_ratios(vessel).items():
            parameters[f"{name_without_prefixes(effect.name)}.{key}"] = words
    return found | parameters


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
        "undetermined": list(found.undetermined),
        "refitted": refitted,
    }


def _effect(
    problem: Problem, best: Fit, named: IdentifiedEffect, decision: Decision
) -> EffectEntry:
    """Return the entry of an identified effect."""
    judged = decision.judgement_of_effect(named.name)
    effect = problem.candidates[named.name]
    kind = type(effect)
    acting: Acting = {}
    if effect.on:
        acting["on"] = list(effect.on)
    if group := group_of(named.name):
        acting["group"] = group
    return {
        "name": name_without_prefixes(named.name),
        **acting,
        "kind": kind.kind,
        "probability": round(named.probability, 4),
        "gain_nats": round(named.gain, 2),
        "words": _words(best, effect),
        "tied_with": list(map(name_without_prefixes, named.tied_with)),
        "parameters": _parameters(problem, best, effect) | _ratios(problem, best, effect),
        "alone": effect_error_entry(judged.alone),
        "confirmed": judged.outcome == "confirmed",
    }


def _possible(
    problem: Problem, best: Fit, doubtful: IdentifiedEffect, decision: Decision
) -> PossibleEntry:
    """Return the entry of an effect that is probably a stand-in for another cause."""
    effect = problem.candidates[doubtful.name]
    judged = decision.judgement_of_effect(doubtful.name)
    why = reason_for_doubt(judged.signs, decision.log, problem.config.decide)
    if judged.outcome == "unconfirmed":
        why = reason_unconfirmed(judged)
    return {
        "name": name_without_prefixes(doubtful.name),
        "probability": round(doubtful.probability, 4),
        "gain_nats": round(doubtful.gain, 2),
        "words": _words(best, effect),
        "why": why,
        "in_patch": True,
        "parameters": _parameters(problem, best, effect),
        "alone": effect_error_entry(judged.alone),
        "confirmed": judged.outcome == "confirmed",
    }


def _parameters(problem: Problem, best: Fit, effect: Effect) -> dict[str, ParameterEntry]:
    """Return the entries of the fitted parameters of an effect by their keys."""
    params, found = type(effect).params(), {}
    for name in _fitted_parameters(best, effect):
        key = parameter_key(name, params[name].unit)
        found[key] = _parameter(best, effect, name, problem.config.answer)
    return found


def _fitted_parameters(best: Fit, effect: Effect) -> dict[str, FreeParameter]:
    """Return the fitted parameters of an effect by name."""
    return {f.name: f for f in best.free if f.effect == effect.name and not f.relative}


def _ratios(problem: Problem, best: Fit, effect: Effect) -> dict[str, ParameterEntry]:
    """Return the ratios of parameters, where the recordings determine only ratios."""
    vessel, config = problem.program.vessel, problem.config.answer
    own = _fitted_parameters(best, effect)
    fitted = {name: best.value(effect.name, name)[0] for name in own}

    def ratios_after_step(name: str, step: float) -> Mapping[str, tuple[float, str]]:
        value = np.clip(fitted[name] + step, own[name].low, own[name].high)
        return effect.with_values(fitted | {name: float(value)}).identifiable_ratios(vessel)

    found = effect.with_values(fitted).identifiable_ratios(vessel)
    variance = dict.fromkeys(found, 0.0)
    if found:
        for name in fitted:
            sd = _parameter(best, effect, name, config)["sd"]
            low, high = ratios_after_step(name, -0.5 * sd), ratios_after_step(name, 0.5 * sd)
            for key in variance:
                variance[key] += (high[key][0] - low[key][0]) ** 2
    entries: dict[str, ParameterEntry] = {}
    for key, (value, _) in found.items():
        entries[key] = {"value": value, "sd": float(np.sqrt(variance[key])), "unit": ""}
    return entries


def _words(best: Fit, effect: Effect) -> str:
    """Return the meaning of an effect, or of its opposite where its factor is above 1."""
    kind = type(effect)
    words, own = kind.words, list(_fitted_parameters(best, effect))
    if own and kind.words_above:
        inactive = kind.params()[own[0]].inactive_value
        if best.value(effect.name, own[0])[0] > inactive:
            words = kind.words_above
    if isinstance(effect, ChannelEffect) and effect.other_side:
        where = "already in the command"
        if kind.stage < 0:
            where = "in the actuator and not in its command"
        words = f"{words}, {where}"
    if kind.once_per and effect.on:
        words = f"{words}: {', '.join(effect.on)}"
    if group := group_of(effect.name):
        words = f"in group {group}, {words}"
    return words


def _parameter(best: Fit, effect: Effect, name: str, config: AnswerConfig) -> ParameterEntry:
    """Return value, sd and unit of a fitted parameter; angles are within half a turn."""
    param = type(effect).params()[name]
    value, _ = best.value(effect.name, name)
    entry: ParameterEntry = {
        "value": value,
        "sd": reported_sd(best, effect, name, config),
        "unit": param.unit,
    }
    if param.unit == "rad":
        entry["value"] = wrap(value)
    free = _fitted_parameters(best, effect)[name]
    for end in (free.low, free.high):
        if end != free.mean and abs(value - end) <= config.at_bound * abs(end):
            entry["at_bound"] = True
    sentence = sentence_in_per_cent(param.in_per_cent, value, entry["sd"], param.inactive_value)
    if sentence and type(effect).once_per and effect.on:
        sentence = f"{', '.join(effect.on)}: {sentence}"
    if sentence and group_of(effect.name):
        sentence = f"in group {group_of(effect.name)}, {sentence}; {_others(best, effect, name)}"
    if sentence:
        entry["statement"] = sentence
    return entry


def _others(best: Fit, effect: Effect, name: str) -> str:
    """The value of a ratio in the groups that an effect does not concern, in words."""
    param = type(effect).params()[name]
    common = without_group(effect.name)
    value = param.inactive_value
    if common in best.effects:
        value = best.value(common, name)[0]
    if param.how == "scales":
        return "this is relative to the others"
    if value == 0.0:
        return "the others show none of it"
    return f"in the others it is {100.0 * value:.3g} %"


def candidate_entries(ranking: Ranking) -> list[CandidateEntry]:
    """Return each candidate alone, best first, with its probability against the others and none.

    A candidate with which the simulation diverges at every starting point has no evidence, and is
    omitted.

    Args:
        ranking: The selection, with the evidence of each candidate.
    """
    finite = {name: gain for name, gain in ranking.first.items() if np.isfinite(gain)}
    names = sorted(finite, key=lambda n: -finite[n])
    gains = [0.0]
    for name in names:
        gains.append(ranking.first[name])
    weights = np.exp(np.array(gains) - np.max(gains))
    weights /= weights.sum()
    # an effect that was tested in two places is listed with the larger gain
    found: dict[str, CandidateEntry] = {}
    for name, gain, weight in zip(names, gains[1:], weights[1:], strict=True):
        entry: CandidateEntry = {
            "name": name_without_prefixes(name),
            "gain_nats": round(float(gain), 2),
            "probability": round(float(weight), 4),
        }
        found.setdefault(name_without_prefixes(name), entry)
    return list(found.values())


def _limits(problem: Problem, fitted: Fit, name: str) -> tuple[dict[str, float], dict[str, float]]:
    """Return limits (95 %) of the parameters of an effect that was not found.

    They are upper limits of the distance from zero effect, and lower limits of parameters that are
    limits themselves, such as that of a rate.
    """
    config = problem.config.answer
    kind = type(problem.candidates[name])
    params = kind.params()
    upper, lower = dict[str, float](), dict[str, float]()
    for f in fitted.free:
        if f.effect != name or f.relative or f.name not in (kind.strength or params):
            continue
        value, sd = fitted.value(name, f.name)
        if sd >= config.limit_share * f.sd:
            continue
        key, margin = parameter_key(f.name, params[f.name].unit), config.limit_quantile * sd
        if f.name not in kind.limits:
            upper[key] = float(f"{abs(value - f.mean) + margin:.3g}")
        elif value > margin:
            lower[key] = float(f"{value - margin:.3g}")
    return upper, lower
