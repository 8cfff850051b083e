"""Consistency of identified effects: signs by which a true effect differs from a stand-in.

A stand-in is a candidate that is selected because the true cause is not among the candidates. It
fits the data on average. A true effect has the same size on every part of the data, in every
regime of speed, command and heading, and on recordings that did not select it (invariance: J.
Peters, P. Buehlmann, N. Meinshausen, Causal inference by using invariant prediction, J. R. Statist.
Soc. B 78, 2016; stability: N. Meinshausen, P. Buehlmann, Stability selection, J. R. Statist. Soc. B
72, 2010). The size on a part is estimated as a factor of the fitted effect, by linear regression of
the filter's whitened prediction errors. These are independent from row to row, so that rows may be
grouped by any quantity that is known before the row.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import DecideConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.fit import jacobian
from boatsim.diagnosis.locate.residual_structure import find_structure
from boatsim.diagnosis.locate.smoothing import latent_force
from boatsim.diagnosis.open_set.effect_axes import effect_axes
from boatsim.diagnosis.open_set.stochastic_size import VarianceScore
from boatsim.diagnosis.problem import FilterPasses, Fit, Problem, prior_arrays
from boatsim.physics.base import Array, Effect, RandomForce

# From the group of each row to the size of an effect on each group (K,), and its covariance (K, K)
SizeOnParts = Callable[[NDArray[np.int_]], tuple[Array, Array]]
# [nats] gain of an effect without which the vessel diverges: more than any recording tells
DIVERGES = 1e6


@dataclass(frozen=True)
class Factor:
    """Size of an identified effect on a part of the data, relative to its fitted size.

    The size on all data is 1. A true effect has about the same size in every recording.
    """

    value: float
    sd: float

    @property
    def significance(self) -> float:
        """Size of the effect on this part of the data, in standard deviations from zero."""
        return self.value / self.sd


@dataclass(frozen=True)
class Variation:
    """How much the size of an identified effect varies between parts of the data.

    A true effect has the same size everywhere.
    """

    excess: float  # sd between the parts beyond their own sd, as a share of the fitted size
    chi_square: float  # of the hypothesis that the size is the same
    dof: int
    precision: float = 0.0  # mean inverse variance of the size on a part, as a share of the size

    @property
    def ratio(self) -> float:
        """Chi-square per degree of freedom of the hypothesis that the effect's size is constant.

        It is 1 on average if the size is the same on all parts of the data.
        """
        return self.chi_square / self.dof if self.dof else 1.0


@dataclass(frozen=True)
class Consistency:
    """Statistics of one identified effect that tell a true cause from a stand-in.

    A stand-in is an effect that only imitates an unmodelled cause. Its size varies between
    recordings, times and conditions, and it does not improve predictions of held-out recordings.

    Attributes:
        recordings: Size on each fitted recording, relative to the fitted size.
        held_out: Size on the held-out recordings, relative to the fitted size.
        between_times: Variation between parts in time.
        between_ranges: Largest variation between ranges of a speed, a command or the heading.
        quantity: That quantity, in words.
        parts_that_gain: Share of the parts in time whose likelihood increases by the effect.
        held_out_gain: Log-likelihood that held-out recordings gain by it [nats].
        axes: Axes along which it acts; all for an error of an instrument.
        alternative_gain: Evidence of the best single-term force along these axes in its place
            [nats], at the level of the latent force that is fitted without the effect.
        prior_distance: Largest distance of its parameters from zero effect, in prior sds; 0 for an
            effect of the surroundings, whose prior is a usual level and no limit of the plausible.
        at_bound: Whether a parameter is at a bound of its range.
    """

    recordings: tuple[Factor, ...]
    held_out: Factor
    between_times: Variation
    between_ranges: Variation
    quantity: str
    parts_that_gain: float
    held_out_gain: float
    axes: tuple[str, ...]
    alternative_gain: float
    prior_distance: float
    at_bound: bool


@dataclass(frozen=True)
class _Linearised:
    """Whitened errors of a fit, and their derivatives by the parameters in prior sds."""

    passes: FilterPasses
    jacobian: Array  # (rows, F)

    @property
    def whitened(self) -> Array:
        """(rows,) whitened errors."""
        return self.passes.whitened


def effect_consistency(
    problem: Problem,
    best: Fit,
    without_each: Mapping[str, Fit],
    held_out: Sequence[MappedRecording],
) -> dict[str, Consistency]:
    """Return statistics of each identified effect that tell a true cause from a stand-in.

    A stand-in is an effect that only imitates the true cause. The statistics compare the effect's
    size between recordings, times and ranges of speed and command, and state by how much it
    raises the log likelihood of held-out recordings.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        best: Converged fit of the vessel model with some candidate effects.
        without_each: Fits without one of the effects, by the name of that effect.
        held_out: Held-out recordings, which no fit has used.

    Returns:
        Statistics by name of the effect.
    """
    if not best.effects:
        return {}
    config = problem.config.decide
    fitted = _linearised(problem, best)
    parts = _parts_in_time(problem, config.time_parts)
    ranges = list(_ranges(problem, best))
    rates = [f"{axis} rate" for axis in problem.program.vessel.dof]
    unseen_problem = problem.with_recordings(held_out)
    unseen = _linearised(unseen_problem, best) if held_out else None
    found = {}
    for name, without in without_each.items():
        part = _size_on_parts(problem, best, fitted, name)
        times, runs = part(parts), part(_recordings(problem))
        worst, quantity = Variation(0.0, 0.0, 0), ""
        for words, groups in ranges:
            if words in rates and isinstance(problem.candidates[name], RandomForce):
                continue  # the estimated motion of a row depends on its own random force
            variation = _variation(*part(groups), config)
            if variation.ratio > worst.ratio or not quantity:
                worst, quantity = variation, words
        unseen_factor, unseen_gain = Factor(0.0, config.unknown_factor_sd), 0.0
        if unseen is not None:
            unseen_factor = _held_out_size(unseen_problem, best, fitted, unseen, name, part)
            unseen_gain = _gain(unseen_problem, best, without)
        axes = effect_axes(problem, best, name)
        found[name] = Consistency(
            tuple(map(Factor, runs[0].tolist(), np.sqrt(np.diag(runs[1])).tolist())),
            unseen_factor,
            _variation(*times, config),
            worst,
            quantity,
            _parts_that_gain(problem, best, without, parts),
            unseen_gain,
            axes,
            find_structure(problem, without, without.levels).gain_along(axes),
            _prior_distance(problem, best, name),
            _at_bound(best, name, problem.config.answer.at_bound),
        )
    return found


def _size_on_parts(problem: Problem, best: Fit, fitted: _Linearised, name: str) -> SizeOnParts:
    """Return a function from groups of rows to the size of an effect on each, with covariance."""
    config = problem.config.decide
    effect = problem.candidates[name]
    if isinstance(effect, RandomForce):
        score = VarianceScore.of_effect(problem, best, name)
        return lambda groups: score.sizes(groups, config.prior_factor_sd)
    size = _change_by_factor(best, effect)
    direction = _direction(best, fitted.jacobian, name, size)
    nuisance = _nuisance(best, fitted.jacobian, name, size)
    return lambda groups: _factors(fitted.whitened, direction, nuisance, groups, config)


def _linearised(problem: Problem, fit: Fit) -> _Linearised:
    """A fit linearised with the gains of the filter held."""
    on = problem.program.effect_switches(fit.effects)
    passes = problem.filter(fit.free, fit.theta, on, fit.levels)
    return _Linearised(passes, jacobian(problem, fit.free, fit.theta, on, fit.levels, passes))


def _own(fit: Fit, name: str) -> list[int]:
    """Places of an effect's own parameters among the free parameters of a fit."""
    return [i for i, f in enumerate(fit.free) if f.effect == name and not f.relative]


