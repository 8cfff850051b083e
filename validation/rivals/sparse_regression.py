"""Sparse regression of accelerations: all entries at once, the least needed taken out one by one while BIC falls.

Positions are smoothed and differentiated twice; what the vessel's laws do not explain is regressed on what each entry
changes (Brunton, Proctor, Kutz 2016), thresholded one entry at a time (Boninsegna, Nueske, Clementi 2018). Entries that
are not linear in their parameters are first fitted alone, and stand in the regression with that shape and what it
changes by near it. Random forces have no course to be regressed on, and a clock that is off no column: left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search.screening import add_effect, hand_over, starts
from boatsim.physics.base import Array, Force, Measurement
from validation.rivals.accelerations import Smoother, held_by, positions, predicted, shown_by
from validation.rivals.evidence import Judge, sizes
from validation.rivals.linear import descended, solved
from validation.rivals.question import Question, fit_of, free_of

STEP = 1e-3  # prior sds by which a parameter is moved for derivatives
RIDGE = 1e-8  # of a column's square
ROUNDS = 3  # Gauss-Newton steps
MOST = 4  # effects
SURE = 1e-3  # of the chance that what is left over is no more than twice the ambient force
TOLERATED = 2.0  # times that force
DRAWS, SEED = 5, 1  # of the noise


@dataclass(frozen=True)
class State:
    """A hypothesis where its fit has come to."""

    effects: tuple[str, ...]
    theta: Array  # (F,)
    errors: tuple[Array, ...]  # (M, NQ) recorded less predicted accelerations of each run
    square: float  # weighted, with the stated spread of the vessel's own coefficients


@dataclass(frozen=True)
class Group:
    """What an entry can change about the nominal's errors."""

    columns: Array  # (R, K) its shape as fitted alone, and how that changes by its parameters
    alone: State


