"""Least squares of trajectories: output error in windows, stepwise selection of effects by BIC.

Fitted are the vessel's uncertain coefficients with their specified spread as a prior, the
parameters of the effects, and the start of every window. Each channel is weighted by the rms of its
errors. Stochastic forces cannot be simulated and are excluded. The method never reports an unknown
cause: trajectory errors under an ambient force have no reference level to test against.
"""

from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.screening import (
    add_effect,
    starting_points,
    transfer_coefficient_change,
)
from boatsim.physics.base import Array
from validation.rivals.evidence import Judge, rms_by_channel
from validation.rivals.linear import LinearisedErrors, bounded_least_squares_step, iterate_steps
from validation.rivals.question import Question, as_diagnosis_fit, free_parameters
from validation.rivals.windows import Windows

MOST = 4  # largest number of effects
STEPS = 6  # largest number of steps of the selection
FULL = 4  # number of best candidates that are fitted in full
ROUNDS, SCREENING_ROUNDS = 5, 3  # Gauss-Newton steps of a fit and of screening a candidate
WEIGHINGS = 2  # fits with updated weights
HALVINGS = 6  # largest number of halvings of a step
STEP = 1e-3  # step of finite differences, in prior sds
FAR = 5.0  # an error beyond this multiple of its channel's rms is an outlier


@dataclass(frozen=True)
class State:
    """A hypothesis and its present fit."""

    effects: tuple[str, ...]
    theta: Array  # (F,)
    starts: tuple[Array, ...]  # starts of the windows of each run, (W, 2 NQ)
    errors: tuple[Array, ...]  # (M, C) of each window, all runs
    weights: Array  # (C,) per unit of each channel
    square: float  # weighted sum of squares, including the prior of the nominal coefficients


