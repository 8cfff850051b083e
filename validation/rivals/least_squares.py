"""Least squares of trajectories: output error in windows, effects added and taken out one by one while BIC falls.

What is fitted: the vessel's own uncertain coefficients within their stated spread, the parameters of the entries, and
the start of every window. Each channel counts by the rms of its errors. Random forces can not be simulated: they are
left out. It never calls a cause unknown: errors of trajectories that the water pushes about have no size to test by.
"""

from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.screening import add_effect, hand_over, starts
from boatsim.physics.base import Array
from validation.rivals.evidence import Judge, sizes
from validation.rivals.linear import Linear, descended, solved
from validation.rivals.question import Question, fit_of, free_of
from validation.rivals.windows import Windows

MOST = 4  # effects
STEPS = 6  # of the selection
FULL = 4  # entries in front that are fitted in full
ROUNDS, LOOKS = 5, 3  # Gauss-Newton steps of a fit, and of a look at an entry
WEIGHINGS = 2  # fits until the weights agree with the errors
HALVINGS = 6  # of a step that makes things worse
STEP = 1e-3  # prior sds by which a parameter is moved for derivatives
FAR = 5.0  # rms of its channel from which an error is an outlier


@dataclass(frozen=True)
class State:
    """A hypothesis where its fit has come to."""

    effects: tuple[str, ...]
    theta: Array  # (F,)
    starts: tuple[Array, ...]  # of the windows of each run, (W, 2 NQ)
    errors: tuple[Array, ...]  # (M, C) of each window, all runs
    weights: Array  # (C,) per unit of each channel
    square: float  # weighted, with the stated spread of the vessel's own coefficients


