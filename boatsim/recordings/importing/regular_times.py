"""Times of the samples of a sensor with a regular rate that a program read at other times.

A program that polls a sensor, or reads its messages from a queue, stamps samples late, by another
delay each time. A vessel under way then seems to move in jerks. The distance from one sample to the
next shows how many periods of the sensor lie between them, because the speed changes slowly.
"""

from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array

MIN_SAMPLES = 50  # fewer do not determine the period
# Time [s] over which speed and mean delay are averaged: longer than delays of messages, shorter
# than the drift of a clock, or a change of speed
SPEED_WINDOW = 4.0
DELAY_WINDOW = 40.0
# Largest delay of a sample relative to the mean one [periods]. Queues of wireless links were seen
# to hold two messages; 12 are one second at the usual rates of satellite receivers
MAX_DELAY = 12
# Time [s] without samples, over which the distance does not tell the number of periods: 10 % of
# it are more than half a period of the usual receivers
GAP = 1.5
SPEED_CHANGE = 0.1  # share by which the speed may differ from its average
COUNT_LIMIT = 4.0  # [sd] of a distance, beyond which it is an outlier of the position
# Sd of the delays [periods] in each count of the periods. It is wide at first, because an error of
# the period makes the delays grow over the log. The last ones decide where the vessel hardly moves
DELAY_SDS = (10.0, 3.0, 1.0, 0.7, 0.7)
REGULAR_SHARE = 0.95  # of equal steps, from which a sensor counts as read in time
TINY = 1e-12  # [m^2] variance of a vessel that does not move
MIN_JITTER = 0.05  # rms of the shifts, relative to the period, that is worth removing
# The velocities by the positions must become smoother by this factor. Samples at irregular times
# do not lie at whole periods, and become rougher
MAX_ROUGHNESS = 0.5


def regular_times(t: Array, track: Array) -> tuple[Array, float] | None:
    """Return the times at which a sensor of regular rate measured, and the period.

    The mean delay stays.

    Args:
        t: Times (N,) [s] at which new samples were read, increasing.
        track: Positions (N,) as complex numbers [m].

    Returns:
        Times (N,) [s] and period [s]; None if the samples have no rhythm, or are regular already.
    """
    if len(t) < MIN_SAMPLES or _is_regular(t):
        return None
    time = t - t[0]
    distance = np.abs(np.diff(track))
    regular, period, steps = time, 0.0, np.ones(len(t) - 1)
    for delay_sd in DELAY_SDS:
        speed = _speed(regular, distance)
        if period == 0.0:
            period = _usual_step(distance, speed)
            if not period > 0.0:
                return None
            steps = np.maximum(1.0, np.round(distance / (speed * period + TINY)))
            period = _period(time, np.append(0.0, np.cumsum(steps)))
        spread = _spread(distance - speed * period * steps)
        turns = _count_turns(time, distance, speed, Rhythm(period, delay_sd, spread))
        steps, period = np.diff(turns), _period(time, turns)
        regular = period * turns + _mean_delay(time, time - period * turns)
    if not np.all(np.diff(regular) > 0.0):
        return None
    shift = float(np.sqrt(np.mean((regular - time) ** 2)))
    smoother = np.all(_roughness(regular, track) < MAX_ROUGHNESS * _roughness(time, track))
    if shift < MIN_JITTER * period or not smoother:
        return None
    return t[0] + regular, period


def values_at_rows(t: Array, regular: Array, values: Array) -> Array:
    """Return values (N,) at the times of rows, from values at other times by straight lines.

    The first and the last ones are extrapolated by the slope of the nearest line.

    Args:
        t: Times of the rows (N,) [s].
        regular: Times of the values (N,) [s], N at least 2.
        values: Values (N,).
    """
    i = np.clip(np.searchsorted(regular, t) - 1, 0, len(t) - 2)
    slope = (values[i + 1] - values[i]) / (regular[i + 1] - regular[i])
    return np.asarray(values[i] + slope * (t - regular[i]))


def _is_regular(t: Array) -> bool:
    """Whether nearly all steps are equal, so that nothing has to be counted."""
    steps = np.diff(t) / np.median(np.diff(t))
    return float(np.mean(np.abs(steps - 1.0) < MIN_JITTER)) > REGULAR_SHARE


