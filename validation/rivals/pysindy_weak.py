"""PySINDy on a trial: weak form, ensembles of sparse regressions, inclusion probabilities.

Weak form (Messenger, Bortz 2021; `pysindy.WeakPDELibrary`): the rate of the residual velocity is
integrated against compact test functions, so that the recorded velocity is not differentiated.
Ensemble (Fasel, Kutz, Brunton, Brunton 2022; `pysindy.EnsembleOptimizer`): sequentially thresholded
least squares of bootstrapped rows; a candidate is named if it is included in most models, and its
parameters are the medians. All axes and recordings share the coefficients, because an effect of the
library is a force with several components. The threshold is chosen by the error in the other
recording, as the PySINDy documentation advises to choose it by cross-validation.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from validation.rivals.packages import import_package
from validation.rivals.question import Question, as_diagnosis_fit, free_parameters
from validation.rivals.residual_columns import Column, ResidualColumns

SEED = 1  # of the places of the test functions and of the bootstrap
FUNCTIONS = 100  # test functions a recording, the default of the package
POWER = 4  # polynomial order of a test function, the default of the package
HALF_WIDTHS = 1 / 20  # half of a test function, share of a recording; default of the package
MODELS = 100  # models of the ensemble; the default of 20 leaves probabilities in steps of 5 %
INCLUDED = 0.6  # least inclusion probability of a candidate that is named
THRESHOLDS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8)  # of coefficients of columns with unit rms
RIDGES = (
    0.05,
    5.0,
    50.0,
    500.0,
)  # from the default of STLSQ to those of a library of similar terms
ELBOW = 0.05  # relative increase of the error that a smaller model may have
MOST = 4  # largest number of effects, as for the other methods
ALMOST_ONE = 0.99  # an inclusion probability above this counts as this in the log odds


@dataclass(frozen=True)
class WeakSystem:
    """Weak form of one recording, in units of the residual's rms in each axis."""

    features: Array  # (NQ FUNCTIONS, columns)
    target: Array  # (NQ FUNCTIONS,)


