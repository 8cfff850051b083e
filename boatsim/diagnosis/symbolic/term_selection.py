"""Selection of the terms of a formula by evidence.

All terms are scored by their approximate evidence, the best of them are fitted with the filter, and
the parameters of the chosen term, such as its times, are refined.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, fit, gauss_newton, remove_effect
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import required_gain
from boatsim.diagnosis.stage_budgets import description_budget
from boatsim.diagnosis.symbolic.grammar import candidate_terms, term_variants
from boatsim.diagnosis.symbolic.placeholders import set_placeholder_term, unused_placeholder
from boatsim.diagnosis.symbolic.term_forces import FittedRecording, fitted_recordings
from boatsim.diagnosis.symbolic.term_scores import ScoredTerm, score_terms, varying_signals
from boatsim.physics.described_laws import SymbolicTerm
from boatsim.progress import Report, ignore_progress

DESCRIBING = "describing the unexplained force"
Recordings = Sequence[MappedRecording]
Family = tuple[object, ...]  # what terms share that differ in their times or lengths only


@dataclass(frozen=True)
class Formula:
    """A fit of the vessel model with the terms that symbolic regression has added to it.

    Attributes:
        problem: The estimation problem, with the priors of the terms' coefficients.
        fit: Fit of the vessel model.
        terms: Terms by the name of their placeholder effect, in the order in which they were added.
        complete: Whether further terms were sought until none gained enough, or there were enough.
    """

    problem: Problem
    fit: Fit
    terms: dict[str, SymbolicTerm]
    complete: bool = True


@dataclass(frozen=True)
class _Extension:
    """A formula with one more term: its placeholder, the fit, and the term as scored.

    The problem has the prior of the term's coefficient.
    """

    problem: Problem
    placeholder: str
    fit: Fit
    scored: ScoredTerm


def select_terms(
    problem: Problem, best: Fit, held_out: Recordings, report: Report = ignore_progress
) -> Formula:
    """Build a formula for an unexplained force: add symbolic terms one by one, by evidence.

    The selection ends when no term gains enough evidence, or when its budget of work does not
    suffice for as much work as the term before took. If the budget is spent from the start, the
    best term by approximate evidence is the only one, with the constants of the grammar, and no
    effect is removed for it.

    Args:
        problem: The estimation problem.
        best: The fit of the identified effects.
        held_out: Held-out recordings, whose placeholder effects receive the terms as well.
        report: Receives the progress.

    Returns:
        The formula; it has no terms if none has enough evidence.
    """
    report(DESCRIBING)
    config = problem.config
    formula = Formula(problem, best, {})
    budget = description_budget(problem)
    everywhere, refused = [*problem.recordings, *held_out], set[Family]()
    if budget.is_spent:
        return _first_term(formula, everywhere)
    work_of_term = 0
    while len(formula.terms) < config.describe.most_terms:
        if budget.remaining_work <= work_of_term:
            return replace(formula, complete=False)
        before = budget.used_work
        ordered = _score_all(problem, fitted_recordings(problem, formula.fit))
        extensions = _extensions(formula, ordered, refused, everywhere)
        if not extensions:
            break
        extension = max(extensions, key=lambda t: t.fit.evidence)
        # the placeholder has the term of the last extension
        set_placeholder_term(problem, extension.placeholder, extension.scored.term, everywhere)
        extended = _refined(formula, extension, everywhere)
        found = converge(problem, extended.fit)
        gained = formula.fit.evidence - best.evidence
        required = max(
            required_gain(len(ordered), config.select), config.select.slight_share * gained
        )
        if found.evidence - formula.fit.evidence < required:
            break
        extended = replace(extended, fit=found)
        fewer: dict[str, Formula] = {}
        if _replaces_effect(formula, extended, fewer):
            refused.add(term_family(extension.scored.term))
            work_of_term = budget.used_work - before
            continue
        formula = _pruned(extended, fewer)
        work_of_term = budget.used_work - before
        ends = budget.remaining_work <= work_of_term
        ends = ends and len(formula.terms) < config.describe.most_terms
        if len(formula.terms) > 1 and not ends:
            formula = _refine_all(formula, everywhere)
        count, gain = len(formula.terms), found.evidence - best.evidence
        done = count / config.describe.most_terms
        report(DESCRIBING, done, f"{count} terms ({gain:.0f} nats)")
    return formula


def _first_term(formula: Formula, everywhere: Recordings) -> Formula:
    """The formula with its best term by approximate evidence, if that gains enough evidence."""
    problem = formula.problem
    incomplete = replace(formula, complete=False)
    ordered = _score_all(problem, fitted_recordings(problem, formula.fit))
    found = _extensions(formula, ordered[:1], set(), everywhere)
    required = required_gain(len(ordered), problem.config.select)
    if not found or found[0].fit.evidence - formula.fit.evidence < required:
        return incomplete
    (best,) = found
    return replace(
        incomplete,
        problem=best.problem,
        fit=best.fit,
        terms={best.placeholder: best.scored.term},
    )


def _score_all(problem: Problem, recordings: Sequence[FittedRecording]) -> list[ScoredTerm]:
    """Return all terms of the grammar with their approximate evidence."""
    speeds, commands = varying_signals(recordings)
    grammar = candidate_terms(
        problem.program.vessel, problem.recordings, speeds, commands, problem.config.describe
    )
    return score_terms(recordings, list(grammar))


def _extensions(
    formula: Formula,
    ordered: Sequence[ScoredTerm],
    refused: set[Family],
    everywhere: Recordings,
) -> list[_Extension]:
    """Fit the formula with each of the best terms."""
    best = []
    for scored in best_term_of_each_family(ordered):
        if scored.gain > 0.0 and term_family(scored.term) not in refused:
            best.append(scored)
    extensions = []
    for scored in best[: formula.problem.config.describe.fitted_terms]:
        if extension := _with_term(formula, scored, everywhere):
            extensions.append(extension)
    return extensions


def term_family(term: SymbolicTerm) -> Family:
    """Return a key that is equal for symbolic terms which differ only in their constants.

    The constants are times, wavelength and threshold.

    Args:
        term: A term of the symbolic regression.
    """
    place = [getattr(term, name, "") for name in ("axis", "side", "sense")]
    return type(term), term.of, term.acts, term.run, *place


def best_term_of_each_family(ordered: Sequence[ScoredTerm]) -> list[ScoredTerm]:
    """Return the symbolic term with most evidence of each family.

    Terms of a family differ only in their times, wavelength or threshold.

    Args:
        ordered: Terms, those with most evidence first.
    """
    best: dict[Family, ScoredTerm] = {}
    for scored in ordered:
        best.setdefault(term_family(scored.term), scored)
    return list(best.values())


def _with_term(formula: Formula, scored: ScoredTerm, everywhere: Recordings) -> _Extension | None:
    """Fit the formula with one more term; None without a free placeholder or if it diverges."""
    placeholder = unused_placeholder(formula.problem, type(scored.term), list(formula.terms))
    if not placeholder:
        return None
    problem = formula.problem.with_spread(placeholder, scored.spread)
    set_placeholder_term(problem, placeholder, scored.term, everywhere)
    base, config = formula.fit, problem.config.fit
    effects = (*base.effects, placeholder)
    free = problem.free_parameters(effects)
    known = {}
    for f, x in zip(base.free, base.theta, strict=True):
        known[f.effect, f.name] = x
    theta, variances = [], []
    for f in free:
        theta.append(known.get((f.effect, f.name), scored.coefficient))
        variances.append(f.sd**2)
    covariance = np.diag(variances)
    start = Fit(effects, free, np.array(theta), covariance, base.levels, -np.inf)
    found = gauss_newton(problem, start, config.first_steps, config.refit_gain)
    if not np.isfinite(found.evidence):
        return None
    return _Extension(problem, placeholder, fit(problem, found), scored)


def _refined(formula: Formula, extension: _Extension, everywhere: Recordings) -> Formula:
    """Return the formula with the newest term, its times or lengths refined."""
    problem, placeholder = extension.problem, extension.placeholder
    term, config = extension.scored.term, problem.config.describe
    if not term_variants(term, problem.recordings, config.coarse_refinement[0], config):
        return Formula(problem, extension.fit, formula.terms | {placeholder: term})
    recordings, best = fitted_recordings(problem, formula.fit), extension.scored
    for step in config.coarse_refinement:
        for _ in range(config.refinement_moves):
            near = term_variants(best.term, problem.recordings, step, config)
            moved = score_terms(recordings, near)
            if not moved or moved[0].gain <= best.gain:
                break
            best = moved[0]
    if best.term != term:
        better = _with_term(formula, best, everywhere)
        if better and better.fit.evidence > extension.fit.evidence:
            extension = better
        else:
            set_placeholder_term(problem, placeholder, term, everywhere)
    problem, term = extension.problem, extension.scored.term
    term, found = _refined_by_filter(problem, placeholder, term, extension.fit, everywhere)
    return Formula(problem, found, formula.terms | {placeholder: term})


def _refined_by_filter(
    problem: Problem, placeholder: str, term: SymbolicTerm, found: Fit, everywhere: Recordings
) -> tuple[SymbolicTerm, Fit]:
    """Refine the times or lengths of a term with the filter, whose likelihood is exact.

    Moves of the term and fits of all parameters alternate, because they depend on each other: a
    force with a longer time constant must be stronger.
    """
    config = problem.config.describe
    if not term_variants(term, problem.recordings, config.fine_refinement[0], config):
        return term, found
    for _ in range(config.refinement_turns):
        moved = _moved(problem, placeholder, term, found, everywhere)
        if moved == term:
            break
        again = fit(problem, found)
        if not again.evidence > found.evidence:
            set_placeholder_term(problem, placeholder, term, everywhere)
            break
        term, found = moved, again
    return term, found


def _refine_all(formula: Formula, everywhere: Recordings) -> Formula:
    """Refine all terms in the presence of the others, of which they may have explained a part."""
    problem, refined, found = formula.problem, dict(formula.terms), formula.fit
    for placeholder, term in formula.terms.items():
        refined[placeholder], found = _refined_by_filter(
            problem, placeholder, term, found, everywhere
        )
    if found is formula.fit:
        return formula
    return Formula(problem, converge(problem, found), refined)


def _moved(
    problem: Problem, placeholder: str, term: SymbolicTerm, found: Fit, everywhere: Recordings
) -> SymbolicTerm:
    """Move a term to the maximum of the likelihood with all fitted parameters held."""
    config, on = problem.config.describe, problem.program.effect_switches(found.effects)

    def log_likelihood_of_term(candidate: SymbolicTerm) -> float:
        set_placeholder_term(problem, placeholder, candidate, everywhere)
        return problem.log_likelihood(found.free, found.theta, on, found.levels)

    best = log_likelihood_of_term(term)
    for step in config.fine_refinement:
        for _ in range(config.refinement_moves):
            near = term_variants(term, problem.recordings, step, config)
            scores = list(map(log_likelihood_of_term, near))
            # the last one of equally likely neighbours
            last = max(range(len(near)), key=lambda i: (scores[i], i))
            if not scores[last] > best + config.least_move_gain:
                break
            term, best = near[last], scores[last]
    set_placeholder_term(problem, placeholder, term, everywhere)
    return term


def _replaces_effect(before: Formula, extended: Formula, fewer: dict[str, Formula]) -> bool:
    """Return whether the newest term only replaces an identified effect.

    It does if the effect alone explains most of what the term explains. The effect is the better
    answer even if it is a little less exact: wind, not a side force that varies with the heading.
    Refits of the extended formula without an effect are added to `fewer`, by its name.
    """
    config = before.problem.config.select
    for name in before.fit.effects:
        if name in before.terms:
            continue
        fewer[name] = refit_without_term(extended, name)
        without = fewer[name].fit
        if without.evidence > extended.fit.evidence - config.least_gain:
            neither = refit_without_term(before, name).fit.evidence
            share = config.alike_share * (without.evidence - neither)
            if before.fit.evidence - neither > share:
                return True
    return False


def _pruned(formula: Formula, fewer: Mapping[str, Formula]) -> Formula:
    """Return the formula without earlier terms or effects that the newest term replaces.

    `fewer` has known refits of the formula without a term or effect, by its name.
    """
    known, config = dict(fewer), formula.problem.config.select
    for name in formula.fit.effects[:-1]:
        without = known.get(name) or refit_without_term(formula, name)
        if without.fit.evidence > formula.fit.evidence - config.least_gain:
            formula, known = without, {}
    return formula


def refit_without_term(formula: Formula, name: str) -> Formula:
    """Refit a formula without one of its symbolic terms or effects.

    Args:
        formula: The formula.
        name: Name of the term's placeholder effect, or of the effect.
    """
    found = converge(formula.problem, remove_effect(formula.problem, formula.fit, name))
    kept = {placeholder: term for placeholder, term in formula.terms.items() if placeholder != name}
    return replace(formula, fit=found, terms=kept)