class LeastSquares:
    """One question put to least squares."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.question, self.problem = question, question.problem
        self.runs = [Windows.of(t, self.problem.horizon) for t in self.problem.recordings]
        self.judge = Judge(plain, len(question.entries))

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """The effects found, what each gains [nats], whether the cause is unknown."""
        best = self.nominal()
        for _ in range(STEPS):
            found = self.next(best) if len(best.effects) < MOST else None
            fewer = self.pruned(found) if found else best
            if set(fewer.effects) == set(best.effects):  # nothing came in, or it went out again
                break
            best = fewer
        gains = {n: self.gain(self.without(best, n), best) for n in best.effects}
        return fit_of(self.question, best.effects, best.theta, self.covariance(best)), gains, False

    def nominal(self) -> State:
        """The vessel recalibrated, outliers taken out."""
        begun = self.at(
            (), self.question.start(), tuple(w.guess() for w in self.runs), np.ones(self.channels)
        )
        found = self.settled(begun)
        masks = [np.abs(e) > FAR * sizes(found.errors) for e in found.errors]
        for run, measured in zip(
            self.runs, (t.measured for t in self.problem.recordings), strict=True
        ):
            for w in range(len(run.begins)):
                measured[run.begins[w] : run.ends[w] + 1][masks.pop(0)] = np.nan
        return self.settled(self.at((), found.theta, found.starts, found.weights))

    def settled(self, state: State) -> State:
        """Fitted with weights that fit its errors."""
        for _ in range(WEIGHINGS):
            state = self.fitted(self.weighed(state))
        return state

    @property
    def channels(self) -> int:
        """How many are recorded."""
        return self.problem.recordings[0].measured.shape[1]

    def next(self, best: State) -> State | None:
        """The best of the entries on top of a set, or none if BIC would rise."""
        there = {called(n) for n in best.effects}
        base = self.linear(best)
        looks = [self.look(best, base, n) for n in self.question.entries if called(n) not in there]
        rows = float(sum(np.isfinite(e).sum() for e in best.errors))
        looks = sorted(
            (x for x in looks if x is not None),
            key=lambda s: s.square + len(s.theta) * np.log(rows),
        )
        full = [self.fitted(look) for look in looks[:FULL]]
        first = max(full, key=lambda s: self.gain(best, s), default=best)
        return self.settled(first) if full and self.gain(best, first) > 0.0 else None

    def pruned(self, best: State) -> State:
        """Without entries that BIC is better off without since others came in."""
        while len(best.effects) > 1:
            fewer = min(
                (self.without(best, n) for n in best.effects), key=lambda s: self.gain(s, best)
            )
            if self.gain(fewer, best) > 0.0:
                break
            best = self.settled(fewer)
        return best

    def without(self, best: State, name: str) -> State:
        """A set without one of its entries, fitted again."""
        left = tuple(n for n in best.effects if n != name)
        pairs = zip(free_of(self.question, best.effects), best.theta, strict=True)
        known = {(f.effect, f.name): x for f, x in pairs if f.relative or f.effect != name}
        theta = np.array([known[f.effect, f.name] for f in free_of(self.question, left)])
        return self.fitted(self.at(left, theta, best.starts, best.weights))

    def gain(self, before: State, after: State) -> float:
        """What a set gains over one with an entry less [nats]."""
        more = len(after.theta) - len(before.theta)
        prior = self.prior(before.effects, before.theta) - self.prior(after.effects, after.theta)
        return self.judge.gain(before.errors, after.errors, more) + 0.5 * float(
            prior @ np.ones(len(prior))
        )

    # ---- one fit

    def prior(self, effects: tuple[str, ...], theta: Array) -> Array:
        """(N,) squares of how far the vessel's own coefficients are from what is stated, in stated sds."""
        own = [
            (f.mean, f.sd, x)
            for f, x in zip(free_of(self.question, effects), theta, strict=True)
            if f.relative
        ]
        return np.array([((x - mean) / sd) ** 2 for mean, sd, x in own])

    def at(
        self, effects: tuple[str, ...], theta: Array, begun: tuple[Array, ...], weights: Array
    ) -> State:
        """A hypothesis simulated."""
        free, on = free_of(self.question, effects), self.problem.program.switches(effects)
        errors = tuple(
            e
            for run, s in zip(self.runs, begun, strict=True)
            for e in run.errors(self.problem.values(run.track, free, theta), on, s)
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
        """What was recorded in each window."""
        return [
            run.track.measured[a : b + 1]
            for run in self.runs
            for a, b in zip(run.begins, run.ends, strict=True)
        ]

    def weighed(self, state: State) -> State:
        """The same with each channel weighed by the rms of its errors, those alike counted as fewer."""
        weights = 1.0 / (sizes(state.errors) * np.sqrt(self.judge.alike(state.errors)))
        return self.at(state.effects, state.theta, state.starts, weights)

    def fitted(self, state: State) -> State:
        """Gauss-Newton steps until they gain next to nothing."""
        return descended(state, lambda s: self.damped_step(s, self.linear(s)), ROUNDS)

    def stepped(self, state: State, linear: Linear) -> State | None:
        """After a step, shortened until it is one for the better; None if none is."""
        free = free_of(self.question, state.effects)
        move = solved(
            linear.columns, linear.rest, [f.low for f in free], [f.high for f in free], state.theta
        )
        by_window = linear.by_window(move)
        for i in range(HALVINGS):
            share = 0.5**i
            begun = self.shifted(state.starts, by_window, share)
            theta = np.clip(
                state.theta + share * move, [f.low for f in free], [f.high for f in free]
            )
            step = self.at(state.effects, theta, begun, state.weights)
            if step.square < state.square:
                return step
        return None

    def shifted(
        self, begun: tuple[Array, ...], by_window: list[Array], share: float
    ) -> tuple[Array, ...]:
        """Starts moved by a share of a step."""
        moves, out = iter(by_window), []
        for s in begun:
            out.append(s + share * np.array([next(moves) for _ in s]))
        return tuple(out)

    def linear(self, state: State) -> Linear:
        """A hypothesis linearised by all that it fits."""
        free, on = (
            free_of(self.question, state.effects),
            self.problem.program.switches(state.effects),
        )
        slopes = list[Array]()
        errors = iter(state.errors)
        for run, s in zip(self.runs, state.starts, strict=True):
            own = [next(errors) for _ in s]
            slopes += run.by_starts(self.problem.values(run.track, free, state.theta), on, s, own)
        linear = Linear.of(state.errors, state.weights, slopes)
        return linear.add_effect(
            [self.column(state, linear, j) for j in range(len(free))], self.prior_rows(state)
        )

    def prior_rows(self, state: State) -> tuple[Array, Array]:
        """Rows (N, F) and errors (N,) that hold the vessel's own coefficients near what is stated."""
        free = free_of(self.question, state.effects)
        own = [j for j, f in enumerate(free) if f.relative]
        slopes = np.zeros((len(own), len(free)))
        for i, j in enumerate(own):
            slopes[i, j] = 1.0 / free[j].sd
        return slopes, np.array([(state.theta[j] - free[j].mean) / free[j].sd for j in own])

    def column(self, state: State, linear: Linear, j: int) -> Array:
        """Derivative of all errors by one parameter."""
        f, moved = free_of(self.question, state.effects)[j], state.theta.copy()
        h = STEP * f.sd if state.theta[j] + STEP * f.sd <= f.high else -STEP * f.sd
        moved[j] += h
        beside = self.at(state.effects, moved, state.starts, state.weights).errors
        return linear.flat([(a - b) / h for a, b in zip(beside, state.errors, strict=True)])

    def covariance(self, state: State) -> Array:
        """(F, F) of a fit; what nothing is known of keeps its prior spread."""
        J = self.linear(state).columns
        sd = np.array([f.sd for f in free_of(self.question, state.effects)])
        return np.asarray(
            np.linalg.inv((J * sd).T @ (J * sd) + 1e-6 * np.eye(len(sd))) * np.outer(sd, sd)
        )

    # ---- a quick look at an entry

    def look(self, best: State, base: Linear, entry: str) -> State | None:
        """An entry on top of a set: a few steps with the derivatives of all else held; None if nothing comes of it."""
        effects, found = (*best.effects, entry), list[State]()
        begun_at = fit_of(self.question, best.effects, best.theta, np.zeros((0, 0)))
        for start in starts(self.problem, self.question.entries[entry]):
            fit = hand_over(
                add_effect(self.problem, begun_at, entry, start), self.question.entries[entry]
            )
            theta = np.clip(fit.theta, [f.low for f in fit.free], [f.high for f in fit.free])
            begun = self.at(effects, theta, best.starts, best.weights)
            step = self.half_step(begun, base) if np.isfinite(begun.square) else None
            if step is not None:
                found.append(step)
        if not found:
            return None
        state = min(found, key=lambda s: s.square)
        for _ in range(LOOKS - 1):
            state = self.half_step(state, base) or state
        return state

    def half_step(self, state: State, base: Linear) -> State | None:
        """A step with the derivatives by all but the last entry as they were in the base."""
        free = free_of(self.question, state.effects)
        new = [j for j, f in enumerate(free) if f.effect == state.effects[-1] and not f.relative]
        here = base.about(state.errors)
        columns = [
            base.raw[:, self.before(state, j)] if j not in new else self.column(state, here, j)
            for j in range(len(free))
        ]
        return self.damped_step(state, here.add_effect(columns, self.prior_rows(state)))

    def before(self, state: State, j: int) -> int:
        """Where a parameter was before the last entry came in."""
        free = free_of(self.question, state.effects)
        rest = [(f.effect, f.name) for f in free if f.effect != state.effects[-1] or f.relative]
        return rest.index((free[j].effect, free[j].name))
