"""Test for structure in the residual force: a dependence on motion, commands, place or time.

A cause without a candidate effect may be weak compared with the assumed disturbance, but it is
always the same. Each feature of the motion is tested as a force along each axis. The p-value is
corrected for the number of tests (Bonferroni).
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import combinations

import numpy as np
from scipy.special import chdtrc

from boatsim.diagnosis.config import LocateConfig
from boatsim.diagnosis.filter import MappedRecording, NoiseLevels, dof_in_state_order
from boatsim.diagnosis.locate.nominal_forces import force_sensitivities
from boatsim.diagnosis.locate.smoothing import information_with_cross_terms, latent_force
from boatsim.diagnosis.problem import Fit, Problem, prior_arrays
from boatsim.physics.base import Array
from boatsim.physics.signals import ROTATIONS

# share of the largest information on an axis below which a feature is ignored as rounding
MIN_FEATURE_INFORMATION = 1e-9
LEAST_VARIANCE = 1e-9  # in prior variances, of a parameter that a fit holds at its value
CONSTANT = "nothing, it is constant"
SINCE_START = "the time since the beginning"
WITHIN = "time: it acts in"
PLACES = {
    "surge": "the position north or south",
    "sway": "the position east or west",
    "heave": "the depth of the hull",
    "roll": "the roll angle",
    "pitch": "the trim",
}


@dataclass(frozen=True)
class Structure:
    """The quantity that correlates most with the force that a fitted model leaves unexplained.

    Quantities are motions, commands, places and time.

    Attributes:
        axis: Axis of the force.
        goes_with: The quantity, in words.
        gain: Largest gain in log likelihood by a force that is proportional to the quantity [nats].
        p_value: Corrected for the number of tests.
        tested: Number of tests.
        significant: Whether the p-value is below its limit.
        gain_of_axis: Largest such gain of a force along each axis [nats].
    """

    axis: str
    goes_with: str
    gain: float
    p_value: float
    tested: int
    significant: bool
    gain_of_axis: Mapping[str, float] = field(default_factory=dict)

    def gain_along(self, axes: Iterable[str]) -> float:
        """Return the largest gain in log likelihood by a force along one of some axes [nats].

        Args:
            axes: Names of the axes.
        """
        return max((self.gain_of_axis.get(axis, 0.0) for axis in axes), default=0.0)

    @property
    def varies_with_motion(self) -> bool:
        """Whether the unexplained force varies with motion, commands or heading.

        False if it varies with place or time only.
        """
        return not self.goes_with.startswith((CONSTANT, SINCE_START, WITHIN, *PLACES.values()))


@dataclass
class _Information:
    """Fisher information and score of the factor of a feature, over all recordings."""

    own: float  # Fisher information of the factor alone
    score: float
    shared: Array  # (F,) Fisher information that it shares with the fitted parameters

    def gain(self, parameters: Array, scores: Array, least_share: float) -> float:
        """Return the log likelihood that the feature gains beside the fitted parameters [nats].

        Args:
            parameters: Fisher information (F, F) of the parameters, with that of their prior.
            scores: Scores (F,) of the parameters.
            least_share: Share of its information that the parameters cannot replace, at least.
        """
        weights = np.linalg.solve(parameters, self.shared)
        left = max(self.own - float(self.shared @ weights), least_share * self.own)
        return 0.5 * (self.score - float(scores @ weights)) ** 2 / left


def find_structure(problem: Problem, fit: Fit, levels: NoiseLevels | None = None) -> Structure:
    """Return the quantity with which the force that a fit leaves unexplained correlates most.

    Args:
        problem: The estimation problem.
        fit: Fit of the vessel model to the recordings of the problem.
        levels: Levels of sensor noise and of that force; None: those of the fit, with the force
            limited to a multiple of the assumed disturbance.
    """
    prior = prior_arrays(fit.free)
    slope = (prior.mean - fit.theta) / prior.sd
    if levels is None:
        levels = _limited(problem, fit)
    return _structure(problem, fit, levels, np.eye(len(fit.free)), slope)


def find_structure_held_out(problem: Problem, fit: Fit) -> Structure:
    """Return the same as `find_structure` of recordings to which nothing was fitted.

    The parameters may differ from the fit by their posterior uncertainty.

    Args:
        problem: The estimation problem on held-out recordings.
        fit: Fit of the vessel model to other recordings.
    """
    sd = prior_arrays(fit.free).sd
    covariance = fit.covariance / np.outer(sd, sd) + LEAST_VARIANCE * np.eye(len(sd))
    precision = np.asarray(np.linalg.inv(covariance), dtype=float)
    return _structure(problem, fit, _limited(problem, fit), precision, np.zeros(len(sd)))


def _limited(problem: Problem, fit: Fit) -> NoiseLevels:
    """Levels of a fit with its latent force limited to a multiple of the assumed disturbance."""
    limit = problem.config.locate.disturbance_factor * problem.ambient.force
    return replace(fit.levels, force=np.minimum(fit.levels.force, limit))


def _structure(
    problem: Problem, fit: Fit, levels: NoiseLevels, precision: Array, slope: Array
) -> Structure:
    """The structure beside the parameters, all in prior standard deviations.

    Args:
        problem: The estimation problem.
        fit: Fit of the vessel model.
        levels: Levels of sensor noise and of the latent force.
        precision: Prior information (F, F) of the parameters.
        slope: Derivative (F,) of the log prior density.
    """
    config = problem.config.locate
    axes = dof_in_state_order(problem.program.vessel)
    none = np.zeros(len(precision))
    sums = defaultdict[tuple[str, str], _Information](lambda: _Information(0.0, 0.0, none))
    information, scores = precision, slope
    for mapped in problem.recordings:
        force = latent_force(problem, fit, mapped, levels)
        states = np.ascontiguousarray(force.states)
        named = dict(candidate_regressors(mapped, states, levels.time_constant, config))
        values = np.column_stack(list(named.values()))
        shapes = np.einsum("na,kb->nkba", values, np.eye(len(axes)))
        parameters = np.moveaxis(force_sensitivities(problem, fit, mapped, states), 0, 2)
        found = information_with_cross_terms(
            shapes.reshape(*force.mean.shape, -1), parameters, force
        )
        information = information + found.others
        scores = scores + found.others_score
        keys = [(axis, name) for axis in axes for name in named]
        for k, key in enumerate(keys):
            total = sums[key]
            sums[key] = _Information(
                total.own + float(found.own[k]),
                total.score + float(found.score[k]),
                total.shared + found.shared[k],
            )
    gains = {}
    for axis in axes:
        largest = max(one.own for key, one in sums.items() if key[0] == axis)
        for key, one in sums.items():
            if key[0] == axis and one.own > MIN_FEATURE_INFORMATION * largest:
                gains[key] = one.gain(information, scores, config.structure_least_share)
    if not gains:
        return Structure(axes[0], CONSTANT, 0.0, 1.0, 0, False)
    axis, name = max(gains, key=lambda key: gains[key])
    gain = gains[axis, name]
    p_value = min(1.0, len(gains) * float(chdtrc(1, 2.0 * gain)))
    of_axis = dict.fromkeys(axes, 0.0)
    for (along, _), one_gain in gains.items():
        of_axis[along] = max(of_axis[along], one_gain)
    significant = p_value < config.structure_max_p
    return Structure(axis, name, gain, p_value, len(gains), significant, of_axis)


def candidate_regressors(
    mapped: MappedRecording, states: Array, time_constant: float, config: LocateConfig
) -> Iterator[tuple[str, Array]]:
    """Yield the quantities with which an unexplained force may correlate in a recording.

    Quantities are motions, commands, places and time.

    Args:
        mapped: The mapped recording.
        states: Smoothed states (N, 2 NQ).
        time_constant: Time constant of the latent force [s].
        config: Settings of the features.

    Yields:
        The quantity in words and its values (N,), scaled to rms 1.
    """
    for source in (
        _speed_features(mapped, states),
        _inclined_damping_features(mapped, states),
        _memory_features(mapped, states, time_constant),
        _command_features(mapped, states, time_constant),
        _heading_features(mapped, states),
        _place_features(mapped, states),
        _time_features(mapped, config),
    ):
        for name, values in source:
            rms = float(np.sqrt(np.mean(values**2)))
            if rms > 0.0:
                yield name, values / rms


def _speeds(mapped: MappedRecording, states: Array) -> dict[str, Array]:
    """Body-axes rates (N,) by name."""
    axes = dof_in_state_order(mapped.program.vessel)
    rates = mapped.program.to_body_velocities(states)[:, len(axes) :]
    speeds = {}
    for i, axis in enumerate(axes):
        noun = "rate" if axis in ROTATIONS else "speed"
        speeds[f"{axis} {noun}"] = rates[:, i]
    return speeds


def _speed_features(mapped: MappedRecording, states: Array) -> Iterator[tuple[str, Array]]:
    speeds = _speeds(mapped, states)
    yield CONSTANT, np.ones(len(mapped.times))
    for name, w in speeds.items():
        yield name, w
        yield f"the size of {name}", np.abs(w)
        yield f"the square of {name}", w * np.abs(w)
        yield f"the cube of {name}", w**3
    for (first, a), (second, b) in combinations(speeds.items(), 2):
        yield f"{first} times {second}", a * b


def _inclined_damping_features(
    mapped: MappedRecording, states: Array
) -> Iterator[tuple[str, Array]]:
    """Rates of roll and pitch times their angle, as of damping that depends on the inclination."""
    axes = dof_in_state_order(mapped.program.vessel)
    for name, rate in _speeds(mapped, states).items():
        axis = name.removesuffix(" rate")
        if axis not in PLACES or axis not in ROTATIONS:
            continue
        angle = states[:, axes.index(axis)]
        yield f"{name} times {PLACES[axis]}", rate * angle
        yield f"{name} times the size of {PLACES[axis]}", rate * np.abs(angle)
        yield f"{name} times the side of {PLACES[axis]}", rate * np.sign(angle)


def _memory_features(
    mapped: MappedRecording, states: Array, time_constant: float
) -> Iterator[tuple[str, Array]]:
    """Earlier speeds and inclinations, as in a force with memory: a wake, or water in a tank."""
    axes = dof_in_state_order(mapped.program.vessel)
    signals = _speeds(mapped, states)
    for axis, name in PLACES.items():
        if axis in axes and axis in ROTATIONS:
            signals[name.removeprefix("the ")] = states[:, axes.index(axis)]
    for name, values in signals.items():
        yield f"the delayed {name}", _low_pass(values, mapped.times, time_constant)


def _command_features(
    mapped: MappedRecording, states: Array, time_constant: float
) -> Iterator[tuple[str, Array]]:
    surge_speed = _speeds(mapped, states).get("surge speed")
    for name, c in zip(mapped.program.vessel.commands, mapped.commands.T, strict=False):
        if not np.ptp(c) > 0.0:
            continue
        yield name, c
        yield f"the size of {name}", np.abs(c)
        yield f"the delayed {name}", _low_pass(c, mapped.times, time_constant)
        if surge_speed is not None:
            yield f"{name} times surge speed", c * surge_speed


def _heading_features(mapped: MappedRecording, states: Array) -> Iterator[tuple[str, Array]]:
    axes = dof_in_state_order(mapped.program.vessel)
    if "yaw" in axes:
        psi = states[:, axes.index("yaw")]
        for name, angle in (("heading", psi), ("twice the heading", 2.0 * psi)):
            yield f"the cosine of {name}", np.cos(angle)
            yield f"the sine of {name}", np.sin(angle)


def _place_features(mapped: MappedRecording, states: Array) -> Iterator[tuple[str, Array]]:
    axes = dof_in_state_order(mapped.program.vessel)
    for axis, name in PLACES.items():
        if axis not in axes:
            continue
        position = states[:, axes.index(axis)]
        offset = position - position.mean()
        yield name, offset
        if axis in ROTATIONS:  # the righting arm of an asymmetric hull has even terms in heel
            yield f"{name} squared", offset**2
            yield f"{name} cubed", offset**3


def _time_features(mapped: MappedRecording, config: LocateConfig) -> Iterator[tuple[str, Array]]:
    """Time since the start and parts of the run, for this run alone and for all runs alike."""
    t = mapped.times
    since = (t - t[0]) / (t[-1] - t[0])
    count = config.structure_parts
    parts = []
    for k in range(count):
        parts.append(((since >= k / count) & (since < (k + 1) / count)).astype(float))
    yield f"{SINCE_START} of {mapped.name}", since - 0.5
    for k, part in enumerate(parts):
        begin, end = t[0] + (t[-1] - t[0]) * np.array([k, k + 1]) / count
        yield f"{WITHIN} {begin:.3g} to {end:.3g} s of {mapped.name}", part
    yield SINCE_START, since - 0.5
    for k, part in enumerate(parts):
        yield f"{WITHIN} part {k + 1} of {count} of every run", part


def _low_pass(values: Array, t: Array, time_constant: float) -> Array:
    """(N,) values behind a first-order low-pass filter."""
    filtered = values.copy()
    for i, share in enumerate(1.0 - np.exp(-np.diff(t) / time_constant), 1):
        filtered[i] = filtered[i - 1] + share * (values[i] - filtered[i - 1])
    return filtered
