"""The pipeline of a diagnosis, from recordings to the answer.

Its stages are load, check, fit, select, decide, describe, plan, adopt, simulate, validate, locate
and answer. Each stage is a function from the results of earlier stages to a frozen result. It can
be called alone.
"""

import json
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis import loading
from boatsim.diagnosis.answer.compose import compose_answer
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.incomplete import (
    EFFECTS_NOT_ADDED,
    NOT_SELECTED_AGAIN,
    TERMS_NOT_SOUGHT,
    TIME_NOT_CHOSEN,
    failure_statement,
    not_tried_statement,
)
from boatsim.diagnosis.answer.results import collect_findings
from boatsim.diagnosis.answer.schema import Answer
from boatsim.diagnosis.answer.stages import Stages
from boatsim.diagnosis.checks.command_clock import (
    candidates_besides_clocks,
    check_command_clock,
    recordings_with_one_clock,
)
from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.checks.hypothesis_test import compare_reinterpretations
from boatsim.diagnosis.checks.ignored_commands import (
    check_ignored_commands,
    recordings_that_follow_commands,
)
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.checks.rest import cut_intervals_at_rest
from boatsim.diagnosis.checks.unmeasured_times import cut_unmeasured_times
from boatsim.diagnosis.checks.unrecorded_push import has_measured_input, recordings_without_pushes
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.correlation_time import select_correlation_time
from boatsim.diagnosis.covariance_inflation import inflate_covariance
from boatsim.diagnosis.divergence import cannot_follow_recordings
from boatsim.diagnosis.evaluation import Evaluation, compare_models
from boatsim.diagnosis.experiment_design import next_experiment
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.loading import LoadedRecordings, Request
from boatsim.diagnosis.locate.location import Location, locate_force
from boatsim.diagnosis.open_set.decision import Decision, decision_without_fit
from boatsim.diagnosis.open_set.decision import decide as judge_names
from boatsim.diagnosis.output_error.balanced_forces import add_balanced_forces
from boatsim.diagnosis.output_error.stage import fit_to_simulations, is_unsure
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.question import Question, compile_program, set_up_estimation_problem
from boatsim.diagnosis.recalibration import (
    decide_recalibration,
    fix_undetermined_coefficients,
    predicts_worse,
)
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.budget import BudgetSpentError
from boatsim.diagnosis.search.ranking import (
    Baseline,
    Ranking,
    fit_baseline,
    select_and_rank_candidates,
)
from boatsim.diagnosis.search.screening import largest_gain_on_top
from boatsim.diagnosis.stage_budgets import search_budget, simulation_budget
from boatsim.diagnosis.symbolic.placeholders import set_placeholder_term
from boatsim.diagnosis.symbolic.residual_description import (
    describe_residual_force as describe_residual,
)
from boatsim.diagnosis.without_fit import results_without_fit
from boatsim.files import Value
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress, report_part_of
from boatsim.recordings.table import Recording

# shares of the work, by experience, at the begin and the end of stages
LOADED = 0.05
SELECTING = (0.1, 0.7)
DESCRIBING = (0.7, 0.85)
EVALUATING = 0.9
# errors of a computation whose numbers are singular or no longer finite
NUMERICAL_ERRORS = (np.linalg.LinAlgError, FloatingPointError)


@dataclass(frozen=True)
class Selection:
    """Result of selecting effects: the ranking of candidate effects, and the estimation problem.

    The problem has the correlation time of the latent force that was chosen for these effects.
    """

    problem: Problem
    ranking: Ranking


