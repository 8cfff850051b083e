"""Comparison of a fault of a log with effects of the vessel that would look alike.

A fault is reported only if a log without it is far more likely than the log as recorded on a vessel
that also has these effects.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.checks.finding import Change, apply_corrections
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.fit import converge, unfitted_hypothesis
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording


@dataclass(frozen=True)
class FaultComparison:
    """Recordings whose columns may have a fault, and the estimation problem of the vessel.

    Attributes:
        recordings: Prepared and cleaned recordings.
        problem: The problem with the vessel as specified.
        lost: Time at the end of each recording that is not compared [s].
    """

    recordings: Sequence[Recording]
    problem: Problem
    lost: float = 0.0

    def problem_with_changes(
        self, changes: Sequence[Change], program: Program | None = None
    ) -> Problem:
        """Return the problem of the recordings with the same changes of columns in each.

        Args:
            changes: The changes.
            program: Program with further effects; None: that of the vessel as specified.

        Raises:
            BadInput: A changed recording cannot be mapped to the vessel.
        """
        return self.problem_with_own_changes([changes] * len(self.recordings), program)

    def problem_with_own_changes(
        self, changes: Sequence[Sequence[Change]], program: Program | None = None
    ) -> Problem:
        """Return the problem of the recordings with changes of columns of their own.

        Args:
            changes: The changes of each recording.
            program: Program with further effects; None: that of the vessel as specified.

        Raises:
            BadInput: A changed recording cannot be mapped to the vessel.
        """
        first = self.problem
        used = program or first.program
        levels = prior_noise_levels(used.vessel, self.recordings, first.config)
        mapped = []
        for before, own in zip(self.recordings, changes, strict=True):
            after = apply_corrections(before, own)
            part = after.between(before.t[0] + 1e-6, before.t[-1] - self.lost)
            one = map_recording(part, used, config=first.config)
            mapped.append(infer_initial_actuator_state(one, levels, first.config.checks))
        return Problem(mapped, levels, first.uncertainty, None, first.config)

    def program_with_rivals(self, names: Collection[str]) -> Program:
        """Return the program of the vessel with the effects that may look like a fault."""
        vessel = self.problem.program.vessel
        return program_with_candidates(vessel, names, self.problem.config)

    @property
    def required_gain(self) -> float:
        """Evidence that the log without its fault must gain [nats]."""
        config = self.problem.config.checks
        rows = sum(map(len, self.recordings))
        return max(config.compare_min_gain, config.compare_min_gain_per_row * rows)


def fit_without_effects(problem: Problem) -> Fit:
    """Return the fit of the vessel with refitted coefficients and without further effects."""
    return fit_baseline(problem).recalibrated


def best_rival(problem: Problem, config: ChecksConfig, enough: float) -> Fit:
    """Return the fit of a vessel with the effects that explain a log best, added one by one.

    Args:
        problem: The problem, whose program has the effects.
        config: Thresholds of the quality checks.
        enough: Evidence from which no further effect is needed [nats].
    """
    best = fit_without_effects(problem)
    left = list(problem.program.candidate_names)
    for _ in range(config.late_max_rivals):
        if not left or best.evidence > enough:
            break
        fits: dict[str, Fit] = {}
        for name in left:
            fits[name] = converge(problem, _start(problem, best, (*best.effects, name)))
        name = max(fits, key=lambda each: fits[each].evidence)
        if not fits[name].evidence > best.evidence + config.late_rival_gain:
            break
        best = fits[name]
        left.remove(name)
    return best


def fit_with_rival_effects(problem: Problem, rival: Fit, effects: Sequence[str]) -> Fit:
    """Fit the log without its fault with the effects of a rival explanation; return the fit.

    Args:
        problem: The problem of the log without its fault.
        rival: Fit to the log as recorded.
        effects: Names of the effects, all or some of those of the rival.
    """
    return converge(problem, _start(problem, rival, effects))


def _start(problem: Problem, found: Fit, effects: Sequence[str]) -> Fit:
    """A hypothesis with some effects before its fit, with the values of another fit."""
    free = problem.free_parameters(effects)
    values = free_parameter_values(free, found.values())
    return unfitted_hypothesis(tuple(effects), free, values, found.levels)