def _speed(t: Array, distance: Array) -> Array:
    """Mean speed (N - 1,) [m/s] around each step between samples."""
    middle = 0.5 * (t[1:] + t[:-1])
    begin = np.searchsorted(t, middle - 0.5 * SPEED_WINDOW, side="right") - 1
    end = np.searchsorted(t, middle + 0.5 * SPEED_WINDOW)
    begin, end = np.maximum(begin, 0), np.minimum(end, len(t) - 1)
    way = np.append(0.0, np.cumsum(distance))
    return np.asarray((way[end] - way[begin]) / (t[end] - t[begin]))


def _spread(off: Array) -> float:
    """Standard deviation of deviations (N,), robust to outliers."""
    return float(1.4826 * np.median(np.abs(off)))


class Rhythm(NamedTuple):
    """Rhythm of a sensor: period [s], sd of its delays [periods], and noise of its steps [m]."""

    period: float
    delay_sd: float
    noise: float


def _count_turns(t: Array, distance: Array, speed: Array, rhythm: Rhythm) -> Array:
    """Periods (N,) of the sensor from the first sample to each, by the best path (Viterbi 1967).

    A sample is at least one period later than the one before. The distances decide, and the delays
    where the vessel hardly moves.
    """
    period = rhythm.period
    nearest = np.round(t / period).astype(np.int64)
    offsets = np.arange(-MAX_DELAY, MAX_DELAY + 1)
    delays = t[:, None] / period - (nearest[:, None] + offsets)
    own = (delays / rhythm.delay_sd) ** 2
    expected = speed * period
    total = own[0]
    came_from = np.zeros((len(t), len(offsets)), dtype=np.int64)
    for i in range(1, len(t)):
        turns = (nearest[i] + offsets)[None, :] - (nearest[i - 1] + offsets)[:, None]
        way = expected[i - 1] * turns
        variance = rhythm.noise**2 + (SPEED_CHANGE * way) ** 2 + TINY
        cost = np.minimum((distance[i - 1] - way) ** 2 / variance, COUNT_LIMIT**2)
        if t[i] - t[i - 1] > GAP:
            cost[:] = 0.0
        cost[turns < 1] = np.inf
        paths = total[:, None] + cost
        came_from[i] = np.argmin(paths, axis=0)
        total = paths[came_from[i], np.arange(len(offsets))] + own[i]
    found = np.empty(len(t))
    at = int(np.argmin(total))
    for i in range(len(t) - 1, -1, -1):
        found[i] = nearest[i] + offsets[at]
        at = int(came_from[i, at])
    return np.asarray(found - found[0])


def _usual_step(distance: Array, speed: Array) -> float:
    """Median time [s] in which the vessel went from one sample to the next, where it moves."""
    moves = speed > 0.5 * np.median(speed)
    return float(np.median(distance[moves] / speed[moves])) if moves.any() else 0.0


def _period(t: Array, turns: Array) -> float:
    """Period [s] by which the turns agree with the stamps between gaps (least squares)."""
    part = np.append(0, np.cumsum(np.diff(t) > GAP))
    count = np.maximum(np.bincount(part), 1)
    off_t = t - (np.bincount(part, t) / count)[part]
    off_turns = turns - (np.bincount(part, turns) / count)[part]
    return float(np.sum(off_t * off_turns) / np.sum(off_turns**2))


def _mean_delay(t: Array, delay: Array) -> Array:
    """Mean delay (N,) around each sample; it drifts slowly where two clocks differ."""
    total = np.append(0.0, np.cumsum(delay))
    begin = np.searchsorted(t, t - 0.5 * DELAY_WINDOW)
    end = np.searchsorted(t, t + 0.5 * DELAY_WINDOW, side="right")
    return np.asarray((total[end] - total[begin]) / (end - begin))


def _roughness(t: Array, track: Array) -> Array:
    """Changes of the velocity from one step to the next [m/s]: median, and percentile 95.

    The latter shows samples that are moved to a wrong turn of the sensor. Both are nan or infinite
    if a step of time is so short that a velocity exceeds the largest number.
    """
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        velocity = np.diff(track) / np.diff(t)
        return np.asarray(np.percentile(np.abs(np.diff(velocity)), [50.0, 95.0]))