@dataclass(frozen=True)
class Diagnosis:
    """Result of a diagnosis: content of the report, and all data to write the patched vessel."""

    findings: Findings
    vessel: Vessel
    problem: Problem
    ranking: Ranking
    remarks: tuple[str, ...]  # what was read and not used
    plan: next_experiment.Plan | None = None  # what to record next
    held_out: tuple[MappedRecording, ...] = ()

    def map_recording(
        self,
        recording: Recording,
        noise: Mapping[str, float] | None = None,
        vessel: Vessel | None = None,
    ) -> MappedRecording:
        """Map a further recording to the compiled vessel program of this diagnosis.

        Terms found by symbolic regression act on it as on the diagnosed recordings.

        Args:
            recording: A recording of the same vessel.
            noise: Sensor noise, as standard deviations by family; None: that of its notes.
            vessel: The vessel with the settings of this recording; None: that of the first one.

        Returns:
            The recording on the program of this diagnosis, with the terms found.
        """
        program = self.problem.program
        if vessel is not None:
            program = Program(vessel, program.candidates)
        mapped = map_recording(recording, program, noise, config=self.problem.config)
        mapped = infer_initial_actuator_state(
            mapped, self.problem.ambient, self.problem.config.checks
        )
        if self.ranking.description:
            for term in self.ranking.description.terms:
                set_placeholder_term(self.problem, term.term.name, term.term, [mapped])
        return mapped


def diagnose(
    runs: Sequence[Path],
    hold_out: Sequence[Path] = (),
    vessel: str | None = None,
    load: Sequence[str] = (),
    library: Sequence[str] = (),
    without: Sequence[str] = (),
    horizon: float | None = None,
    *,
    facts: Mapping[str, Value] | None = None,
    report: Report = ignore_progress,
    config: DiagnosisConfig = DEFAULT,
) -> Diagnosis:
    """Diagnose files of recordings: find the effects that the vessel model lacks, and fit them.

    Args:
        runs: Recordings to fit.
        hold_out: Recordings for validation; none: some of `runs` are held out.
        vessel: Name of the vessel; None: that of the recordings' notes.
        load: Names of load conditions.
        library: Further candidate effects, by name or file.
        without: Candidate effects that are excluded.
        horizon: Length of free runs [s]; None: the usual one.
        facts: Facts of all recordings whose notes do not state them.
        report: Receives the progress.
        config: Settings of the diagnosis.

    Returns:
        The diagnosis with its identified effects and everything that the report shows.

    Raises:
        BadInput: A file, a name or a value cannot be used.
    """
    request = Request(runs, hold_out, vessel, load, library, without, horizon, facts or {})
    loaded = loading.load_recordings(request, report_part_of(report, 0.0, LOADED), config)
    return diagnose_loaded(loaded, report_part_of(report, LOADED, 1.0), config)


def diagnose_loaded(
    loaded: LoadedRecordings, report: Report = ignore_progress, config: DiagnosisConfig = DEFAULT
) -> Diagnosis:
    """Diagnose recordings that have been read: find and fit effects that the vessel model lacks.

    Args:
        loaded: Recordings, divided into fitted and held-out ones.
        report: Receives the progress.
        config: Settings of the diagnosis.

    Returns:
        The diagnosis with its identified effects and everything that the report shows.

    Raises:
        BadInput: The recordings cannot be used.
    """
    loaded = cut_intervals_at_rest(cut_unmeasured_times(loaded, config), config)
    question = set_up_estimation_problem(loaded, config)
    given = loaded.findings
    report("compiling, or loading what was compiled before")
    compile_program(question.problem)
    begin = time.perf_counter()
    with threadpool_limits(1, "blas"):
        report("comparing what the columns may mean", SELECTING[0] / 2)
        findings = check_recordings(loaded, question)
        selected, found, failures = None, None, list[str]()
        with suppress(*NUMERICAL_ERRORS):  # the vessel model diverges
            if has_measured_input(loaded.vessel):
                base = fit_baseline_models(question).recalibrated
                loaded, question = cut_unrecorded_pushes(loaded, question, base)
                findings = (*findings, *loaded.findings[len(given) :])
            selected = _fit_and_select(loaded, question, findings, report)
        if selected is not None:
            try:
                found = _complete(selected, begin, report)
            except NUMERICAL_ERRORS as error:
                failures.append(failure_statement("the validation of the selected effects", error))
        if found is None or not _is_finite(found.findings.answer):
            report("locating where the model cannot follow", EVALUATING)
            found = _diagnose_without_fit(loaded, question, findings, failures, begin)
    return found