class LeastSquares:
    """Least-squares answer to one trial."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.question, self.problem = question, question.problem
        self.runs = [Windows.of(t, self.problem.horizon) for t in self.problem.recordings]
        self.judge = Judge(plain, len(question.entries))

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, the evidence gain of each effect [nats], and False: never unknown."""
        best = self.nominal()
        for _ in range(STEPS):
            found = self.add_best_effect(best) if len(best.effects) < MOST else None
            fewer = self.prune(found) if found else best
            if set(fewer.effects) == set(
                best.effects
            ):  # no effect was added, or it was removed again
                break
            best = fewer
        gains = {n: self.gain(self.fit_without(best, n), best) for n in best.effects}
        return (
            as_diagnosis_fit(self.question, best.effects, best.theta, self.covariance(best)),
            gains,
            False,
        )

    def nominal(self) -> State:
        """Return the recalibrated vessel, with outliers removed."""
        begun = self.simulate(
            (), self.question.start(), tuple(w.guess() for w in self.runs), np.ones(self.channels)
        )
        found = self.fit_with_consistent_weights(begun)
        masks = [np.abs(e) > FAR * rms_by_channel(found.errors) for e in found.errors]
        for run, measured in zip(
            self.runs, (t.measured for t in self.problem.recordings), strict=True
        ):
            for w in range(len(run.begins)):
                measured[run.begins[w] : run.ends[w] + 1][masks.pop(0)] = np.nan
        return self.fit_with_consistent_weights(
            self.simulate((), found.theta, found.starts, found.weights)
        )

    def fit_with_consistent_weights(self, state: State) -> State:
        """Return the fit with weights that agree with its errors."""
        for _ in range(WEIGHINGS):
            state = self.fit(self.update_weights(state))
        return state

    @property
    def channels(self) -> int:
        """Return the number of recorded channels."""
        return self.problem.recordings[0].measured.shape[1]

    def add_best_effect(self, best: State) -> State | None:
        """Return the set with the best further effect, or None if BIC would rise."""
        there = {name_without_prefixes(n) for n in best.effects}
        base = self.linearise(best)
        screened = [
            self.screen_entry(best, base, n)
            for n in self.question.entries
            if name_without_prefixes(n) not in there
        ]
        rows = float(sum(np.isfinite(e).sum() for e in best.errors))
        screened = sorted(
            (x for x in screened if x is not None),
            key=lambda s: s.square + len(s.theta) * np.log(rows),
        )
        full = [self.fit(state) for state in screened[:FULL]]
        first = max(full, key=lambda s: self.gain(best, s), default=best)
        if full and self.gain(best, first) > 0.0:
            return self.fit_with_consistent_weights(first)
        return None

    def prune(self, best: State) -> State:
        """Return the set without effects whose removal lowers BIC."""
        while len(best.effects) > 1:
            fewer = min(
                (self.fit_without(best, n) for n in best.effects), key=lambda s: self.gain(s, best)
            )
            if self.gain(fewer, best) > 0.0:
                break
            best = self.fit_with_consistent_weights(fewer)
        return best

    def fit_without(self, best: State, name: str) -> State:
        """Return the refitted set without one of its effects."""
        left = tuple(n for n in best.effects if n != name)
        pairs = zip(free_parameters(self.question, best.effects), best.theta, strict=True)
        known = {(f.effect, f.name): x for f, x in pairs if f.relative or f.effect != name}
        theta = np.array([known[f.effect, f.name] for f in free_parameters(self.question, left)])
        return self.fit(self.simulate(left, theta, best.starts, best.weights))

    def gain(self, before: State, after: State) -> float:
        """Return the evidence gain of a set over one with one effect fewer [nats]."""
        more = len(after.theta) - len(before.theta)
        prior = self.prior(before.effects, before.theta) - self.prior(after.effects, after.theta)
        return self.judge.gain(before.errors, after.errors, more) + 0.5 * float(
            prior @ np.ones(len(prior))
        )

    # ---- one fit

    def prior(self, effects: tuple[str, ...], theta: Array) -> Array:
        """Return the squared deviations (N,) of the nominal coefficients in specified sds."""
        own = []
        for f, x in zip(free_parameters(self.question, effects), theta, strict=True):
            if f.relative:
                own.append((f.mean, f.sd, x))
        return np.array([((x - mean) / sd) ** 2 for mean, sd, x in own])

    def simulate(
        self, effects: tuple[str, ...], theta: Array, begun: tuple[Array, ...], weights: Array
    ) -> State:
        """Simulate a hypothesis."""
        free, on = (
            free_parameters(self.question, effects),
            self.problem.program.effect_switches(effects),
        )
        errors = tuple(
            e
            for run, s in zip(self.runs, begun, strict=True)
            for e in run.errors(self.problem.parameter_vector(run.track, free, theta), on, s)
        )
        with np.errstate(over="ignore", invalid="ignore"):
            square = sum(float(np.nansum((e * weights) ** 2)) for e in errors)
        gone = any(
            not np.isfinite(e[np.isfinite(m)]).all()
            for e, m in zip(errors, self.measured(), strict=True)
        )
        square += float(self.prior(effects, theta).sum())
        return State(effects, theta, begun, errors, weights, np.inf if gone else square)

    def measured(self) -> list[Array]:
        """Return the recorded values in each window."""
        return [
            run.track.measured[a : b + 1]
            for run in self.runs
            for a, b in zip(run.begins, run.ends, strict=True)
        ]

    def update_weights(self, state: State) -> State:
        """Return the state with channels weighted by the rms and correlation of their errors."""
        weights = 1.0 / (
            rms_by_channel(state.errors)
            * np.sqrt(self.judge.rows_per_independent_value(state.errors))
        )
        return self.simulate(state.effects, state.theta, state.starts, weights)

    def fit(self, state: State) -> State:
        """Take Gauss-Newton steps until the improvement is negligible."""
        return iterate_steps(state, lambda s: self.damped_step(s, self.linearise(s)), ROUNDS)

    def damped_step(self, state: State, linear: LinearisedErrors) -> State | None:
        """Return the state after a step, halved until it improves; None if none improves."""
        free = free_parameters(self.question, state.effects)
        move = bounded_least_squares_step(
            linear.columns, linear.rest, [f.low for f in free], [f.high for f in free], state.theta
        )
        by_window = linear.by_window(move)
        for i in range(HALVINGS):
            share = 0.5**i
            begun = self.shift_starts(state.starts, by_window, share)
            theta = np.clip(
                state.theta + share * move, [f.low for f in free], [f.high for f in free]
            )
            step = self.simulate(state.effects, theta, begun, state.weights)
            if step.square < state.square:
                return step
        return None

    def shift_starts(
        self, begun: tuple[Array, ...], by_window: list[Array], share: float
    ) -> tuple[Array, ...]:
        """Return the starts after a share of a step."""
        moves, out = iter(by_window), []
        for s in begun:
            out.append(s + share * np.array([next(moves) for _ in s]))
        return tuple(out)

    def linearise(self, state: State) -> LinearisedErrors:
        """Linearise a hypothesis in all its fitted values."""
        free = free_parameters(self.question, state.effects)
        on = self.problem.program.effect_switches(state.effects)
        slopes = list[Array]()
        errors = iter(state.errors)
        for run, s in zip(self.runs, state.starts, strict=True):
            own = [next(errors) for _ in s]
            slopes += run.by_starts(
                self.problem.parameter_vector(run.track, free, state.theta), on, s, own
            )
        linear = LinearisedErrors.of(state.errors, state.weights, slopes)
        return linear.with_columns(
            [self.derivative_by_parameter(state, linear, j) for j in range(len(free))],
            self.prior_rows(state),
        )

    def prior_rows(self, state: State) -> tuple[Array, Array]:
        """Return rows (N, F) and errors (N,) of the prior of the nominal coefficients."""
        free = free_parameters(self.question, state.effects)
        own = [j for j, f in enumerate(free) if f.relative]
        slopes = np.zeros((len(own), len(free)))
        for i, j in enumerate(own):
            slopes[i, j] = 1.0 / free[j].sd
        return slopes, np.array([(state.theta[j] - free[j].mean) / free[j].sd for j in own])

    def derivative_by_parameter(self, state: State, linear: LinearisedErrors, j: int) -> Array:
        """Return the derivative of all errors by one parameter."""
        f, moved = free_parameters(self.question, state.effects)[j], state.theta.copy()
        h = STEP * f.sd if state.theta[j] + STEP * f.sd <= f.high else -STEP * f.sd
        moved[j] += h
        beside = self.simulate(state.effects, moved, state.starts, state.weights).errors
        return linear.flat([(a - b) / h for a, b in zip(beside, state.errors, strict=True)])

    def covariance(self, state: State) -> Array:
        """Return the covariance (F, F) of a fit; undetermined values keep their prior spread."""
        J = self.linearise(state).columns
        sd = np.array([f.sd for f in free_parameters(self.question, state.effects)])
        return np.asarray(
            np.linalg.inv((J * sd).T @ (J * sd) + 1e-6 * np.eye(len(sd))) * np.outer(sd, sd)
        )

    # ---- screening of a candidate

    def screen_entry(self, best: State, base: LinearisedErrors, entry: str) -> State | None:
        """Return the set with one more effect after a few steps; None if they do not improve it.

        The derivatives by all other parameters are held.
        """
        effects, found = (*best.effects, entry), list[State]()
        begun_at = as_diagnosis_fit(self.question, best.effects, best.theta, np.zeros((0, 0)))
        for start in starting_points(self.problem, self.question.entries[entry]):
            fit = transfer_coefficient_change(
                add_effect(self.problem, begun_at, entry, start), self.question.entries[entry]
            )
            theta = np.clip(fit.theta, [f.low for f in fit.free], [f.high for f in fit.free])
            begun = self.simulate(effects, theta, best.starts, best.weights)
            step = self.half_step(begun, base) if np.isfinite(begun.square) else None
            if step is not None:
                found.append(step)
        if not found:
            return None
        state = min(found, key=lambda s: s.square)
        for _ in range(SCREENING_ROUNDS - 1):
            state = self.half_step(state, base) or state
        return state

    def half_step(self, state: State, base: LinearisedErrors) -> State | None:
        """Take a step with held derivatives by all but the last effect's parameters."""
        free = free_parameters(self.question, state.effects)
        new = [j for j, f in enumerate(free) if f.effect == state.effects[-1] and not f.relative]
        here = base.about(state.errors)
        columns = []
        for j in range(len(free)):
            columns.append(
                base.raw[:, self.index_before_last_effect(state, j)]
                if j not in new
                else self.derivative_by_parameter(state, here, j)
            )
        return self.damped_step(state, here.with_columns(columns, self.prior_rows(state)))

    def index_before_last_effect(self, state: State, j: int) -> int:
        """Return the index of a parameter before the last effect was added."""
        free = free_parameters(self.question, state.effects)
        rest = [(f.effect, f.name) for f in free if f.effect != state.effects[-1] or f.relative]
        return rest.index((free[j].effect, free[j].name))
