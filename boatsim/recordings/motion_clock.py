"""Rate of a log's clock from the motion: poses and velocities tell how much time has passed.

A vessel that moves at a recorded speed and turns at a recorded rate needs a certain time for the
distance and for the angle between two recorded poses. If both ask for the same other time than the
rows state, the clock of the rows is wrong, not one of the instruments.

The clock rate s is the true time per recorded time. Over a stretch of rows

    change of position = g s (integral of the velocity over ground)
    change of heading  =   s (integral of the yaw rate)

g is the gain of the speed sensor, common to all recordings. s follows an Ornstein-Uhlenbeck process
about 1. Its level, the errors of both equations and g are estimated by expectation maximization
(R. H. Shumway, D. S. Stoffer, J. Time Series Analysis 3, 1982), s by the Kalman smoother.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.known_values import filled

NEEDED = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")
STRETCH_ROWS = 10  # rows of a stretch: noise of single poses averages out, and wander shows
CORRELATION = 2.0  # stretches after which the clock rate has forgotten 63 % of its deviation
ROUNDS = 30  # of the estimation; the levels then change by less than 1 %
MAX_RATE = 2.5  # a stretch with a larger or a smaller inverse rate is a leap, not a clock
MAX_UNEXPLAINED_TURN = 0.3  # [rad] likewise
START_SD = 0.1  # of the clock rate
FINEST = 1e-6  # [m] or [rad] smallest errors of the two equations


@dataclass(frozen=True)
class Stretches:
    """Motion of one recording over stretches of rows, by its poses and by its velocities.

    Attributes:
        edges: Rows (M + 1,) at which stretches begin and end.
        middle: Recorded times (M,) [s] of their middles.
        moved: Change of position (2, M) [m] by the poses.
        travelled: The same by the velocities.
        swung: Change of heading (M,) [rad] by the poses.
        turned: The same by the yaw rate; 0 where it is not known or not credible.
    """

    edges: NDArray[np.int64]
    middle: Array
    moved: Array
    travelled: Array
    swung: Array
    turned: Array


@dataclass(frozen=True)
class ClockRates:
    """Estimated clock rates of several recordings.

    Attributes:
        rates: Clock rates (M,) over the stretches of each recording, true time per recorded time.
        speed_gain: True speed per recorded speed.
        sd: Standard deviation of the clock rate.
        position_error: Error of a change of position [m].
        heading_error: Error of a change of heading [rad].
    """

    rates: tuple[Array, ...]
    speed_gain: float
    sd: float
    position_error: float
    heading_error: float


def motion_stretches(
    t: Array, signals: Mapping[str, Array], rows: int = STRETCH_ROWS
) -> Stretches | None:
    """Return the motion of a recording over stretches, by its poses and by its velocities.

    Args:
        t: Times (N,) [s] of the rows, increasing.
        signals: Columns (N,) of the recording; headings are unwrapped, nan is not measured.
        rows: Rows of a stretch, at least.

    Returns:
        The stretches; None if a column is missing or the recording is too short.
    """
    for name in NEEDED:
        if name not in signals or np.isfinite(signals[name]).sum() < STRETCH_ROWS:
            return None
    edges = _edges(np.isfinite(signals["x_m"]) & np.isfinite(signals["y_m"]), rows)
    if len(edges) < 4:
        return None
    psi = filled(t, signals["psi_rad"])
    u, v, r = (filled(t, signals[name]) for name in ("u_mps", "v_mps", "r_radps"))
    north = _integral(t, u * np.cos(psi) - v * np.sin(psi))
    east = _integral(t, u * np.sin(psi) + v * np.cos(psi))
    track = np.stack([signals["x_m"][edges], signals["y_m"][edges]])
    travelled = np.diff(np.stack([north, east])[:, edges])
    moved = np.diff(track)
    turned = np.diff(_integral(t, r)[edges])
    swung = np.diff(signals["psi_rad"][edges])
    known = np.isfinite(swung)
    known &= np.abs(np.nan_to_num(swung) - turned) < MAX_UNEXPLAINED_TURN + 0.5 * np.abs(turned)
    plausible = _is_plausible(moved, travelled)
    return Stretches(
        edges,
        0.5 * (t[edges][1:] + t[edges][:-1]),
        np.where(plausible, moved, 0.0),
        np.where(plausible, travelled, 0.0),
        np.where(known, swung, 0.0),
        np.where(known, turned, 0.0),
    )


def _edges(fixed: NDArray[np.bool_], apart: int) -> NDArray[np.int64]:
    """Rows with a fix, at least some rows apart."""
    edges = list[int]()
    for row in np.flatnonzero(fixed).tolist():
        if not edges or row - edges[-1] >= apart:
            edges.append(row)
    return np.array(edges, dtype=np.int64)


def _integral(t: Array, rate: Array) -> Array:
    """Integral (N,) over time by the trapezoidal rule."""
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(t)
    return np.concatenate(([0.0], np.cumsum(steps)))


def _is_plausible(moved: Array, travelled: Array) -> NDArray[np.bool_]:
    """Whether both distances (M,) differ by no more than a clock may explain."""
    far, by_speed = np.hypot(*moved), np.hypot(*travelled)
    return np.asarray((far < MAX_RATE * by_speed) & (by_speed < MAX_RATE * far))


def estimate_clock_rates(runs: Sequence[Stretches], speed_gain: float | None = None) -> ClockRates:
    """Estimate clock rates and the common gain of the speed sensor of several recordings.

    Args:
        runs: Stretches of each recording.
        speed_gain: True speed per recorded speed; None: it is estimated.
    """
    gain = speed_gain or 1.0
    sd = START_SD
    errors = _initial_errors(runs, gain)
    states = [(np.ones(len(run.middle)), np.zeros(len(run.middle))) for run in runs]
    for _ in range(ROUNDS):
        states = [_smoothed(run, gain, sd, errors) for run in runs]
        if speed_gain is None:
            gain = _speed_gain(runs, states)
        sd = float(np.sqrt(_mean([(rate - 1.0) ** 2 + var for rate, var in states])))
        errors = _errors(runs, states, gain)
    rates = tuple(np.clip(rate, 1.0 / MAX_RATE, MAX_RATE) for rate, _ in states)
    return ClockRates(rates, gain, sd, *errors)


def _mean(parts: Sequence[Array]) -> float:
    return float(np.mean(np.concatenate(parts)))


def _initial_errors(runs: Sequence[Stretches], gain: float) -> tuple[float, float]:
    """Errors of both equations if half of the mean square difference were due to the clock."""
    states = [(np.ones(len(run.middle)), np.zeros(len(run.middle))) for run in runs]
    position, heading = _errors(runs, states, gain)
    return 0.7 * position, 0.7 * heading


def _errors(
    runs: Sequence[Stretches], states: Sequence[tuple[Array, Array]], gain: float
) -> tuple[float, float]:
    """Rms errors of a change of position [m] and of heading [rad], expected over the rates."""
    position, heading = list[Array](), list[Array]()
    for run, (rate, variance) in zip(runs, states, strict=True):
        along = gain * run.travelled
        used = (along**2).sum(axis=0) > 0.0
        off = ((run.moved - rate * along) ** 2 + variance * along**2).mean(axis=0)
        position.append(off[used])
        turning = run.turned != 0.0
        off = (run.swung - rate * run.turned) ** 2 + variance * run.turned**2
        heading.append(off[turning])
    found = []
    for parts in (position, heading):
        if sum(map(len, parts)):
            found.append(max(float(np.sqrt(_mean(parts))), FINEST))
        else:
            found.append(1.0)
    return found[0], found[1]


def _speed_gain(runs: Sequence[Stretches], states: Sequence[tuple[Array, Array]]) -> float:
    """Gain of the speed sensor by which positions and velocities agree at these clock rates."""
    above = below = 0.0
    for run, (rate, variance) in zip(runs, states, strict=True):
        above += float(np.sum(rate * run.travelled * run.moved))
        below += float(np.sum((rate**2 + variance) * run.travelled**2))
    if below > 0.0:
        return above / below
    return 1.0


def _smoothed(
    run: Stretches, gain: float, sd: float, errors: tuple[float, float]
) -> tuple[Array, Array]:
    """Clock rates (M,) and their variances: Kalman filter and smoother of Rauch, Tung, Striebel."""
    along = gain * run.travelled
    precision = (along**2).sum(axis=0) / errors[0] ** 2 + run.turned**2 / errors[1] ** 2
    seen = (along * (run.moved - along)).sum(axis=0) / errors[0] ** 2
    seen += run.turned * (run.swung - run.turned) / errors[1] ** 2
    steps = np.diff(run.middle)
    forgets = np.exp(-steps / (CORRELATION * float(np.median(steps))))
    count = len(precision)
    mean, variance = np.zeros(count), np.zeros(count)
    expected, uncertain = np.zeros(count), np.full(count, sd**2)
    for k in range(count):
        if k:
            expected[k] = forgets[k - 1] * mean[k - 1]
            uncertain[k] = forgets[k - 1] ** 2 * (variance[k - 1] - sd**2) + sd**2
        variance[k] = 1.0 / (1.0 / uncertain[k] + precision[k])
        mean[k] = variance[k] * (expected[k] / uncertain[k] + seen[k])
    for k in range(count - 2, -1, -1):
        back = variance[k] * forgets[k] / uncertain[k + 1]
        mean[k] += back * (mean[k + 1] - expected[k + 1])
        variance[k] += back**2 * (variance[k + 1] - uncertain[k + 1])
    return 1.0 + mean, variance


def corrected_times(t: Array, run: Stretches, rates: Array) -> Array:
    """Return the true times (N,) [s] of the rows, which begin at the first recorded time.

    Args:
        t: Recorded times (N,) [s].
        run: Stretches of the recording.
        rates: Clock rates (M,) over the stretches.
    """
    between = np.interp(0.5 * (t[1:] + t[:-1]), run.middle, rates)
    steps = between * np.diff(t)
    return np.asarray(t[0] + np.concatenate(([0.0], np.cumsum(steps))))


def times_by_motion(t: Array, signals: Mapping[str, Array], place: str) -> Array:
    """Return the times (N,) [s] of the rows of a recording that its motion implies.

    The recorded speeds are taken as they are; a wrong gain of the speed sensor is to be corrected
    first.

    Args:
        t: Recorded times (N,) [s].
        signals: Columns (N,) of the recording.
        place: Name of the recording in messages.

    Raises:
        BadInput: A column is missing, or the recording is too short.
    """
    run = motion_stretches(t, signals)
    if run is None:
        missing = [name for name in NEEDED if name not in signals]
        why = f"there is no column {', '.join(missing)}" if missing else "it is too short"
        raise BadInput(f'{place}: clock = "motion", but {why}; needed are {", ".join(NEEDED)}')
    return corrected_times(t, run, estimate_clock_rates([run], speed_gain=1.0).rates[0])