class _Selected(NamedTuple):
    """Results of the stages up to the decision, which later stages complete."""

    loaded: LoadedRecordings
    question: Question
    findings: Sequence[Finding]
    decision: Decision


def _fit_and_select(
    loaded: LoadedRecordings, question: Question, findings: Sequence[Finding], report: Report
) -> _Selected | None:
    """Fit, select effects and decide; None if the vessel's own fit does not follow."""
    base = fit_baseline_models(question)
    if cannot_follow_recordings(question.problem, base.recalibrated):
        return None
    ignored = find_ignored_commands(loaded, question, base)
    if ignored:
        findings = (*findings, *ignored)
        loaded = recordings_that_follow_commands(loaded, question.problem, ignored)
        question = _set_up_again(loaded, question)
        base = fit_baseline_models(question)
    other_clocks = find_other_clocks(loaded, question, base)
    if other_clocks:
        findings = (*findings, *other_clocks)
        loaded = recordings_with_one_clock(loaded, other_clocks)
        question = _set_up_again(loaded, question)
        names = candidates_besides_clocks(question.candidates, loaded, other_clocks)
        question = replace(question, candidates=names)
        base = fit_baseline_models(question)
    selection = select_candidates(question, base, loaded, report_part_of(report, *SELECTING))
    given = loaded.findings
    loaded, kept = cut_unrecorded_pushes(loaded, question, selection.ranking.best)
    if kept is not question:  # smaller pushes stand out beside a better model
        question, findings = kept, (*findings, *loaded.findings[len(given) :])
        report("selecting again without the pushes", SELECTING[1])
        selection = select_candidates(question, fit_baseline_models(question), loaded)
    report_last = report_part_of(report, SELECTING[1], SELECTING[1])
    selection = add_forces_that_balance(question, selection, report_last)
    decision = decide_causes(question, selection)
    loaded, question, decision = try_last_candidates(loaded, question, decision, report_last)
    return _Selected(loaded, question, findings, decision)


def _complete(selected: _Selected, begin: float, report: Report) -> Diagnosis:
    """Run all stages after the decision.

    The answer stays complete without a formula and without a next experiment: if one of these
    stages fails, the answer states the reason.
    """
    loaded, question, findings, decision = selected
    decision = keep_undetermined_coefficients(question, decision)
    ranking, next_plan, failures = decision.ranking, None, list[str]()
    try:
        progress = report_part_of(report, *DESCRIBING)
        ranking = describe_unexplained_force(question, decision, progress)
    except NUMERICAL_ERRORS as error:
        failures.append(failure_statement("the description of the unexplained force", error))
    report("planning what to record next", DESCRIBING[1])
    try:
        next_plan = plan_next_experiment(decision, ranking)
    except NUMERICAL_ERRORS as error:
        failures.append(failure_statement("the search for the next experiment", error))
    ranking = _with_skipped(ranking, *failures)
    ranking = adopt_refitted_coefficients(question, decision, ranking)
    report("fitting simulations", DESCRIBING[1])
    try:
        ranking = improve_simulations(question, decision, ranking)
    except NUMERICAL_ERRORS as error:
        ranking = _with_skipped(ranking, failure_statement("the fit to simulations", error))
    report("free runs", EVALUATING)
    evaluation = validate_on_held_out(question, decision, ranking)
    location = locate_missing_force(decision, ranking, evaluation)
    stages = Stages(decision, ranking, evaluation, location, next_plan)
    return _compose(loaded, question, findings, stages, begin)


