"""Size of a stochastic force on parts of the data, which no regression of the motion tells.

A stochastic force changes the predicted variances of the filter, not its predictions, so that the
size on a part follows from the likelihood of the variances: one step of Fisher scoring for the
factor of the variance (R. A. Fisher, Theory of statistical estimation, Proc. Camb. Phil. Soc. 22,
1925). A force of constant variance has the same size in every part, as far as its sd tells; one
that acts under load only, in a turn or at one speed, has not.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.problem import FilterPasses, Fit, Problem
from boatsim.physics.base import Array
from boatsim.physics.kernel.correction import GATE

LARGEST = GATE * (1.0 - 1e-9)  # [sd] prediction error of what is no outlier, despite rounding
STEP = 0.1  # of the logarithm of the rms force: its central difference has an error below 1 %


@dataclass(frozen=True)
class VarianceScore:
    """Derivative of the log-likelihood of each row by a factor of the variance of a force.

    Attributes:
        score: (rows,) derivative at the fitted variance.
        information: (rows,) its expected variance.
    """

    score: Array
    information: Array

    @classmethod
    def of_effect(cls, problem: Problem, fit: Fit, name: str) -> Self:
        """Return the score of a stochastic effect by central differences of the filter.

        Args:
            problem: The recordings.
            fit: Converged fit with the effect.
            name: Name of the effect.
        """
        strength = type(problem.candidates[name]).strength
        own = [i for i, f in enumerate(fit.free) if f.effect == name and f.name in strength]
        less, more = (_scaled(problem, fit, own, np.exp(sign * STEP)) for sign in (-1.0, 1.0))
        on = problem.program.effect_switches(fit.effects)
        here = problem.filter(fit.free, fit.theta, on, fit.levels)
        scale = _scales(here)
        known = scale > 0.0  # elsewhere nothing was recorded
        for passes in (less, here, more):  # the filter lowers the weight of an outlier
            known &= np.abs(passes.whitened) < LARGEST
        # derivatives by the log of the variance: of the prediction in sds, and of the log of the sd
        low, high = _scales(less)[known], _scales(more)[known]
        shift = (more.whitened[known] / high - less.whitened[known] / low) * scale[known]
        shift /= 4.0 * STEP
        widening = np.log(low / high) / (4.0 * STEP)
        white = here.whitened[known]
        score, information = np.zeros(len(scale)), np.zeros(len(scale))
        score[known] = widening * (white**2 - 1.0) - white * shift
        information[known] = 2.0 * widening**2 + shift**2
        return cls(score, information)

    def sizes(self, groups: NDArray[np.int_], prior_sd: float) -> tuple[Array, Array]:
        """Return the rms force on each group of rows, relative to the fitted one.

        Args:
            groups: (rows,) number of the group of each row; -1 for none.
            prior_sd: Prior sd of a size.

        Returns:
            Sizes (K,) and their covariance (K, K), which is diagonal.
        """
        used = groups >= 0
        count = int(groups.max()) + 1
        score = np.bincount(groups[used], self.score[used], count)
        # a size is the root of a factor of the variance, with half its sd
        information = np.bincount(groups[used], self.information[used], count)
        precision = information + 0.25 / prior_sd**2
        return 1.0 + 0.5 * score / precision, np.diag(0.25 / precision)


def _scaled(problem: Problem, fit: Fit, own: list[int], factor: float) -> FilterPasses:
    """Passes with another rms force."""
    theta = fit.theta.copy()
    theta[own] *= factor
    on = problem.program.effect_switches(fit.effects)
    return problem.filter(fit.free, theta, on, fit.levels)


def _scales(passes: FilterPasses) -> Array:
    """(rows,) inverse sds of the prediction errors."""
    return np.concatenate([one.scale.ravel() for one in passes.passes])
