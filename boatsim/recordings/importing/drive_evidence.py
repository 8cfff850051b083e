"""What the motion in a log shows of outputs without telling names: thrust, side and steering.

A vessel gathers way after the sum of its thrusts and turns after their difference or after a
rudder, each with a lag. Speed ahead and rate of turn are therefore regressed on all outputs
together, each filtered by one first-order lag, and the partial correlations show which output has
which effect. Outputs that are commanded together are told apart as far as they differ.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from boatsim.physics.base import Array
from boatsim.recordings.importing.motion_names import has_opposite_sense
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.track import Track, values_in_si
from boatsim.recordings.importing.turning import Turning, held_values

STEP = 0.2  # [s] of the rows that are compared; boats respond over seconds
MAX_ROWS = 5000  # a longer log has longer steps
MIN_ROWS = 100
# [s] time constants of turning, and of gathering way, of small and of large boats
TURN_LAGS = (0.2, 0.5, 1.0, 2.0, 5.0, 15.0)
SPEED_LAGS = (0.5, 1.0, 2.0, 5.0, 15.0, 50.0)
# An effect is one from this partial correlation on, and if chance causes less than one in 10,000:
# four standard deviations, counted with the independent rows only
MIN_PARTIAL = 0.2
MIN_DEVIATIONS = 4.0
SAME = 0.995  # correlation from which two outputs are copies, such as an input and its output


@dataclass(frozen=True)
class DriveEffect:
    """Effects of an output on the motion, as partial correlations; 0 where none is certain.

    Attributes:
        ahead: With the speed ahead.
        turn: With the rate of turn to starboard.
    """

    ahead: float
    turn: float


@dataclass(frozen=True)
class MotionOfLog:
    """Motion with which outputs are compared.

    Attributes:
        turn: Times (N,) [s] and rates of turn to starboard (N,), in an arbitrary unit.
        ahead: Times (M,) [s] and speeds ahead (M,), in an arbitrary unit.
    """

    turn: tuple[Array, Array]
    ahead: tuple[Array, Array]


def motion_of_log(
    best: Mapping[str, Sequence[Classification]], turning: Turning, track: Track | None, enu: bool
) -> MotionOfLog:
    """Return the motion of a log.

    Args:
        best: Column -> classified signals, the most probable first.
        turning: Turning of the vessel.
        track: Motion by the positions; None if unknown.
        enu: Whether yaws count from east to port, as in ROS.
    """
    if best.get("u_mps"):
        return MotionOfLog((turning.t, turning.r), values_in_si(best["u_mps"][0]))
    if track is None:
        return MotionOfLog((turning.t, turning.r), (np.empty(0), np.empty(0)))
    speed = track.speed
    headings = best.get("psi_rad", ())
    if headings and not enu and not has_opposite_sense("psi_rad", headings[0].tokens):
        at, psi = values_in_si(headings[0])
        if len(at) > 1:
            bow = np.interp(track.t, at, np.unwrap(psi))
            speed = track.north * np.cos(bow) + track.east * np.sin(bow)
    return MotionOfLog((turning.t, turning.r), (track.t, speed))


def effects_on_motion(outputs: Sequence[Classification], motion: MotionOfLog) -> list[DriveEffect]:
    """Return the effects of all outputs on the motion, of each with the others held.

    Args:
        outputs: The outputs; copies of another one must be left out.
        motion: Motion of the log.
    """
    turns = _partial_correlations(outputs, *motion.turn, TURN_LAGS)
    ahead = _partial_correlations(outputs, *motion.ahead, SPEED_LAGS)
    return [DriveEffect(a, t) for a, t in zip(ahead, turns, strict=True)]


def without_copies(
    outputs: Sequence[Classification],
) -> tuple[list[Classification], dict[str, str]]:
    """Return outputs without copies of another one, and the copied output of each copy by name."""
    kept: list[Classification] = []
    copies: dict[str, str] = {}
    for g in outputs:
        for other in kept:
            rows = _rows([g, other], other.signal.t)
            if len(rows) < MIN_ROWS:
                continue
            both = np.corrcoef(_held(g, rows), _held(other, rows))
            if abs(float(both[0, 1])) > SAME:
                copies[g.name] = other.name
                break
        else:
            kept.append(g)
    return kept, copies


def _rows(outputs: Sequence[Classification], t: Array) -> Array:
    """Times (N,) [s] at which outputs and a motion are known."""
    known = t[np.isfinite(t)]
    if not len(known):
        return np.empty(0)
    begin, end = float(known.min()), float(known.max())
    for g in outputs:
        own = g.signal.t[np.isfinite(g.signal.t) & np.isfinite(g.signal.values)]
        if not len(own):
            return np.empty(0)
        begin, end = max(begin, float(own.min())), min(end, float(own.max()))
    step = max(STEP, (end - begin) / MAX_ROWS)
    return np.arange(begin, end, step)


def _held(g: Classification, rows: Array) -> Array:
    """Values (N,) of an output in force at some times."""
    finite = np.isfinite(g.signal.values) & np.isfinite(g.signal.t)
    t, order = np.unique(g.signal.t[finite], return_index=True)
    return held_values(t, g.signal.values[finite][order], rows)


def _partial_correlations(
    outputs: Sequence[Classification], t: Array, values: Array, lags: Sequence[float]
) -> list[float]:
    """Partial correlation of each output with a motion, at the best lag; 0 where not certain."""
    none = [0.0] * len(outputs)
    known = np.isfinite(t) & np.isfinite(values)
    t, values = t[known], values[known]
    rows = _rows(outputs, t)
    if not outputs or len(rows) < MIN_ROWS + len(outputs) or len(t) < 2:
        return none
    followed = np.interp(rows, t, values)
    if not float(np.ptp(followed)) > 0.0:
        return none
    step = float(rows[1] - rows[0])
    orders = np.column_stack([_held(g, rows) for g in outputs])
    orders = orders - orders[0]
    best, least = none, np.inf
    for lag in lags:
        share = 1.0 - np.exp(-step / lag)
        lagged = lfilter([share], [1.0, share - 1.0], orders, axis=0)
        left, found = _regression(lagged, followed)
        if left < least:
            best, least = found, left
    return best


def _regression(orders: Array, followed: Array) -> tuple[float, list[float]]:
    """Sum of the squared residuals of a regression, and the certain partial correlations."""
    count = orders.shape[1]
    size = np.std(orders, axis=0)
    none = [0.0] * count
    if not (size > 0.0).all():
        return float(np.inf), none
    trend = np.linspace(-1.0, 1.0, len(followed))
    design = np.column_stack([orders / size, np.ones(len(followed)), trend])
    inverse = np.linalg.pinv(design.T @ design)
    slopes = inverse @ design.T @ followed
    residual = followed - design @ slopes
    left = float(residual @ residual)
    free = len(followed) - design.shape[1]
    variance = np.maximum(np.diag(inverse)[:count] * left / free, 1e-300)
    deviations = slopes[:count] / np.sqrt(variance)
    partial = deviations / np.sqrt(deviations**2 + free)
    memory = 0.0
    if left > 0.0:
        memory = float(np.clip(residual[1:] @ residual[:-1] / left, 0.0, 0.999))
    certain = np.abs(deviations) * np.sqrt((1.0 - memory) / (1.0 + memory)) > MIN_DEVIATIONS
    kept = np.where(certain & (np.abs(partial) > MIN_PARTIAL), partial, 0.0)
    return left, kept.tolist()