def _diagnose_without_fit(
    loaded: LoadedRecordings,
    question: Question,
    findings: Sequence[Finding],
    failures: Sequence[str],
    begin: float,
) -> Diagnosis:
    """Return the diagnosis of recordings that no fit follows. Raises BadInput."""
    where = loaded.fitted[0].origin
    ranking, evaluation = results_without_fit(question.problem, question.held_out, where)
    ranking = _with_skipped(ranking, *failures)
    decision = decision_without_fit(question.problem, ranking)
    location = locate_missing_force(decision, ranking, evaluation)
    stages = Stages(decision, ranking, evaluation, location)
    return _compose(loaded, question, findings, stages, begin)


def _compose(
    loaded: LoadedRecordings,
    question: Question,
    findings: Sequence[Finding],
    stages: Stages,
    begin: float,
) -> Diagnosis:
    """Compose the answer and what the report shows."""
    seconds = time.perf_counter() - begin
    answer = compose_answer(loaded, question, findings, stages, seconds)
    return Diagnosis(
        findings=collect_findings(answer, loaded, question, stages),
        vessel=loaded.vessel,
        problem=stages.decision.problem,
        ranking=stages.ranking,
        remarks=loaded.remarks,
        plan=stages.plan,
        held_out=tuple(question.held_out),
    )


def _is_finite(answer: Answer) -> bool:
    """Whether all numbers of an answer are finite."""
    try:
        json.dumps(answer, allow_nan=False)
    except ValueError:
        return False
    return True


def _set_up_again(loaded: LoadedRecordings, question: Question) -> Question:
    """The estimation problem of changed recordings or candidates; the count of work goes on."""
    problem = question.problem
    return set_up_estimation_problem(loaded, problem.config, problem.work_count)


def check_recordings(loaded: LoadedRecordings, question: Question) -> tuple[Finding, ...]:
    """Return all findings of the quality checks of the recordings.

    Findings of single files are completed by faults that only a comparison with the vessel model
    shows, such as other axes or a reversed heading.

    Args:
        loaded: Recordings with the findings of single files.
        question: The same recordings, mapped.

    Returns:
        The findings, each with the file of its recording.
    """
    problem = question.problem
    compared = compare_reinterpretations(loaded.fitted, question.map_recording, problem)
    first = loaded.fitted[0]
    whole = first.origin
    findings = []
    for finding in (*loaded.findings, *compared):
        findings.append(finding if finding.run else replace(finding, run=whole))
    return tuple(findings)


def cut_unrecorded_pushes(
    loaded: LoadedRecordings, question: Question, found: Fit
) -> tuple[LoadedRecordings, Question]:
    """Cut short forces that no channel records out of recordings in which forces were measured.

    Args:
        loaded: Recordings.
        question: The same recordings, mapped.
        found: Fit of the vessel, whose unexplained force shows the pushes.

    Returns:
        The recordings without the rows of the pushes, and the same mapped; the arguments if there
        are none.
    """
    kept = recordings_without_pushes(loaded, question.problem, question.held_out, found)
    if kept is None:
        return loaded, question
    return kept, _set_up_again(kept, question)


def find_ignored_commands(
    loaded: LoadedRecordings, question: Question, base: Baseline
) -> list[Finding]:
    """Return findings about times in which the motion shows nothing of the commands.

    Args:
        loaded: The recordings.
        question: The same recordings, mapped.
        base: Fits of the vessel without candidate effects.

    Returns:
        Findings of kind "drive", one for each recording that has such times.
    """
    names = [one.origin for one in (*loaded.fitted, *loaded.held_out)]
    recordings = (*question.problem.recordings, *question.held_out)
    return check_ignored_commands(question.problem, base.nominal, recordings, names)


def find_other_clocks(
    loaded: LoadedRecordings, question: Question, base: Baseline
) -> list[Finding]:
    """Return findings about recordings whose commands have another clock than those of the others.

    Args:
        loaded: The recordings.
        question: The same recordings, mapped.
        base: Fits of the vessel without candidate effects.

    Returns:
        Findings of kind "mended", because the diagnosis corrects these recordings.
    """
    names = [one.origin for one in (*loaded.fitted, *loaded.held_out)]
    recordings = (*question.problem.recordings, *question.held_out)
    found = check_command_clock(question.problem, base.recalibrated, recordings, names)
    return [replace(finding, kind="mended") for finding in found]


