"""Shift of late columns of a recording to the times at which they were true.

No value is interpolated: each sample keeps its value and gets an earlier time. Where no row has
that time the recording gets one more row, in which the other poses and rates are empty.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.resample import (
    SAME_TIME,
    Samples,
    clean_samples,
    mean_held_values,
    nearest_samples,
    row_times,
)

ON_ROW = 0.05  # a sample is in a row if it is nearer than this share of the step of the rows
# Share of additional rows below which samples go to the nearest row: the clock only jitters
FEW_ROWS = 0.15
FIX = ("x_m", "y_m")  # columns of one measurement


def shifted_columns(
    t: Array, signals: Mapping[str, Array], latency: Mapping[str, float], place: str
) -> tuple[Array, dict[str, Array]]:
    """Return the rows of a recording whose late columns have the times at which they were true.

    Args:
        t: Times (N,) of the rows [s].
        signals: Name -> values (N,).
        latency: Column -> delay of its values [s]; the value of a row was true that much earlier.
        place: Name of the recording in messages.

    Returns:
        Times (M,) [s] and values (M,) of all signals.

    Raises:
        BadInput: A column does not exist, or x_m and y_m have different delays.
    """
    if not any(latency.values()):
        return t, dict(signals)
    for name in latency:
        if name not in signals:
            raise BadInput(f"{place}: {unknown_name_message('latency: column', name, signals)}")
    if len({latency.get(name, 0.0) for name in FIX if name in signals}) > 1:
        raise BadInput(
            f"{place}: latency: x_m and y_m are one measurement; allowed is one delay for both"
        )
    measured: dict[str, Samples] = {}
    held: dict[str, Samples] = {}
    for name, values in signals.items():
        samples = clean_samples(t - latency.get(name, 0.0), values)
        if name in (*POSE, *RATES) or np.isnan(values).any():
            measured[name] = samples
        else:
            held[name] = samples
    moved = [samples for name, samples in measured.items() if latency.get(name)]
    rows, near = _rows(t, moved)
    # another column with empty rows may end early, as where the hull leaves the view of a camera
    motion = [samples for name, samples in measured.items() if name in (*POSE, *RATES)]
    rows = _common_rows(rows, [*moved, *motion, *held.values()], near)
    rows = rows[_has_begun(rows, held.values())]  # a command is not known before its first sample
    shifted: dict[str, Array] = {}
    for name in signals:
        if name in held:
            shifted[name] = mean_held_values(rows, held[name])
        else:
            shifted[name] = nearest_samples(rows, measured[name], near)
    return rows, shifted


def _has_begun(rows: Array, held: Iterable[Samples]) -> NDArray[np.bool_]:
    """Whether all held signals have a value in each row (N,)."""
    begin = max((float(samples.t[0]) for samples in held if len(samples.t)), default=-np.inf)
    return np.asarray(rows >= begin - SAME_TIME)


def shifted_commands(
    t: Array, signals: Mapping[str, Array], latency: Mapping[str, float]
) -> tuple[Array, dict[str, Array]]:
    """Return commands at their own times that are moved to the times at which they were in force.

    Args:
        t: Times (K,) [s]; each command is in force until the next.
        signals: Command -> values (K,).
        latency: Column -> delay of its values [s].

    Returns:
        Times (M,) [s] of all changes, and values (M,).
    """
    own = {name: t - latency.get(name, 0.0) for name in signals}
    times = np.unique(np.concatenate([t[:0], *own.values()]))
    shifted: dict[str, Array] = {}
    for name, values in signals.items():
        last = np.searchsorted(own[name], times, side="right") - 1
        shifted[name] = values[np.maximum(last, 0)]
    return times, shifted


def _rows(t: Array, moved: Sequence[Samples]) -> tuple[Array, float]:
    """Times (N,) of the rows [s], and the largest distance of a sample from its row [s]."""
    step = float(np.median(np.diff(t)))
    near = ON_ROW * step
    rows = row_times(t, moved, near)
    if len(rows) > (1.0 + FEW_ROWS) * len(t):
        return rows, near
    return t, 0.5 * step


def _common_rows(rows: Array, all_samples: Sequence[Samples], near: float) -> Array:
    """The rows (N,) in which every column has begun and none has ended."""
    begin, end = rows[0], rows[-1]
    for samples in all_samples:
        if len(samples.t):
            begin = max(begin, float(samples.t[0]) - near)
            end = min(end, float(samples.t[-1]) + near)
    return np.asarray(rows[(rows >= begin) & (rows <= end)])
