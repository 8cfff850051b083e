"""Symbolic description of the force that a fit leaves unexplained, validated on held-out data."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.description import FittedTerm, SymbolicDescription
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import free_runs
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.evidence import unexplained_evidence
from boatsim.diagnosis.symbolic.curves import term_force_curve
from boatsim.diagnosis.symbolic.grammar import longest_recording_duration
from boatsim.diagnosis.symbolic.term_forces import fitted_recordings
from boatsim.diagnosis.symbolic.term_selection import Formula, refit_without_term, select_terms
from boatsim.physics.effects.described_force import DescribedForce
from boatsim.progress import Report, ignore_progress

# Axis of a force -> family of the signals along it; that of all others is the position. No family
# contains the pitch.
FAMILY_OF_AXIS = {
    "heave": "heave_rms_m",
    "roll": "roll_rms_rad",
    "pitch": "",
    "yaw": "heading_rms_rad",
}


def describe_residual_force(
    problem: Problem,
    best: Fit,
    recalibrated: Fit,
    held_out: Sequence[MappedRecording],
    report: Report = ignore_progress,
) -> SymbolicDescription | None:
    """Describe the force that a fit leaves unexplained by a formula, with symbolic regression.

    Args:
        problem: The estimation problem.
        best: The fit of the identified effects.
        recalibrated: The fit of the vessel without any effect.
        held_out: Held-out recordings, on which the terms are validated.
        report: Receives the progress.

    Returns:
        The terms with their evidence; None if no term has enough evidence.
    """
    found = select_terms(problem, best, held_out, report)
    if not found.terms:
        return None
    gains = {}
    for placeholder in found.terms:
        without = refit_without_term(found, placeholder)
        gains[placeholder] = found.fit.evidence - without.fit.evidence
    start = Formula(problem, best, {})
    general = _general(problem, found, start, gains, recalibrated, held_out)
    written, recordings = [], fitted_recordings(problem, found.fit)
    for placeholder, term in sorted(found.terms.items(), key=lambda pair: -gains[pair[0]]):
        carries = placeholder in general.terms and not term.run
        fit = general.fit if carries else found.fit
        value, sd = fit.value(placeholder, "coefficient")
        drawn = term_force_curve(recordings, term, *found.fit.value(placeholder, "coefficient"))
        described = term.with_values({"name": placeholder, "coefficient": value})
        written.append(FittedTerm(described, sd, gains[placeholder], carries, drawn))
    return SymbolicDescription(
        tuple(written), general.fit, unexplained_evidence(problem, found.fit), found.complete
    )


def _general(
    problem: Problem,
    found: Formula,
    start: Formula,
    gains: Mapping[str, float],
    recalibrated: Fit,
    held_out: Sequence[MappedRecording],
) -> Formula:
    """Return the formula with the terms that reduce the errors on held-out recordings.

    Terms that make simulations of one group of these much worse are removed, too, and so are those
    with which the signals along their own axis are worse than without any term.

    Terms are removed in the order of increasing evidence; events of single recordings remain. The
    last choice is the fit without any term, if terms have replaced effects of it.
    """
    chain = [found]
    for placeholder in sorted(found.terms, key=lambda n: gains[n]):
        if not found.terms[placeholder].run:
            chain.append(refit_without_term(chain[-1], placeholder))
    events_only = chain[-1]
    if not set(start.fit.effects) <= set(events_only.fit.effects):
        chain.append(start)
    fits = {"recalibrated": recalibrated}
    for k, formula in enumerate(chain):
        fits[str(k)] = formula.fit
    runs, horizon = [], problem.horizon
    if held_out:
        horizon = min(problem.horizon, longest_recording_duration(held_out))
        runs = free_runs(problem, fits, held_out, horizon)
    before = generalization.mean_square_errors(runs, "recalibrated")
    if not before:  # without held-out data no term is confirmed
        return events_only
    misfits, last = [], chain[-1].fit
    without = generalization.mean_square_errors(runs, str(len(chain) - 1))
    for k, formula in enumerate(chain):
        errors = generalization.mean_square_errors(runs, str(k))
        misfit = generalization.error_ratio(errors, before)
        harmed = generalization.harmed_groups(problem, last, formula.fit, held_out, horizon)
        worse = problem.config.validate.worse**2
        if not np.isfinite(misfit) or harmed:  # or the simulation diverges
            misfit = np.inf
        for family in _own_families(formula):
            if family in errors and np.mean(errors[family]) > worse * np.mean(without[family]):
                misfit = np.inf
        misfits.append(misfit)
    improvement = problem.config.describe.general_improvement
    best = len(chain) - 1
    for k in reversed(range(len(chain))):
        if misfits[k] < improvement * misfits[best]:
            best = k
    return chain[best]


def _own_families(formula: Formula) -> set[str]:
    """Return the families of signals along the axes of those terms that are no events."""
    found = set[str]()
    for term in formula.terms.values():
        if not term.run:
            axis = term.axis if isinstance(term, DescribedForce) else "thrust"
            found.add(FAMILY_OF_AXIS.get(axis, "position_rms_m"))
    return found