def fit_baseline_models(question: Question) -> Baseline:
    """Fit the vessel model without candidate effects: as specified, and with refitted coefficients.

    Args:
        question: Mapped recordings and priors.

    Returns:
        Both fits; in the first one only the noise levels are fitted.
    """
    return fit_baseline(question.problem)


def select_candidates(
    question: Question,
    base: Baseline,
    loaded: LoadedRecordings,
    report: Report = ignore_progress,
    work: int | None = None,
) -> Selection:
    """Select the candidate effects that the recordings require.

    If the notes do not specify the correlation time of the latent (unmodelled) force, it is chosen
    for the effects that were selected, and they are selected again. Both selections share one
    budget of work. If it is spent, the last finished selection is returned.

    Args:
        question: Mapped recordings, priors and candidates.
        base: Fits of the vessel without candidate effects.
        loaded: The recordings with their notes.
        report: Receives the progress.
        work: Work of both selections [steps x dof]; None: `select.budget`.

    Returns:
        The ranking with the selected effects, and the problem with the correlation time.
    """
    problem, candidates, held_out = question.problem, question.candidates, question.held_out
    budget = search_budget(problem, work)
    ranking = select_and_rank_candidates(
        problem, candidates, held_out, report=report, base=base, budget=budget
    )
    if "time_constant_s" in loaded.fitted[0].notes.ambient:
        return Selection(problem, ranking)
    least = problem.config.select.again_share * budget.used_work
    if budget.is_spent or budget.remaining_work < least:
        return Selection(problem, _with_skipped(ranking, TIME_NOT_CHOSEN))
    report("choosing the correlation time of the latent force", 1.0)
    again = select_correlation_time(problem, ranking.best, budget)
    if budget.is_spent:
        return Selection(problem, _with_skipped(ranking, TIME_NOT_CHOSEN))
    if again is problem:
        return Selection(problem, ranking)
    report("selecting again with that correlation time", 1.0)
    rest = budget.remaining_budget()
    try:
        return Selection(
            again,
            select_and_rank_candidates(again, candidates, held_out, ranking.best, budget=rest),
        )
    except BudgetSpentError:  # the finished search is the better one
        return Selection(problem, _with_skipped(ranking, NOT_SELECTED_AGAIN))


def _with_skipped(ranking: Ranking, *statements: str) -> Ranking:
    """A ranking with further statements of what was not tried."""
    return replace(ranking, skipped=(*ranking.skipped, *statements))


def decide_causes(question: Question, selection: Selection) -> Decision:
    """Decide which selected effects are stated as causes, with the probability that each is true.

    Args:
        question: Candidates and held-out recordings.
        selection: Selected effects.

    Returns:
        The decided ranking, with the statistics from which the probabilities follow.
    """
    problem, ranking = selection.problem, selection.ranking
    return judge_names(problem, ranking, question.held_out, len(question.candidates))