def _size(fit: Fit, name: str) -> Array:
    """(P,) own parameters of an effect relative to zero effect, in prior sds."""
    own = _own(fit, name)
    priors = prior_arrays(fit.free)
    return (fit.theta[own] - priors.mean[own]) / priors.sd[own]


def _change_by_factor(fit: Fit, effect: Effect) -> Array:
    """(P,) change of an effect's own parameters by a factor of its size, in prior sds.

    The size of an effect with a limit, as of a rate, is the inverse of that limit.
    """
    own = _own(fit, effect.name)
    change = _size(fit, effect.name)
    for k, place in enumerate(own):
        if fit.free[place].name in type(effect).limits:
            change[k] = -fit.theta[place] / fit.free[place].sd
    return change


def _direction(fit: Fit, J: Array, name: str, size: Array) -> Array:
    """(rows,) derivative of the whitened errors by a common factor of an effect's parameters."""
    return np.asarray(J[:, _own(fit, name)] @ size)


def _nuisance(fit: Fit, J: Array, name: str, size: Array) -> Array:
    """(rows, F - 1) derivatives by all other parameters and by the other directions of its own."""
    own = _own(fit, name)
    others = np.delete(J, own, axis=1)
    length = float(np.linalg.norm(size))
    if len(own) < 2 or length == 0.0:
        return others
    # the last right singular vectors span all directions at right angles to the size
    _, _, rotated = np.linalg.svd(size[None, :] / length)
    return np.hstack([others, J[:, own] @ rotated[1:].T])