class SparseRegression:
    """One question put to sparse regression."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.question, self.problem = question, question.problem
        late = [
            n
            for n, e in question.entries.items()
            if isinstance(e, Measurement) and type(e).late is not None
        ]
        self.entries = {n: e for n, e in question.entries.items() if n not in late}
        self.judge = Judge(plain, len(self.entries))
        self.smoothers = [
            Smoother.of(t, self.problem.ambient, question.noise) for t in self.problem.recordings
        ]
        self.recorded = [positions(t) for t in self.problem.recordings]
        self.weights = np.ones(self.problem.program.module.NQ)
        self.held = [held_by(t, (), t.values) for t in self.problem.recordings]

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """The effects found, what each gains [nats], whether the cause is unknown."""
        nominal = self.nominal()
        known = self.slopes(nominal)
        groups = {n: g for n in self.entries if (g := self.group(nominal, n, known)) is not None}
        sets = [
            self.refitted(nominal, groups, names)
            for names in self.thresholded(nominal, groups, known)
        ]
        best = max([nominal, *sets], key=lambda s: self.gain(nominal, s))
        best = self.pruned(nominal, best)
        gains = {
            n: self.gain(nominal, best) - self.gain(nominal, self.without(best, n))
            for n in best.effects
        }
        fit = fit_of(self.question, best.effects, best.theta, self.covariance(best))
        return fit, gains, self.beyond_the_water(best)

    # ---- one fit

    def at(self, effects: tuple[str, ...], theta: Array) -> State:
        """A hypothesis evaluated along the recordings."""
        free, on, errors = (
            free_of(self.question, effects),
            self.problem.program.switches(effects),
            list[Array](),
        )
        kinds = [self.entries[n] for n in effects]
        for smoother, recorded, held in zip(self.smoothers, self.recorded, self.held, strict=True):
            track = smoother.track
            values = self.problem.values(track, free, theta)
            true = (
                shown_by(track, recorded, values, on)
                if any(isinstance(e, Measurement) for e in kinds)
                else recorded
            )
            states, accelerations = smoother.motion(true)
            if held.any() and any(not isinstance(e, Measurement | Force) for e in kinds):
                held = held_by(track, effects, values)
            left = accelerations - smoother.blurred(predicted(track, states, held, values, on))
            errors.append(left[smoother.margin : len(left) - smoother.margin])
        with np.errstate(over="ignore", invalid="ignore"):
            square = sum(float(np.sum((e * self.weights) ** 2)) for e in errors)
        square += sum(
            ((x - f.mean) / f.sd) ** 2 for f, x in zip(free, theta, strict=True) if f.relative
        )
        return State(effects, theta, tuple(errors), square if np.isfinite(square) else np.inf)

    def row(self, state: State) -> Array:
        """(R,) weighted errors of both runs, then those of the vessel's own coefficients by what is stated."""
        free = free_of(self.question, state.effects)
        prior = [(x - f.mean) / f.sd for f, x in zip(free, state.theta, strict=True) if f.relative]
        return np.concatenate([*((e * self.weights).ravel() for e in state.errors), prior])

    def slopes(self, state: State, only: str = "") -> Array:
        """(R, F) derivatives of that row by the parameters, or by those of one entry."""
        here, columns = self.row(state), []
        for j, f in enumerate(free_of(self.question, state.effects)):
            if only and (f.relative or f.effect != only):
                continue
            h = STEP * f.sd if state.theta[j] + STEP * f.sd <= f.high else -STEP * f.sd
            moved = state.theta.copy()
            moved[j] += h
            column = (self.row(self.at(state.effects, moved)) - here) / h
            columns.append(np.where(np.isfinite(column), column, 0.0))
        return np.column_stack(columns) if columns else np.zeros((len(here), 0))

    def fitted(self, state: State, rounds: int = ROUNDS, known: Array | None = None) -> State:
        """Gauss-Newton steps, each shortened until it is one for the better.

        `known`: derivatives by the vessel's own coefficients, held.
        """
        free = free_of(self.question, state.effects)
        low, high = [f.low for f in free], [f.high for f in free]

        def stepped(s: State) -> State | None:
            if not np.isfinite(s.square):
                return None
            J = (
                self.slopes(s)
                if known is None
                else np.hstack([known, self.slopes(s, s.effects[-1])])
            )
            move = solved(J, self.row(s), low, high, s.theta)
            nearer = (
                np.clip(s.theta + share * move, low, high) for share in (1.0, 0.5, 0.25, 0.125)
            )
            steps = (self.at(s.effects, theta) for theta in nearer)
            return next((after for after in steps if after.square < s.square), None)

        return descended(state, stepped, rounds)

    def nominal(self) -> State:
        """The vessel recalibrated, each axis weighed by the rms of its errors, those alike counted as fewer."""
        state = self.at((), self.question.start())
        for _ in range(2):
            self.weights = 1.0 / (sizes(state.errors) * np.sqrt(self.judge.alike(state.errors)))
            state = self.fitted(self.at((), state.theta))
        return state

    def covariance(self, state: State) -> Array:
        """(F, F) of a fit; what nothing is known of keeps about its prior spread."""
        sd = np.array([f.sd for f in free_of(self.question, state.effects)])
        J = self.slopes(state) * sd
        return np.asarray(np.linalg.inv(J.T @ J + 1e-6 * np.eye(len(sd))) * np.outer(sd, sd))

    def gain(self, before: State, after: State) -> float:
        """What a set gains over another [nats]."""
        more, entries = (
            len(after.theta) - len(before.theta),
            len(after.effects) - len(before.effects),
        )
        prior = self.prior(before) - self.prior(after)
        return self.judge.gain(before.errors, after.errors, more, entries) + 0.5 * prior

    def prior(self, state: State) -> float:
        """How far the vessel's own coefficients are from what is stated, squares of sds."""
        free = free_of(self.question, state.effects)
        return sum(
            ((x - f.mean) / f.sd) ** 2 for f, x in zip(free, state.theta, strict=True) if f.relative
        )

    # ---- the sparse regression

    def group(self, nominal: State, entry: str, known: Array) -> Group | None:
        """An entry fitted alone, and its columns; None if it runs away or changes nothing."""
        base = fit_of(self.question, (), nominal.theta, np.zeros((0, 0)))
        begun = [
            hand_over(add_effect(self.problem, base, entry, s), self.entries[entry])
            for s in starts(self.problem, self.entries[entry])
        ]
        free = free_of(self.question, (entry,))
        low, high = [f.low for f in free], [f.high for f in free]
        tried = [self.at((entry,), np.clip(f.theta, low, high)) for f in begun]
        first = [self.fitted(s, 1, known) for s in tried if np.isfinite(s.square)]
        if not first:
            return None
        alone = self.fitted(min(first, key=lambda s: s.square), ROUNDS - 1, known)
        slopes = self.slopes(alone, entry)
        shape = self.row(self.at((entry,), self.placed((entry,), [alone, nominal]))) - self.row(
            nominal
        )
        columns = np.column_stack([shape, slopes])
        return Group(columns, alone) if np.isfinite(columns).all() and shape.any() else None

    def placed(self, effects: tuple[str, ...], states: Sequence[State]) -> Array:
        """(F,) parameters of a set, as later ones of some states have them where several do."""
        known = {
            (f.effect, f.name, f.relative): x
            for s in states
            for f, x in zip(free_of(self.question, s.effects), s.theta, strict=True)
        }
        return np.array(
            [known[f.effect, f.name, f.relative] for f in free_of(self.question, effects)]
        )

    def thresholded(
        self, nominal: State, groups: dict[str, Group], own: Array
    ) -> list[tuple[str, ...]]:
        """The sets that are left when the entry which is needed least is taken out again and again."""
        names = list(groups)
        blocks = [own, *(g.columns for g in groups.values())]
        A = np.column_stack(blocks)
        A = A / np.maximum(np.linalg.norm(A, axis=0), 1e-300)
        target = -self.row(nominal)
        G, b = A.T @ A + RIDGE * np.eye(A.shape[1]), A.T @ target
        ends = np.cumsum([x.shape[1] for x in blocks])
        span = {n: np.arange(ends[i], ends[i + 1]) for i, n in enumerate(names)}
        kept, found = names, list[tuple[str, ...]]()

        def explained(left: list[str]) -> float:
            at = np.concatenate([np.arange(ends[0]), *(span[n] for n in left)]).astype(int)
            return float(b[at] @ np.linalg.solve(G[np.ix_(at, at)], b[at]))

        while kept:
            if len(kept) <= MOST and len({called(n) for n in kept}) == len(kept):
                found.append(tuple(kept))
            worth = {n: explained([m for m in kept if m != n]) for n in kept}
            dispensable = max(worth, key=lambda n: worth[n])
            kept = [n for n in kept if n != dispensable]
        return found

    def refitted(self, nominal: State, groups: dict[str, Group], names: tuple[str, ...]) -> State:
        """A set fitted by its own laws, from the fits of its entries alone."""
        alone = [groups[n].alone for n in names]
        return self.fitted(self.at(names, self.placed(names, [*alone, nominal])))

    def without(self, state: State, name: str) -> State:
        """A set without one of its entries, fitted again."""
        left = tuple(n for n in state.effects if n != name)
        return self.fitted(self.at(left, self.placed(left, [state])))

    def pruned(self, nominal: State, best: State) -> State:
        """Without entries that BIC is better off without."""
        while best.effects:
            fewer = max(
                (self.without(best, n) for n in best.effects), key=lambda s: self.gain(nominal, s)
            )
            if self.gain(nominal, fewer) < self.gain(nominal, best):
                break
            best = fewer
        return best

    def beyond_the_water(self, best: State) -> bool:
        """Whether what is left over is surely more than noise and twice the ambient force: a chi-square test."""
        pushed = np.mean(
            [s.pushed(self.problem.ambient, TOLERATED) for s in self.smoothers], axis=0
        )
        expected, alike = pushed + self.by_noise(best), self.judge.alike(best.errors)
        square = sum(float(np.sum(e**2 / expected / alike)) for e in best.errors)
        return bool(chi2.sf(square, sum(float(np.sum(len(e) / alike)) for e in best.errors)) < SURE)

    def by_noise(self, best: State) -> Array:
        """(NQ,) variance of the errors by noise alone, carried through smoothing and laws: as much again is put in."""
        rng, recorded, found = np.random.default_rng(SEED), self.recorded, list[Array]()
        for _ in range(DRAWS):
            self.recorded = [
                y + s.noisy(self.question.noise, rng)
                for y, s in zip(recorded, self.smoothers, strict=True)
            ]
            noisy = self.at(best.effects, best.theta).errors
            found.append(sizes([a - b for a, b in zip(noisy, best.errors, strict=True)]) ** 2)
        self.recorded = recorded
        return np.asarray(np.mean(found, axis=0))
