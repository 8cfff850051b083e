"""Delays of the sensors of one recording against each other, by kinematics alone.

The heading is the integral of the yaw rate, and the track that of the velocities, which the heading
turns to the earth frame. These laws hold for every vessel. Positions, heading, velocities and yaw
rate may each be late, so that three differences of four delays are estimated by least squares. A
current, a gain of the velocities and an antenna away from the point of the velocities are fitted
with them, because these look alike. Standard deviations follow from the scatter of intervals of the
recording, as in `command_delays`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.checks.equal_steps import equal_steps, moving_average, values_at_times
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

POSITIONS, HEADING, VELOCITIES, YAW_RATE = "positions", "heading", "velocities", "yaw rate"
SENSORS = {
    POSITIONS: ("x_m", "y_m"),
    HEADING: ("psi_rad",),
    VELOCITIES: ("u_mps", "v_mps"),
    YAW_RATE: ("r_radps",),
}
Residuals = Callable[[Array], Array]  # (P,) delays [s] -> (N,), nan where not known


class SensorDelay(NamedTuple):
    """Delay of one sensor behind another of the same recording.

    Attributes:
        sensor: Name in `SENSORS`.
        behind: The sensor that it is behind.
        seconds: The delay [s].
        sd: Its standard deviation [s].
        unexplained: Mean square that it leaves, as a share of that without any delay.
    """

    sensor: str
    behind: str
    seconds: float
    sd: float
    unexplained: float


@dataclass(frozen=True)
class _Motion:
    """Averaged motion at equally spaced times (N,), by poses and by velocities, nan in gaps."""

    t: Array
    step: float  # [s]
    middle: Array  # (M,) times [s] that stay inside with any delay
    longest: float  # largest delay [s]
    columns: dict[str, Array]

    def at(self, name: str, delay: float) -> Array:
        """A column (M,) at the times at which its values are recorded with a delay [s]."""
        return np.interp(self.middle + delay, self.t, self.columns[name])


def sensor_delays(
    recording: Recording, window: float, longest: float, config: ChecksConfig
) -> list[SensorDelay]:
    """Return the delays of the sensors of a recording against each other.

    Args:
        recording: A prepared recording.
        window: Time [s] over which poses are differenced, and at least one interval of a sensor.
        longest: Largest delay that is sought [s].
        config: Thresholds of the quality checks.

    Returns:
        Delays of the heading behind the yaw rate, and of positions and heading behind the
        velocities, as far as the columns are recorded and determine them.
    """
    found = []
    names = recording.signals.keys()
    if {*SENSORS[HEADING], *SENSORS[YAW_RATE]} <= names:
        motion = _motion(
            recording, (*SENSORS[HEADING], *SENSORS[YAW_RATE]), window, longest, config
        )
        if motion:
            found += _delays(motion, _yaw_residuals(motion), [(HEADING, YAW_RATE)], config)
    track = (*SENSORS[POSITIONS], *SENSORS[HEADING], *SENSORS[VELOCITIES])
    if set(track) <= names:
        motion = _motion(recording, track, window, longest, config)
        if motion:
            pairs = [(POSITIONS, VELOCITIES), (HEADING, VELOCITIES)]
            found += _delays(motion, _track_residuals(motion), pairs, config)
    return found


def _motion(
    recording: Recording,
    names: tuple[str, ...],
    window: float,
    longest: float,
    config: ChecksConfig,
) -> _Motion | None:
    """Averages of columns and rates of poses; None if there are too few samples."""
    intervals = []
    for name in names:
        sampled = recording.t[np.isfinite(recording[name])]
        if len(sampled) < config.rates_min_rows:
            return None
        intervals.append(float(np.median(np.diff(sampled))))
    t = equal_steps(recording.t)
    if not len(t) or np.ptp(t) < config.rates_min_durations * longest:
        return None
    step = float(t[1] - t[0])
    half = max(1, round(max(0.5 * window, *intervals) / step))
    columns: dict[str, Array] = {}
    for name in names:
        values = values_at_times(t, recording.t, recording[name], config)
        columns[name] = moving_average(values, half)
        if name in (*SENSORS[POSITIONS], *SENSORS[HEADING]):
            rate = np.full(len(t), np.nan)
            rate[half:-half] = (values[2 * half :] - values[: -2 * half]) / (2.0 * half * step)
            columns[f"rate of {name}"] = rate
    margin = longest + (half + 1) * step
    middle = t[(t >= t[0] + margin) & (t <= t[-1] - margin)]
    stride = max(1, len(middle) // config.sensor_delay_rows)
    if len(middle) < config.rates_min_rows:
        return None
    return _Motion(t, step, middle[::stride], longest, columns)


def _yaw_residuals(motion: _Motion) -> Residuals:
    """Rate of the heading less the yaw rate, which has any gain and any bias."""
    rate = motion.at("r_radps", 0.0)

    def residuals(delays: Array) -> Array:
        turning = motion.at("rate of psi_rad", float(delays[0]))
        others = np.column_stack([rate, np.ones_like(rate)])
        return _without(turning, others)

    return residuals


def _track_residuals(motion: _Motion) -> Residuals:
    """Velocity of the track in body axes, less that of the sensor, a current and a lever."""
    velocities = np.concatenate([motion.at("u_mps", 0.0), motion.at("v_mps", 0.0)])

    def residuals(delays: Array) -> Array:
        position, heading = delays.tolist()
        psi = motion.at("psi_rad", heading)
        rate = motion.at("rate of psi_rad", heading)
        north = motion.at("rate of x_m", position)
        east = motion.at("rate of y_m", position)
        c, s = np.cos(psi), np.sin(psi)
        none = np.zeros_like(c)
        moved = np.concatenate([c * north + s * east, c * east - s * north])
        current = [np.concatenate([c, -s]), np.concatenate([s, c])]
        lever = [np.concatenate([none, rate]), np.concatenate([-rate, none])]
        return _without(moved, np.column_stack([velocities, *current, *lever]))

    return residuals


def _without(values: Array, others: Array) -> Array:
    """Values (N,) less their least-squares fit by columns (N, K); nan where one is missing."""
    known = np.isfinite(values) & np.isfinite(others).all(axis=1)
    found = np.full(len(values), np.nan)
    if known.sum() > others.shape[1]:
        weights, *_ = np.linalg.lstsq(others[known], values[known], rcond=None)
        found[known] = values[known] - others[known] @ weights
    return found


def _delays(
    motion: _Motion,
    residuals: Residuals,
    pairs: Sequence[tuple[str, str]],
    config: ChecksConfig,
) -> list[SensorDelay]:
    """Delays with the smallest residuals; none if these lie at the largest delay.

    They are compared at whole steps, because values between two samples have less noise than these.
    """

    def mean_square(steps: Array) -> float:
        values = residuals(motion.step * steps)
        known = np.isfinite(values)
        if known.mean() < config.sensor_delay_min_share:
            return np.inf
        return float(np.mean(values[known] ** 2))

    most = int(motion.longest / motion.step)
    axis = np.unique(np.round(np.linspace(-most, most, 2 * config.sensor_delay_grid + 1)))
    grid = np.stack(np.meshgrid(*[axis] * len(pairs), indexing="ij"), -1).reshape(-1, len(pairs))
    start = grid[int(np.argmin([mean_square(point) for point in grid]))]
    best = _lowest(mean_square, start)
    before = mean_square(np.zeros(len(pairs)))
    if np.abs(best).max() >= most or not 0.0 < before < np.inf:
        return []
    gradient, curvature = _derivatives(mean_square, best)
    if not np.isfinite(curvature).all() or not np.all(np.linalg.eigvalsh(curvature) > 0.0):
        return []
    beyond = -np.clip(np.linalg.solve(curvature, gradient), -1.0, 1.0)
    sds = _sds(lambda steps: np.nan_to_num(residuals(motion.step * steps)), best, beyond, config)
    if sds is None:
        return []
    refined = best + beyond
    left = mean_square(best) / before
    found = []
    for (sensor, behind), delay, sd in zip(pairs, refined.tolist(), sds.tolist(), strict=True):
        found.append(SensorDelay(sensor, behind, motion.step * delay, motion.step * sd, left))
    return found


def _lowest(value: Callable[[Array], float], start: Array) -> Array:
    """The point (P,) of whole steps from which no neighbour has a smaller value."""
    best, lowest = start, value(start)
    while True:
        around = [best + np.array(way) for way in product((-1.0, 0.0, 1.0), repeat=len(best))]
        values = [value(point) for point in around]
        if not min(values) < lowest:
            return best
        best, lowest = around[int(np.argmin(values))], min(values)


def _derivatives(value: Callable[[Array], float], at: Array) -> tuple[Array, Array]:
    """Gradient (P,) and curvature (P, P) of a function by differences over whole steps."""
    units = np.eye(len(at))
    gradient = np.array([0.5 * (value(at + e) - value(at - e)) for e in units])
    curvature = np.zeros((len(at), len(at)))
    for i, e in enumerate(units):
        for j, f in enumerate(units):
            if i == j:
                curvature[i, i] = value(at + e) + value(at - e) - 2.0 * value(at)
            else:
                mixed = value(at + e + f) + value(at - e - f)
                mixed -= value(at + e - f) + value(at - e + f)
                curvature[i, j] = 0.25 * mixed
    return gradient, curvature


def _sds(residuals: Residuals, best: Array, beyond: Array, config: ChecksConfig) -> Array | None:
    """Standard deviations (P,) in steps from the scores of intervals; None if not determined.

    The residuals at a fraction of a step beyond whole steps follow from their slopes.
    """
    intervals = config.sensor_delay_intervals
    slopes = []
    for unit in np.eye(len(best)):
        slopes.append(0.5 * (residuals(best + unit) - residuals(best - unit)))
    J = np.column_stack(slopes)
    if np.linalg.matrix_rank(J) < len(best):
        return None
    error = residuals(best) + J @ beyond
    inverse = np.linalg.inv(J.T @ J)
    scores = []
    for rows in np.array_split(np.arange(len(error)), intervals):
        scores.append(J[rows].T @ error[rows])
    spread = np.array(scores).T @ np.array(scores) * intervals / (intervals - len(best))
    return np.asarray(np.sqrt(np.diag(inverse @ spread @ inverse)))