def try_last_candidates(
    loaded: LoadedRecordings,
    question: Question,
    decision: Decision,
    report: Report = ignore_progress,
) -> tuple[LoadedRecordings, Question, Decision]:
    """Select again with candidates that are tried last, where these may explain what is left.

    They are tried where a force stays unexplained, or where an effect was selected that they are
    confounded with, and if one of them gains `select.last_gain` on top of what was selected, or of
    the vessel alone. Where the first search has used its budget, one of them must gain at least
    `select.last_share` of what that search gained: the second one does half of its work.

    Args:
        loaded: Recordings.
        question: The same recordings, mapped, with the usual candidates.
        decision: Selected effects with their probability.
        report: Receives the progress.

    Returns:
        The recordings with these candidates requested, the question with them and its decision, if
        one of them was selected and the model gains `select.last_gain`; else the arguments. Where
        no work is left to select again, the decision states it.
    """
    ranking, config = decision.ranking, question.problem.config
    last = []
    for name, rivals in question.library.tried_last.items():
        confused = any(other in ranking.best.effects for other in rivals)
        if name not in loaded.without and (ranking.has_unexplained_force_or_cause or confused):
            last.append(name)
    if not last:
        return loaded, question, decision
    wider = replace(loaded, library=(*loaded.library, *last))
    again = _set_up_again(wider, question)
    report(f"trying {', '.join(last)}")
    compile_program(again.problem)
    base = fit_baseline_models(again)
    tested = [name for name in again.candidates if name not in question.candidates]
    on_top = largest_gain_on_top(again.problem, ranking.best, tested)
    alone = on_top
    if ranking.has_unexplained_force_or_cause:  # stand-ins may have taken up its force
        alone = largest_gain_on_top(again.problem, base.recalibrated, tested)
    if max(on_top, alone) < config.select.last_gain:
        return loaded, question, decision
    ended_early = bool(ranking.skipped)
    too_little = ended_early and alone < config.select.last_share * _gain(ranking)
    if too_little or search_budget(again.problem, config.select.last_budget).is_spent:
        ranking = _with_skipped(ranking, not_tried_statement(last))
        return loaded, question, replace(decision, ranking=ranking)
    selection = select_candidates(again, base, wider, report, config.select.last_budget)
    other = decide_causes(again, add_forces_that_balance(again, selection, report))
    selected = any(name in other.ranking.best.effects for name in tested)
    if selected and _gain(other.ranking) - _gain(ranking) > config.select.last_gain:
        return wider, again, other
    return loaded, question, decision


def _gain(ranking: Ranking) -> float:
    """Evidence that the selected effects gain over the recalibrated vessel [nats]."""
    return ranking.best.evidence - ranking.recalibrated.evidence


def keep_undetermined_coefficients(question: Question, decision: Decision) -> Decision:
    """Give coefficients that the recordings do not determine the value of the vessel file.

    The selection has compared hypotheses with all coefficients free, so that its evidence and the
    probabilities stay valid. Only a vessel with effects is changed here; without effects the
    patched vessel is the recalibrated one (`adopt_refitted_coefficients`).

    Args:
        question: Held-out recordings.
        decision: Selected effects with their probability.
    """
    ranking = decision.ranking
    if not ranking.best.effects:
        return decision
    best = fix_undetermined_coefficients(decision.problem, ranking.best, question.held_out)
    return replace(decision, ranking=replace(ranking, best=best))


def add_forces_that_balance(
    question: Question, selection: Selection, report: Report = ignore_progress
) -> Selection:
    """Add a spring to the ground with the force that it balances, where recordings require both.

    Args:
        question: Candidates and held-out recordings.
        selection: Selected effects.
        report: Receives the progress.
    """
    problem, ranking = selection.problem, selection.ranking
    found = add_balanced_forces(problem, ranking, question.candidates, question.held_out, report)
    return replace(selection, ranking=found)


def describe_unexplained_force(
    question: Question, decision: Decision, report: Report = ignore_progress
) -> Ranking:
    """Describe a force that no candidate effect explains by a formula, with symbolic regression.

    Identified effects that the formula replaces are removed.

    Args:
        question: Held-out recordings.
        decision: Selected effects with their probability.
        report: Receives the progress.

    Returns:
        The ranking with the formula; the same ranking if no force remains unexplained.
    """
    problem, ranking = decision.problem, decision.ranking
    if not ranking.has_unexplained_force_or_cause:
        return ranking
    best, recalibrated = ranking.best, ranking.recalibrated
    found = describe_residual(problem, best, recalibrated, question.held_out, report)
    if found is None:
        return ranking
    if found.fit is not best:
        best = inflate_covariance(problem, found.fit)
    terms = []
    for term in found.terms:
        if term.carries:
            term = replace(term, sd=best.value(term.term.name, "coefficient")[1])
        terms.append(term)
    effects = found.fit.effects
    if not found.complete:
        ranking = _with_skipped(ranking, TERMS_NOT_SOUGHT)
    return replace(
        ranking,
        best=best,
        named=tuple(one for one in ranking.named if one.name in effects),
        doubtful=tuple(one for one in ranking.doubtful if one.name in effects),
        description=replace(found, terms=tuple(terms)),
    )


