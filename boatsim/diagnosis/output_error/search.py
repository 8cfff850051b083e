"""Search for the effects with which free runs follow the recordings best.

Where a force remains that no candidate explains, the effects of the Kalman filter's search are
often stand-ins: they take up a part of that force from sample to sample, and make a simulation
worse. This search drops those, and adds candidates that make simulations better. It describes the
recordings; it does not tell causes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import ParameterSpace, remove_effect
from boatsim.diagnosis.free_runs import free_run_horizon, free_runs
from boatsim.diagnosis.output_error.errors import OutputErrors, output_errors
from boatsim.diagnosis.output_error.fit import (
    OutputErrorFit,
    add_parameters,
    fit_to_free_runs,
    without_fit,
)
from boatsim.diagnosis.output_error.weights import (
    RunErrors,
    log_likelihood_gain,
    run_errors,
    typical_error_ratio,
)
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.budget import SearchBudget
from boatsim.diagnosis.search.screening import gain_along, starting_fits
from boatsim.diagnosis.stage_budgets import simulation_budget

BEFORE, AFTER = "before", "after"


class BalancedPair(NamedTuple):
    """A vessel with two effects that make free runs better together.

    Attributes:
        model: The vessel with both, fitted to free runs.
        gains: How much more probable free runs over the fitted recordings are by each effect,
            added to the other one, by its name [nats].
    """

    model: Fit
    gains: Mapping[str, float]


class OutputErrorSearch:
    """Search for the vessel whose free runs follow the recordings best.

    Evidence of free runs over the fitted recordings selects effects; held-out recordings may
    refuse each of them.
    """

    def __init__(
        self,
        problem: Problem,
        start: Fit,
        held_out: Sequence[MappedRecording],
        fixed_effects: Sequence[str] = (),
        budget: SearchBudget | None = None,
    ) -> None:
        """Fit the parameters of a vessel to free runs.

        Args:
            problem: The estimation problem: recordings, vessel model, candidate effects, priors.
            start: The vessel with the parameters that the Kalman filter found.
            held_out: Held-out recordings, at least one.
            fixed_effects: Effects that stay, with their parameters.
            budget: Work that may be done; None: that of the configuration, from now on.
        """
        self.problem, self.held_out, self.fixed_effects = problem, held_out, fixed_effects
        self.config = problem.config.simulate
        self.budget = budget or simulation_budget(problem)
        self.horizon = free_run_horizon(problem, held_out)
        self.errors = self._errors_of(start)
        self.added = 0  # number of effects
        self._accept(self._fitted(start))

    @property
    def model(self) -> Fit:
        """The best vessel so far."""
        return self.best.model

    def drop_effects(self) -> None:
        """Drop each effect without which free runs are at least as probable.

        Those over held-out recordings must not get clearly worse either.
        """
        for name in reversed(self.model.effects):
            if name in self.fixed_effects or self.budget.is_spent or self._is_clear(name):
                continue
            fewer = self._fitted(remove_effect(self.problem, self.model, name))
            worse = self.held_out_ratio(fewer.model) > self.problem.config.validate.worse
            if fewer.evidence >= self.best.evidence and not worse:
                self._accept(fewer)

    def _is_clear(self, name: str) -> bool:
        """Whether an effect differs so clearly from none that it need not be dropped on trial."""
        model = self.model
        own = [j for j, f in enumerate(model.free) if f.effect == name and not f.relative]
        away = np.array([model.theta[j] - model.free[j].mean for j in own])
        spread = model.covariance[np.ix_(own, own)]
        return float(away @ np.linalg.pinv(spread) @ away) > 2.0 * self.config.clear_gain

    def drop_if_clearly_better(self, name: str) -> bool:
        """Drop an effect whose parameters are fixed, if free runs are clearly better without it.

        Args:
            name: Name of the effect.

        Returns:
            Whether it was dropped.
        """
        fewer = self._fitted(remove_effect(self.problem, self.model, name))
        gain = fewer.evidence - self.best.evidence
        is_clear = gain >= self.config.effect_gain  # false if the simulations of both diverge
        if not is_clear or self.held_out_ratio(fewer.model) > 1.0:
            return False
        self._accept(fewer)
        return True

    def add_effects(self, candidates: Sequence[str]) -> None:
        """Add effects one by one, each the one that the free runs make most probable.

        Rough fits order the candidates; the first one that is good enough after a full fit is
        added. Simulations of fitted and of held-out recordings must both be more probable with it,
        and together by `simulate.effect_gain`.

        Args:
            candidates: Names of the candidates.
        """
        while self.added < self.config.effects:
            for rough in self._most_probable(candidates)[: self.config.fitted]:
                if self.budget.is_spent:
                    return
                further = self._fitted(rough.model)
                if self._is_better(further):
                    self._accept(further)
                    self.added += 1
                    break
            else:
                return

    def most_probable_pair(self, first: str, seconds: Sequence[str]) -> BalancedPair | None:
        """Return the vessel with one effect and that other one which together gain most.

        Rough fits of the first effect with each other one order the pairs; the most probable ones
        are then fitted in full. They start from several sizes of the first effect, because the
        frequency of an oscillation depends on the size of a spring, so that free runs have several
        maxima. A pair may explain just the runs that had unusually large errors
        and little weight without it. Therefore each fit is repeated with the weights of its
        errors, and the fits are compared by Student's t distribution itself.

        Args:
            first: Name of the effect that each pair has.
            seconds: Names of the others.

        Returns:
            The fitted pair; None unless free runs gain `simulate.effect_gain` for each effect of
            the pair over the vessel without it, and those over held-out recordings are more
            probable with the pair and not clearly worse.
        """
        base = self.model
        pairs = list[tuple[float, Fit]]()
        for second in seconds:
            if self.budget.is_spent:
                break
            for start in self._starts_over_range(base, first):
                rough = self._rough_fit(self._starts_with(start, second)).model
                pairs.append((self._gain(rough, base), rough))
        fitted = list[tuple[float, Fit]]()
        for rough in _best_of_each_set(pairs)[: self.config.fitted_pairs]:
            pair = self._reweighted_fit(rough)
            fitted.append((self._gain(pair, base), pair))
        if not fitted:
            return None
        gain, pair = max(fitted, key=lambda one: one[0])
        least = 2.0 * self.config.effect_gain
        if gain < least or self._held_out_gain(pair) <= 0.0 or self.harms(pair):
            return None
        second = pair.effects[-1]
        gains = {
            first: self._gain_over(self._starts_with(base, second), pair),
            second: self._gain_over(self._starts_over_range(base, first), pair),
        }
        if min(gains.values()) < self.config.effect_gain:
            return None
        return BalancedPair(pair, gains)

    def _gain_over(self, starts: Sequence[Fit], pair: Fit) -> float:
        """How much more probable free runs are by a pair than by one of its effects [nats].

        Args:
            starts: Vessels with that effect, from which its fit starts.
            pair: The vessel with the pair.
        """
        gains = list[float]()
        for start in starts:
            alone = self._reweighted_fit(self._rough_fit([start]).model)
            gains.append(self._gain(pair, alone))
        return min(gains)

    def _starts_over_range(self, model: Fit, name: str) -> list[Fit]:
        """A vessel with one more effect of several sizes over its usual range."""
        start = self._starts_with(model, name)[0]
        found = []
        for share in self.config.pair_starts:
            theta = start.theta.copy()
            for i in range(len(model.free), len(theta)):
                theta[i] = start.free[i].mean + share * start.free[i].sd
            found.append(replace(start, theta=theta))
        return found

    def _reweighted_fit(self, start: Fit) -> Fit:
        """Fit a vessel, and again with the weights of its errors, in the same units."""
        found = self._fitted(start).model
        own = self._errors_of(found)
        errors = replace(self.errors, weights=own.weights)
        return fit_to_free_runs(errors, found, self.fixed_effects).model

    def _gain(self, found: Fit, reference: Fit) -> float:
        """How much more probable free runs over the fitted recordings are by one vessel [nats]."""
        both = {BEFORE: reference, AFTER: found}
        runs = free_runs(self.problem, both, self.problem.recordings, self.horizon)
        before, after = run_errors(runs, BEFORE), run_errors(runs, AFTER)
        return log_likelihood_gain(after, before, self.errors.scale)

    def _held_out_gain(self, found: Fit) -> float:
        """How much more probable free runs over held-out recordings are by a vessel [nats]."""
        before, after = self._held_out_errors(found)
        return log_likelihood_gain(after, before, self.errors.scale)

    def _starts_with(self, model: Fit, name: str) -> list[Fit]:
        """A vessel with one more effect, at each of its starting points."""
        return starting_fits(self.problem, model, self.problem.candidates[name])

    def _rough_fit(self, starts: Sequence[Fit]) -> OutputErrorFit:
        """The most probable rough fit from several starts with further effects."""
        steps = self.config.pair_steps
        rough = [add_parameters(self.errors, self.best, start, steps) for start in starts]
        return max(rough, key=lambda one: one.evidence)

    def _is_better(self, further: OutputErrorFit) -> bool:
        """Whether simulations are more probable with one more effect, and none clearly worse."""
        fitted = further.evidence - self.best.evidence
        if fitted <= 0.0:
            return False
        held_out = self._held_out_gain(further.model)
        if held_out <= 0.0 or fitted + held_out < self.config.effect_gain:
            return False
        return not self.harms(further.model)

    def harms(self, other: Fit) -> bool:
        """Whether the rms errors over all or a group of held-out recordings get clearly worse.

        Args:
            other: Vessel that is compared with the best one so far.
        """
        if self._rms_ratio(other, self.model) > self.problem.config.validate.worse:
            return True
        return bool(
            generalization.harmed_groups(
                self.problem, self.model, other, self.held_out, self.horizon
            )
        )

    def held_out_ratio(self, other: Fit) -> float:
        """Return the ratio of typical errors of free runs over held-out recordings.

        Args:
            other: Vessel that is compared with the best one so far.
        """
        before, after = self._held_out_errors(other)
        if before.count == 0:
            return 1.0
        return typical_error_ratio(after, before, self.errors.scale)

    def _held_out_errors(self, other: Fit) -> tuple[RunErrors, RunErrors]:
        """Errors of free runs over held-out recordings by the best vessel so far and by another."""
        both = {BEFORE: self.model, AFTER: other}
        runs = free_runs(self.problem, both, self.held_out, self.horizon)
        return run_errors(runs, BEFORE), run_errors(runs, AFTER)

    def start_from(self, other: Fit) -> None:
        """Fit from another start, which may lead to another maximum, and keep the better fit.

        Args:
            other: The same vessel with other parameters.
        """
        found = self._fitted(other)
        if found.evidence > self.best.evidence:
            self._accept(found)

    def _fitted(self, start: Fit) -> OutputErrorFit:
        """Fit a vessel, in units of the errors of the best one so far."""
        return fit_to_free_runs(self.errors, start, self.fixed_effects)

    def _accept(self, found: OutputErrorFit) -> None:
        """Make a fit the best one, and its errors the units of the next ones.

        In these units it is fitted again, unless the errors on held-out recordings then get clearly
        worse, or a simulation of them diverges.
        """
        self.errors = self._errors_of(found.model)
        again = self._fitted(found.model)
        if self._rms_ratio(again.model, found.model) > self.problem.config.validate.worse:
            again = without_fit(self.errors, found.model, self.fixed_effects)
        self.best = again

    def _rms_ratio(self, found: Fit, reference: Fit) -> float:
        """Ratio of the rms errors of two vessels over held-out recordings."""
        return rms_error_ratio(self.problem, found, reference, self.held_out, self.horizon)

    def _errors_of(self, reference: Fit) -> OutputErrors:
        """Errors of free runs over the fitted recordings in units of those of a vessel."""
        return output_errors(self.problem, reference, self.problem.recordings, self.horizon)

    def _most_probable(self, candidates: Sequence[str]) -> list[OutputErrorFit]:
        """Rough fits with one more effect that gain evidence, the most probable one first."""
        rough = list[OutputErrorFit]()
        for start in self._promising(candidates)[: self.config.followed]:
            if self.budget.is_spent:
                break
            steps = self.config.followed_steps
            rough.append(add_parameters(self.errors, self.best, start, steps))
        gaining = [one for one in rough if one.evidence > self.best.evidence]
        return sorted(gaining, key=lambda one: -one.evidence)

    def _promising(self, candidates: Sequence[str]) -> list[Fit]:
        """Starts with one more effect, at the best of its starting points, by predicted gain."""
        present = set(map(name_without_prefixes, self.model.effects))
        J = self.best.J
        inverse = np.asarray(np.linalg.inv(np.eye(J.shape[1]) + J.T @ J), dtype=np.float64)
        found = []
        for name in candidates:
            effect = self.problem.candidates[name]
            kind = type(effect)
            if name_without_prefixes(name) in present or kind.random or kind.described:
                continue
            starts = None if kind.kind == "measurement" else self.best.starts
            best, most = None, 0.0
            for start in starting_fits(self.problem, self.model, effect):
                start = replace(start, theta=ParameterSpace(start.free).clip(start.theta))
                changed = self.errors.residuals(start, starts)
                gain = gain_along(J, inverse, self.best.residuals, changed)
                if gain > most:
                    best, most = start, gain
            if best is not None:
                found.append((most, best))
        found.sort(key=lambda one: -one[0])
        return [start for _, start in found]


def _best_of_each_set(fits: Sequence[tuple[float, Fit]]) -> list[Fit]:
    """The fit with the largest gain of each set of effects, in the order of their gains."""
    found = dict[tuple[str, ...], Fit]()
    for _, one in sorted(fits, key=lambda pair: -pair[0]):
        found.setdefault(one.effects, one)
    return list(found.values())


def with_coefficients_of_file(found: Fit) -> Fit:
    """Return a fit whose coefficients have the values of the vessel file, not refitted.

    Args:
        found: Fit of the vessel model with some candidate effects.
    """
    theta = found.theta.copy()
    for i, parameter in enumerate(found.free):
        if parameter.relative:
            theta[i] = parameter.mean
    return replace(found, theta=theta)


def rms_error_ratio(
    problem: Problem,
    found: Fit,
    reference: Fit,
    held_out: Sequence[MappedRecording],
    horizon: float,
) -> float:
    """Return the ratio of the rms errors of two vessels' free runs over held-out recordings.

    It is the geometric mean over the signals; infinite where a simulation diverges.

    Args:
        problem: The estimation problem.
        found: The vessel that is judged.
        reference: The vessel that it is compared with.
        held_out: Held-out recordings, at least one.
        horizon: Length of each free run [s].
    """
    runs = free_runs(problem, {BEFORE: reference, AFTER: found}, held_out, horizon)
    before = generalization.mean_square_errors(runs, BEFORE)
    if not before:
        return 1.0
    after = generalization.mean_square_errors(runs, AFTER)
    ratio = float(np.sqrt(generalization.error_ratio(after, before)))
    return ratio if np.isfinite(ratio) else np.inf
