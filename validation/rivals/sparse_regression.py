"""Sparse regression of accelerations on all effects; the least needed are removed one by one.

Positions are smoothed and differentiated twice. The accelerations that the vessel's laws do not
explain are regressed on the change that each effect causes (Brunton, Proctor, Kutz 2016),
thresholded one effect at a time (Boninsegna, Nueske, Clementi 2018); BIC selects the set. Effects
that are not linear in their parameters are first fitted alone and enter the regression with that
shape and its derivatives. Stochastic forces and clock offsets have no column and are excluded.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.problem import Fit, FreeParameter
from boatsim.diagnosis.search.screening import (
    add_effect,
    starting_points,
    transfer_coefficient_change,
)
from boatsim.physics.base import Array, Force, Measurement
from validation.rivals.accelerations import (
    Smoother,
    mean_actuators,
    predicted_accelerations,
    recorded_positions,
    true_positions,
)
from validation.rivals.evidence import Judge, rms_by_channel
from validation.rivals.linear import bounded_least_squares_step, iterate_steps
from validation.rivals.question import Question, as_diagnosis_fit, free_parameters

STEP = 1e-3  # step of finite differences, in prior sds
RIDGE = 1e-8  # relative to a column's square
ROUNDS = 3  # Gauss-Newton steps
MOST = 4  # largest number of effects
SURE = 1e-3  # p-value below which the residual exceeds the tolerated ambient force
TOLERATED = 2.0  # tolerated multiple of the ambient force
DRAWS, SEED = 5, 1  # samples of the noise and their seed


@dataclass(frozen=True)
class State:
    """A hypothesis and its present fit."""

    effects: tuple[str, ...]
    theta: Array  # (F,)
    errors: tuple[Array, ...]  # (M, NQ) recorded minus predicted accelerations of each run
    square: float  # weighted sum of squares, including the prior of the nominal coefficients


@dataclass(frozen=True)
class Group:
    """Influence of one effect on the errors of the nominal model."""

    columns: Array  # (R, K) change by the effect as fitted alone, and its derivatives
    alone: State


class SparseRegression:
    """Sparse-regression answer to one trial."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.question, self.problem = question, question.problem
        late = []
        for n, e in question.entries.items():
            if isinstance(e, Measurement) and type(e).motion_latency is not None:
                late.append(n)
        self.entries = {n: e for n, e in question.entries.items() if n not in late}
        self.judge = Judge(plain, len(self.entries))
        self.smoothers = [
            Smoother.of(t, self.problem.ambient, question.noise) for t in self.problem.recordings
        ]
        self.recorded = [recorded_positions(t) for t in self.problem.recordings]
        self.weights = np.ones(self.problem.program.module.NQ)
        self.held = [mean_actuators(t, (), t.values) for t in self.problem.recordings]

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, the evidence gain of each effect [nats], and the unknown flag."""
        nominal = self.nominal()
        known = self.derivatives(nominal)
        groups = {
            n: g for n in self.entries if (g := self.fit_alone(nominal, n, known)) is not None
        }
        sets = []
        for names in self.threshold_sequentially(nominal, groups, known):
            sets.append(self.refit(nominal, groups, names))
        best = max([nominal, *sets], key=lambda s: self.gain(nominal, s))
        best = self.prune(nominal, best)
        gains = {}
        for n in best.effects:
            gains[n] = self.gain(nominal, best) - self.gain(nominal, self.fit_without(best, n))
        fit = as_diagnosis_fit(self.question, best.effects, best.theta, self.covariance(best))
        return fit, gains, self.residual_is_unexplained(best)

    # ---- one fit

    def evaluate(self, effects: tuple[str, ...], theta: Array) -> State:
        """Evaluate a hypothesis along the recordings."""
        free = free_parameters(self.question, effects)
        on = self.problem.program.effect_switches(effects)
        errors = list[Array]()
        kinds = [self.entries[n] for n in effects]
        for smoother, recorded, held in zip(self.smoothers, self.recorded, self.held, strict=True):
            track = smoother.track
            values = self.problem.parameter_vector(track, free, theta)
            if any(isinstance(e, Measurement) for e in kinds):
                true = true_positions(track, recorded, values, on)
            else:
                true = recorded
            states, accelerations = smoother.motion(true)
            if held.any() and any(not isinstance(e, Measurement | Force) for e in kinds):
                held = mean_actuators(track, effects, values)
            left = accelerations - smoother.smooth_accelerations(
                predicted_accelerations(track, states, held, values, on)
            )
            errors.append(left[smoother.margin : len(left) - smoother.margin])
        with np.errstate(over="ignore", invalid="ignore"):
            square = sum(float(np.sum((e * self.weights) ** 2)) for e in errors)
        square += sum(error**2 for error in _prior_errors(free, theta))
        return State(effects, theta, tuple(errors), square if np.isfinite(square) else np.inf)

    def error_row(self, state: State) -> Array:
        """Return weighted errors (R,) of both runs, then those of the prior of the coefficients."""
        free = free_parameters(self.question, state.effects)
        prior = _prior_errors(free, state.theta)
        return np.concatenate([*((e * self.weights).ravel() for e in state.errors), prior])

    def derivatives(self, state: State, only: str = "") -> Array:
        """Return derivatives (R, F) of `error_row` by the parameters, or by those of one effect."""
        here, columns = self.error_row(state), []
        for j, f in enumerate(free_parameters(self.question, state.effects)):
            if only and (f.relative or f.effect != only):
                continue
            h = STEP * f.sd if state.theta[j] + STEP * f.sd <= f.high else -STEP * f.sd
            moved = state.theta.copy()
            moved[j] += h
            column = (self.error_row(self.evaluate(state.effects, moved)) - here) / h
            columns.append(np.where(np.isfinite(column), column, 0.0))
        if columns:
            return np.column_stack(columns)
        return np.zeros((len(here), 0))

    def fit(self, state: State, rounds: int = ROUNDS, known: Array | None = None) -> State:
        """Take Gauss-Newton steps, each shortened until it improves.

        Args:
            state: the start.
            rounds: largest number of steps.
            known: held derivatives by the nominal coefficients.
        """
        free = free_parameters(self.question, state.effects)
        low, high = [f.low for f in free], [f.high for f in free]

        def stepped(s: State) -> State | None:
            if not np.isfinite(s.square):
                return None
            if known is None:
                J = self.derivatives(s)
            else:
                J = np.hstack([known, self.derivatives(s, s.effects[-1])])
            move = bounded_least_squares_step(J, self.error_row(s), low, high, s.theta)
            nearer = (
                np.clip(s.theta + share * move, low, high) for share in (1.0, 0.5, 0.25, 0.125)
            )
            steps = (self.evaluate(s.effects, theta) for theta in nearer)
            return next((after for after in steps if after.square < s.square), None)

        return iterate_steps(state, stepped, rounds)

    def nominal(self) -> State:
        """Return the recalibrated vessel, axes weighted by rms and correlation of their errors."""
        state = self.evaluate((), self.question.start())
        for _ in range(2):
            self.weights = 1.0 / (
                rms_by_channel(state.errors)
                * np.sqrt(self.judge.rows_per_independent_value(state.errors))
            )
            state = self.fit(self.evaluate((), state.theta))
        return state

    def covariance(self, state: State) -> Array:
        """Return the covariance (F, F) of a fit; undetermined values keep their prior spread."""
        sd = np.array([f.sd for f in free_parameters(self.question, state.effects)])
        J = self.derivatives(state) * sd
        return np.asarray(np.linalg.inv(J.T @ J + 1e-6 * np.eye(len(sd))) * np.outer(sd, sd))

    def gain(self, before: State, after: State) -> float:
        """Return the evidence gain of a set over another [nats]."""
        more = len(after.theta) - len(before.theta)
        entries = len(after.effects) - len(before.effects)
        prior = self.prior(before) - self.prior(after)
        return self.judge.gain(before.errors, after.errors, more, entries) + 0.5 * prior

    def prior(self, state: State) -> float:
        """Return the sum of squared deviations of the nominal coefficients in specified sds."""
        free = free_parameters(self.question, state.effects)
        return sum(error**2 for error in _prior_errors(free, state.theta))

    # ---- the sparse regression

    def fit_alone(self, nominal: State, entry: str, known: Array) -> Group | None:
        """Fit an effect alone and return its columns; None if it diverges or changes nothing."""
        base = as_diagnosis_fit(self.question, (), nominal.theta, np.zeros((0, 0)))
        begun = [
            transfer_coefficient_change(
                add_effect(self.problem, base, entry, s), self.entries[entry]
            )
            for s in starting_points(self.problem, self.entries[entry])
        ]
        free = free_parameters(self.question, (entry,))
        low, high = [f.low for f in free], [f.high for f in free]
        tried = [self.evaluate((entry,), np.clip(f.theta, low, high)) for f in begun]
        first = [self.fit(s, 1, known) for s in tried if np.isfinite(s.square)]
        if not first:
            return None
        alone = self.fit(min(first, key=lambda s: s.square), ROUNDS - 1, known)
        slopes = self.derivatives(alone, entry)
        shape = self.error_row(
            self.evaluate((entry,), self.collect_parameters((entry,), [alone, nominal]))
        ) - self.error_row(nominal)
        columns = np.column_stack([shape, slopes])
        if np.isfinite(columns).all() and shape.any():
            return Group(columns, alone)
        return None

    def collect_parameters(self, effects: tuple[str, ...], states: Sequence[State]) -> Array:
        """Return parameters (F,) of a set, taken from the last state that has each."""
        known = {
            (f.effect, f.name, f.relative): x
            for s in states
            for f, x in zip(free_parameters(self.question, s.effects), s.theta, strict=True)
        }
        return np.array(
            [known[f.effect, f.name, f.relative] for f in free_parameters(self.question, effects)]
        )

    def threshold_sequentially(
        self, nominal: State, groups: dict[str, Group], own: Array
    ) -> list[tuple[str, ...]]:
        """Return the sets left while the least needed effect is removed repeatedly."""
        names = list(groups)
        blocks = [own, *(g.columns for g in groups.values())]
        A = np.column_stack(blocks)
        A = A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)
        target = -self.error_row(nominal)
        G, b = A.T @ A + RIDGE * np.eye(A.shape[1]), A.T @ target
        ends = np.cumsum([x.shape[1] for x in blocks])
        span = {n: np.arange(ends[i], ends[i + 1]) for i, n in enumerate(names)}
        kept, found = names, list[tuple[str, ...]]()

        def explained(left: list[str]) -> float:
            at = np.concatenate([np.arange(ends[0]), *(span[n] for n in left)]).astype(int)
            return float(b[at] @ np.linalg.solve(G[np.ix_(at, at)], b[at]))

        while kept:
            if len(kept) <= MOST and len({name_without_prefixes(n) for n in kept}) == len(kept):
                found.append(tuple(kept))
            worth = {n: explained([m for m in kept if m != n]) for n in kept}
            dispensable = max(worth, key=lambda n: worth[n])
            kept = [n for n in kept if n != dispensable]
        return found

    def refit(self, nominal: State, groups: dict[str, Group], names: tuple[str, ...]) -> State:
        """Fit a set by its own laws, starting from the fits of its effects alone."""
        alone = [groups[n].alone for n in names]
        return self.fit(self.evaluate(names, self.collect_parameters(names, [*alone, nominal])))

    def fit_without(self, state: State, name: str) -> State:
        """Return the refitted set without one of its effects."""
        left = tuple(n for n in state.effects if n != name)
        return self.fit(self.evaluate(left, self.collect_parameters(left, [state])))

    def prune(self, nominal: State, best: State) -> State:
        """Return the set without effects whose removal lowers BIC."""
        while best.effects:
            fewer = max(
                (self.fit_without(best, n) for n in best.effects),
                key=lambda s: self.gain(nominal, s),
            )
            if self.gain(nominal, fewer) < self.gain(nominal, best):
                break
            best = fewer
        return best

    def residual_is_unexplained(self, best: State) -> bool:
        """Test whether the residual exceeds noise plus the tolerated ambient force (chi-square)."""
        pushed = np.mean(
            [s.ambient_variance(self.problem.ambient, TOLERATED) for s in self.smoothers], axis=0
        )
        expected, alike = (
            pushed + self.variance_by_noise(best),
            self.judge.rows_per_independent_value(best.errors),
        )
        square = sum(float(np.sum(e**2 / expected / alike)) for e in best.errors)
        return bool(chi2.sf(square, sum(float(np.sum(len(e) / alike)) for e in best.errors)) < SURE)

    def variance_by_noise(self, best: State) -> Array:
        """Return the variance (NQ,) of the errors by noise alone.

        Noise of the same size is added to the recordings and carried through smoothing and laws.
        """
        rng, recorded, found = np.random.default_rng(SEED), self.recorded, list[Array]()
        for _ in range(DRAWS):
            self.recorded = [
                y + s.sample_noise(self.question.noise, rng)
                for y, s in zip(recorded, self.smoothers, strict=True)
            ]
            noisy = self.evaluate(best.effects, best.theta).errors
            found.append(
                rms_by_channel([a - b for a, b in zip(noisy, best.errors, strict=True)]) ** 2
            )
        self.recorded = recorded
        return np.asarray(np.mean(found, axis=0))


def _prior_errors(free: Sequence[FreeParameter], theta: Array) -> list[float]:
    """Return the deviations of the nominal coefficients in specified sds."""
    return [(x - f.mean) / f.sd for f, x in zip(free, theta, strict=True) if f.relative]