def adopt_refitted_coefficients(
    question: Question, decision: Decision, ranking: Ranking
) -> Ranking:
    """Decide which refitted coefficients replace those of the vessel file.

    They are adopted if the recordings determine them, and if they do not make simulations of
    held-out recordings worse. The selection has compared hypotheses with all coefficients free, so
    that its evidence stays valid. Without effects the patched vessel is the recalibrated one, also
    if its effects are only possible and make simulations of held-out recordings worse.

    Args:
        question: Held-out recordings.
        decision: The problem with its correlation time.
        ranking: Selected and described effects.

    Returns:
        The ranking with the adopted coefficients.
    """
    problem, best = decision.problem, ranking.best
    refitted = ranking.recalibrated
    if not best.effects:
        refitted = best
    found = decide_recalibration(
        problem, ranking.nominal, refitted, question.held_out, is_answer=not best.effects
    )
    is_only_possible = not (ranking.named or ranking.described_terms)
    if not best.effects or (
        is_only_possible and predicts_worse(problem, best, found.fit, question.held_out)
    ):
        best = found.fit
    return replace(ranking, best=best, recalibrated=found.fit, recalibration=found)


def improve_simulations(question: Question, decision: Decision, ranking: Ranking) -> Ranking:
    """Fit the vessels to free runs, and add effects that improve these, where a force remains.

    Args:
        question: Candidates and held-out recordings.
        decision: The problem with its correlation time.
        ranking: Selected and described effects, with the adopted coefficients.
    """
    problem = decision.problem
    unsure = [one for one in ranking.named if is_unsure(problem, one.probability)]
    budget = simulation_budget(problem, has_unsure=bool(unsure))
    found = fit_to_simulations(problem, ranking, question.candidates, question.held_out, budget)
    return _with_skipped(found, EFFECTS_NOT_ADDED) if budget.is_spent else found


def validate_on_held_out(question: Question, decision: Decision, ranking: Ranking) -> Evaluation:
    """Compare the nominal, the recalibrated and the patched vessel model over held-out recordings.

    Args:
        question: Held-out recordings.
        decision: The problem with its correlation time.
        ranking: Selected and described effects.

    Returns:
        Free runs (simulations with the recorded commands alone), their errors, and the forces that
        each model leaves unexplained.
    """
    return compare_models(decision.problem, ranking, question.held_out)


def locate_missing_force(decision: Decision, ranking: Ranking, evaluation: Evaluation) -> Location:
    """Find along which axes, when and under which conditions the vessel model lacks a force.

    Conditions are not tested where fits diverge, because the linear test would not hold.

    Args:
        decision: The problem with its correlation time.
        ranking: Selected and described effects.
        evaluation: Forces that the vessel models leave unexplained.
    """
    return locate_force(
        decision.problem,
        ranking.recalibrated,
        evaluation.missing,
        evaluation.remaining,
        with_regions=not ranking.divergences,
    )


def plan_next_experiment(decision: Decision, ranking: Ranking) -> next_experiment.Plan | None:
    """Return the manoeuvre that would best decide what the diagnosis leaves open.

    Args:
        decision: The problem, and the selection before the description.
        ranking: Selected and described effects.

    Returns:
        The manoeuvre with its expected gain of evidence; None if none would add enough.
    """
    before = replace(decision.ranking, named=ranking.named)
    question = next_experiment.undecided_hypotheses(before, decision.problem.config)
    return next_experiment.best_plan(decision.problem, *question)