def _factors(
    white: Array,
    direction: Array,
    nuisance: Array,
    groups: NDArray[np.int_],
    config: DecideConfig,
) -> tuple[Array, Array]:
    """Return the factor of an effect on each group of rows, and the covariance of the factors.

    All other parameters are common to the groups.

    Args:
        white: (rows,) whitened errors.
        direction: (rows,) their derivative by a factor of the effect.
        nuisance: (rows, N) their derivatives by everything else, in prior sds.
        groups: (rows,) number of the group of each row; -1 for none.
        config: Prior sd of a factor.
    """
    count = int(groups.max()) + 1
    separate = np.zeros((len(white), count))
    used = np.flatnonzero(groups >= 0)
    separate[used, groups[used]] = direction[used]
    columns = np.hstack([nuisance, separate])
    information = columns.T @ columns
    precision = config.prior_factor_sd**-2
    prior = np.concatenate([np.ones(nuisance.shape[1]), np.full(count, precision)])
    information[np.diag_indices(len(prior))] += prior
    # the fit is a maximum: the gradient by the common parameters is zero with their prior
    score = np.concatenate([np.zeros(nuisance.shape[1]), separate.T @ white])
    covariance = np.linalg.inv(information)[-count:]
    return 1.0 - covariance @ score, covariance[:, -count:]


def _variation(factors: Array, covariance: Array, config: DecideConfig) -> Variation:
    """Return the variation between factors (K,) beyond their covariance (K, K).

    The excess is the moment estimate of R. DerSimonian and N. Laird, Meta-analysis in clinical
    trials, Controlled Clinical Trials 7, 1986.
    """
    variance = np.diag(covariance)
    # other parts do not determine the factor
    known = np.flatnonzero(variance < config.comparable_factor_sd**2)
    if len(known) < 2:
        return Variation(0.0, 0.0, 0)
    values = factors[known]
    precision = np.linalg.inv(covariance[np.ix_(known, known)])
    ones = np.ones(len(known))
    mean = float(ones @ precision @ values) / float(ones @ precision @ ones)
    off = values - mean
    chi_square = float(off @ precision @ off)
    dof = len(known) - 1
    weights = 1.0 / variance[known]
    scale = float(weights.sum() - np.sum(weights**2) / weights.sum())
    excess = max(0.0, (chi_square - dof) / scale) if scale > 0.0 else 0.0
    return Variation(float(np.sqrt(excess)), chi_square, dof, scale / dof)


def _held_out_size(
    unseen_problem: Problem,
    best: Fit,
    fitted: _Linearised,
    unseen: _Linearised,
    name: str,
    part: SizeOnParts,
) -> Factor:
    """Return the size of an effect on held-out recordings, given the fit to the others."""
    config = unseen_problem.config.decide
    effect = unseen_problem.candidates[name]
    if not isinstance(effect, RandomForce):
        change = _change_by_factor(best, effect)
        return _held_out_factor(best, fitted, unseen, name, change, config)
    if not np.isfinite(unseen.whitened).all():
        return Factor(0.0, config.unknown_factor_sd)
    _, of_fit = part(np.zeros(len(fitted.whitened), dtype=int))
    score = VarianceScore.of_effect(unseen_problem, best, name)
    everything = np.zeros(len(unseen.whitened), dtype=int)
    size, own = score.sizes(everything, config.prior_factor_sd)
    return Factor(float(size[0]), float(np.sqrt(of_fit[0, 0] + own[0, 0])))


def _held_out_factor(
    best: Fit,
    fitted: _Linearised,
    unseen: _Linearised,
    name: str,
    size: Array,
    config: DecideConfig,
) -> Factor:
    """Return the factor of an effect on held-out recordings, given the fit to the others."""
    direction = _direction(best, unseen.jacobian, name, size)
    columns = np.hstack([unseen.jacobian, direction[:, None]])
    if not np.isfinite(columns).all() or not np.isfinite(unseen.whitened).all():
        return Factor(0.0, config.unknown_factor_sd)
    J = fitted.jacobian
    information = columns.T @ columns
    information[:-1, :-1] += np.eye(J.shape[1]) + J.T @ J  # of the fit to the other recordings
    information[-1, -1] += config.prior_factor_sd**-2
    covariance = np.linalg.inv(information)[-1]
    score = columns.T @ unseen.whitened
    return Factor(float(1.0 - covariance @ score), float(np.sqrt(covariance[-1])))