class PySindyWeak:
    """PySINDy's answer to one trial."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.question = question
        self.pysindy = import_package("pysindy", "pysindy_weak")
        self.residuals = ResidualColumns(question)

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, log odds of inclusion of each effect, and False: never unknown."""
        columns, systems = self.library()
        threshold, ridge = self.choose_regularisation(systems)
        models = self.ensemble(systems, threshold, ridge)
        probabilities = inclusion_probabilities(columns, models)
        named = [n for n in probabilities if probabilities[n] >= INCLUDED]
        named = sorted(named, key=lambda n: -rms_share(columns, models, n))[:MOST]
        gains = {}
        for n in named:
            p = min(probabilities[n], ALMOST_ONE)
            gains[n] = float(np.log(p / (1.0 - p)))
        return self.as_fit(columns, models, tuple(named)), gains, False

    # ---- weak form

    def library(self) -> tuple[list[Column], list[WeakSystem]]:
        """Return the columns, scaled to unit rms, and the weak forms of the recordings.

        A candidate that is not linear in its parameters is represented by the starting point that
        explains most of the residual.
        """
        groups = [self.residuals.vessel_columns()]
        rivals: list[list[int]] = [[0]]  # groups of which one is kept
        for entry in self.residuals.entries():
            starts = self.residuals.entry_columns(entry)
            rivals.append(list(range(len(groups), len(groups) + len(starts))))
            groups += starts
        every = [c for group in groups for c in group]
        systems = self.weak_systems(every)
        ends = np.cumsum([len(group) for group in groups])
        kept: list[int] = []
        for numbers in rivals:
            spans = [list(range(ends[g] - len(groups[g]), ends[g])) for g in numbers]
            if spans:
                kept += min(spans, key=lambda span: left_unexplained(systems, span))
        scale = np.sqrt(np.mean(np.vstack([s.features for s in systems]) ** 2, axis=0))
        columns = [scaled(every[k], 1.0 / float(scale[k])) for k in kept]
        found = [WeakSystem(s.features[:, kept] / scale[kept], s.target) for s in systems]
        return columns, found

    def weak_systems(self, columns: Sequence[Column]) -> list[WeakSystem]:
        """Return the weak form of each recording, all axes stacked."""
        velocities = self.residuals.residual_velocities()
        targets, features = [], []
        for i, track in enumerate(self.residuals.problem.recordings):
            library = self.weak_library(track.times, len(columns))
            rates = np.stack([c.rates[i] for c in columns], axis=2)  # (N, NQ, columns)
            targets.append(np.asarray(library.convert_u_dot_integral(velocities[i])))
            features.append([self.integrate(library, rates[:, a]) for a in range(rates.shape[1])])
        rms = np.sqrt(np.mean(np.vstack(targets) ** 2, axis=0)) + 1e-300  # (NQ,)
        systems = []
        for target, parts in zip(targets, features, strict=True):
            weighted = [f / r for f, r in zip(parts, rms, strict=True)]
            systems.append(WeakSystem(np.vstack(weighted), (target / rms).T.ravel()))
        return systems

    def weak_library(self, times: Array, columns: int) -> Any:
        """Return the library of test functions of one recording."""
        linear = self.pysindy.PolynomialLibrary(degree=1, include_bias=False)
        span = float(times[-1] - times[0])
        np.random.seed(SEED)
        return self.pysindy.WeakPDELibrary(
            function_library=linear,
            spatiotemporal_grid=times,
            K=FUNCTIONS,
            H_xt=HALF_WIDTHS * span,
            p=POWER,
        )

    def integrate(self, library: Any, rates: Array) -> Array:
        """Return the integrals (FUNCTIONS, columns) of rates (N, columns) by test functions."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on the axes of its own arrays
            x = self.pysindy.AxesArray(rates, {"ax_time": 0, "ax_coord": 1})
            return np.asarray(library.fit([x]).transform([x])[0])

    # ---- sparse regression

    def choose_regularisation(self, systems: Sequence[WeakSystem]) -> tuple[float, float]:
        """Return the threshold and ridge of the smallest model that predicts well.

        The error is that in recordings that were not fitted (cross-validation).
        """
        errors, terms = {}, {}
        for threshold, ridge in product(THRESHOLDS, RIDGES):
            error, count = 0.0, 0
            for i, held_out in enumerate(systems):
                rest = [s for j, s in enumerate(systems) if j != i]
                single = self.pysindy.STLSQ(threshold=threshold, alpha=ridge)
                model = fit_rows(single, rest).coef_[0]
                count += int(np.count_nonzero(model))
                error += float(np.mean((held_out.target - held_out.features @ model) ** 2))
            errors[threshold, ridge], terms[threshold, ridge] = error, count
        allowed = (1.0 + ELBOW) * min(errors.values())
        good = [k for k, error in errors.items() if error <= allowed]
        return min(good, key=lambda k: (terms[k], errors[k]))

    def ensemble(self, systems: Sequence[WeakSystem], threshold: float, ridge: float) -> Array:
        """Return the coefficients (MODELS, columns) of an ensemble of sparse regressions."""
        single = self.pysindy.STLSQ(threshold=threshold, alpha=ridge)
        optimizer = self.pysindy.EnsembleOptimizer(single, bagging=True, n_models=MODELS)
        np.random.seed(SEED)  # the package samples from numpy's global generator
        return np.array(fit_rows(optimizer, systems).coef_list)[:, 0]

    def as_fit(self, columns: Sequence[Column], models: Array, named: tuple[str, ...]) -> Fit:
        """Return the medians of the ensemble as a hypothesis with the named effects."""
        free = free_parameters(self.question, named)
        place = {(f.effect, f.name): i for i, f in enumerate(free)}
        theta = np.array([f.mean for f in free])
        variance = np.array([f.sd**2 for f in free])
        for k, column in enumerate(columns):
            if column.entry and column.entry not in named:
                continue
            own = free_parameters(self.question, (column.entry,) if column.entry else ())
            if column.entry:
                for j, f in enumerate(own):
                    if f.effect == column.entry and not f.relative:
                        self._hold_start(theta, place, column, j, columns)
            size, sd = float(np.median(models[:, k])), float(np.std(models[:, k]))
            for j, unit in zip(column.parameters, column.per_unit, strict=True):
                i = place[own[j].effect, own[j].name]
                theta[i] = free[i].mean + size * unit
                variance[i] = max((sd * unit) ** 2, 1e-18)
        theta = np.clip(theta, [f.low for f in free], [f.high for f in free])
        return as_diagnosis_fit(self.question, named, theta, np.diag(variance))

    def _hold_start(
        self,
        theta: Array,
        place: dict[tuple[str, str], int],
        column: Column,
        j: int,
        columns: Sequence[Column],
    ) -> None:
        """Put the value of the starting point in where no column determines a parameter."""
        determined = [i for c in columns if c.entry == column.entry for i in c.parameters]
        if j not in determined:
            f = free_parameters(self.question, (column.entry,))[j]
            theta[place[f.effect, f.name]] = column.start[j]


def fit_rows(optimizer: Any, systems: Sequence[WeakSystem]) -> Any:
    """Fit an optimizer of the package to the rows of all systems and return it."""
    A = np.vstack([s.features for s in systems])
    b = np.concatenate([s.target for s in systems])[:, None]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # on models without any term
        optimizer.fit(A, b)
    return optimizer


def left_unexplained(systems: Sequence[WeakSystem], span: list[int]) -> float:
    """Return the sum of squares that some columns leave in a least-squares fit."""
    A = np.vstack([s.features[:, span] for s in systems])
    b = np.concatenate([s.target for s in systems])
    return float(np.sum((b - A @ np.linalg.lstsq(A, b, rcond=None)[0]) ** 2))


def scaled(column: Column, factor: float) -> Column:
    """Return a column whose coefficient has another unit."""
    per_unit = tuple(x * factor for x in column.per_unit)
    return replace(column, per_unit=per_unit)


def rms_share(columns: Sequence[Column], models: Array, entry: str) -> float:
    """Return the norm of a candidate's median coefficients, whose columns have unit rms."""
    own = [k for k, c in enumerate(columns) if c.entry == entry]
    return float(np.linalg.norm(np.median(models[:, own], axis=0)))


def inclusion_probabilities(columns: Sequence[Column], models: Array) -> dict[str, float]:
    """Return the share of the models in which each candidate has a coefficient.

    Args:
        columns: Columns (K,) of the library.
        models: Coefficients (M, K) of the ensemble.
    """
    found = {}
    for entry in dict.fromkeys(c.entry for c in columns if c.entry):
        own = [k for k, c in enumerate(columns) if c.entry == entry]
        found[entry] = float(np.mean((models[:, own] != 0.0).any(axis=1)))
    return found