def _gain(problem: Problem, best: Fit, without: Fit) -> float:
    """Return the log-likelihood that recordings gain by an effect [nats].

    A vessel that diverges from them has none: nothing is gained with it, and `DIVERGES` without.
    """
    found = []
    for fit in (best, without):
        on = problem.program.effect_switches(fit.effects)
        found.append(problem.log_likelihood(fit.free, fit.theta, on, fit.levels))
    if not np.isfinite(found[0]):
        return 0.0
    if not np.isfinite(found[1]):
        return DIVERGES
    return found[0] - found[1]


def _recordings(problem: Problem) -> NDArray[np.int_]:
    """(rows,) number of the recording of each whitened error."""
    sizes = [mapped.measured.size for mapped in problem.recordings]
    return np.repeat(np.arange(len(sizes)), sizes)


def _parts_in_time(problem: Problem, count: int) -> NDArray[np.int_]:
    """(rows,) number of the part in time of each whitened error."""
    found = []
    for k, mapped in enumerate(problem.recordings):
        n, channels = mapped.measured.shape
        part = (np.arange(n) * count) // n
        found.append(np.repeat(part + k * count, channels))
    return np.concatenate(found)


def _ranges(problem: Problem, fit: Fit) -> Iterator[tuple[str, NDArray[np.int_]]]:
    """Yield quantities in words, and the number of the range of each whitened error (rows,)."""
    quantities: dict[str, list[Array]] = {}
    channels = []
    for mapped in problem.recordings:
        force = latent_force(problem, fit, mapped, fit.levels)
        # what is known before a row: the state of the row before
        states = np.vstack([force.states[:1], force.states[:-1]])
        channels.append(mapped.measured.shape[1])
        for words, values in _quantities(mapped, states).items():
            quantities.setdefault(words, []).append(values)
    for words, values_of in quantities.items():
        if len(values_of) < len(problem.recordings):
            continue
        together = np.concatenate(values_of)
        if not np.ptp(together) > 0.0:
            continue
        count = problem.config.decide.ranges
        edges = np.unique(np.quantile(together, np.arange(1, count) / count))
        groups = []
        for values, count in zip(values_of, channels, strict=True):
            groups.append(np.repeat(np.searchsorted(edges, values, side="left"), count))
        yield words, np.concatenate(groups)


def _quantities(mapped: MappedRecording, states: Array) -> Mapping[str, Array]:
    """Speeds, commands and heading (N,) of a recording by name."""
    axes = dof_in_state_order(mapped.program.vessel)
    rates = mapped.program.to_body_velocities(np.ascontiguousarray(states))[:, len(axes) :]
    found = {}
    for i, axis in enumerate(axes):
        found[f"{axis} rate"] = rates[:, i]
    for name, values in zip(mapped.program.vessel.commands, mapped.commands.T, strict=False):
        found[name] = values
    if "yaw" in axes:
        psi = states[:, axes.index("yaw")]
        found["north heading"] = np.cos(psi)
        found["east heading"] = np.sin(psi)
    return found


def _parts_that_gain(problem: Problem, best: Fit, without: Fit, parts: NDArray[np.int_]) -> float:
    """Return the share of parts in time whose likelihood increases by an effect."""
    change = _row_likelihood(problem, best) - _row_likelihood(problem, without)
    gains = np.bincount(parts, weights=change)
    return float(np.mean(gains > 0.0))


def _row_likelihood(problem: Problem, fit: Fit) -> Array:
    """(rows,) log-likelihood of each measurement, up to a constant."""
    on = problem.program.effect_switches(fit.effects)
    passes = problem.filter(fit.free, fit.theta, on, fit.levels)
    found = []
    for one in passes.passes:
        scale = one.scale.ravel()
        density = np.log(np.where(scale > 0.0, scale, 1.0))
        found.append(density - 0.5 * one.whitened**2)
    return np.concatenate(found)


def _prior_distance(problem: Problem, fit: Fit, name: str) -> float:
    """Return the largest distance of an effect's parameters from zero effect, in prior sds.

    It is 0 for an effect of the surroundings.
    """
    if type(problem.candidates[name]).of_surroundings:
        return 0.0
    size = _size(fit, name)
    return float(np.max(np.abs(size))) if len(size) else 0.0


def _at_bound(fit: Fit, name: str, tolerance: float) -> bool:
    """Whether a parameter of an effect is at a bound of its range other than zero effect.

    Args:
        fit: Fit with the effect.
        name: Name of the effect.
        tolerance: Relative distance from a bound that counts as at the bound.
    """
    for i in _own(fit, name):
        free = fit.free[i]
        for end in (free.low, free.high):
            if end != free.mean and abs(fit.theta[i] - end) <= tolerance * abs(end):
                return True
    return False
