"""Removal of samples that are no measurements, and of delays of positions."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.conversion_state import ConversionState
from boatsim.recordings.importing.log import HUGE
from boatsim.recordings.importing.queued_messages import Queue, late_samples, queued_positions
from boatsim.recordings.importing.regular_times import regular_times, values_at_rows
from boatsim.recordings.importing.resample import Samples
from boatsim.recordings.importing.track import constant_heading_fault
from boatsim.recordings.interpolated_wraps import ACROSS_WRAP, interpolated_wrap_rows
from boatsim.recordings.repeated_values import repeated_rows, stale_rows
from boatsim.recordings.table import FEWEST_ROWS

# Columns of one fix
PLACE = ("x_m", "y_m")
TOGETHER = (PLACE, ("psi_rad",))
# A track begins with positions that were not measured if it leaps from 0 by this many usual steps
MIN_LEAP, USUAL_STEP_PERCENTILE = 10.0, 99.0
MOST_IN_ROWS = 0.9  # of the positions are in rows of others; queued angles may have been omitted


def check_values(work: ConversionState, name: str, given: Samples) -> Samples:
    """Return the samples of a column.

    Args:
        work: State of the conversion.
        name: Name of the column.
        given: The samples.

    Raises:
        BadInput: There are none, or one is too large for a measurement.
    """
    if not len(given.t):
        raise BadInput(f"{work.file}: columns.{name} has no number in {work.log.path.name}")
    largest = float(np.abs(given.values).max())
    if largest >= HUGE:
        raise BadInput(
            f"{work.file}: columns.{name} = {largest:.3g}; no measurement is as large as {HUGE:g}"
        )
    return given


def drop_half_fixes(work: ConversionState) -> None:
    """Remove coordinates whose other one is missing, in a log that has both in the same rows.

    What tells good positions from bad ones compares both.

    Args:
        work: State of the conversion, which gets remarks.
    """
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or np.array_equal(x.given.t, y.given.t):
        return
    whole = np.intersect1d(x.given.t, y.given.t)
    half = len(x.given.t) + len(y.given.t) - 2 * len(whole)
    if len(whole) < MOST_IN_ROWS * max(len(x.given.t), len(y.given.t)):
        return
    for name, column in (("x_m", x), ("y_m", y)):
        kept = np.isin(column.given.t, whole)
        given = Samples(column.given.t[kept], column.given.values[kept])
        work.columns[name] = replace(column, given=given)
    what = "1 coordinate" if half == 1 else f"{half} coordinates"
    work.remark(f"x_m, y_m: omitted {what} whose other one is missing")


def check_heading(work: ConversionState) -> None:
    """Refuse a heading that the program wrote although no sensor sent one.

    Args:
        work: State of the conversion.

    Raises:
        BadInput: The heading is constant although the course changes.
    """
    there = [work.columns.get(name) for name in ("x_m", "y_m", "psi_rad")]
    x, y, psi = there
    if x is None or y is None or psi is None or len(x.given.t) != len(y.given.t):
        return
    fault = constant_heading_fault(x.given.t, x.given.values, y.given.values, psi.given.values)
    if fault:
        raise BadInput(f"{work.file}: columns.psi_rad {fault}")


def drop_unfixed(work: ConversionState) -> None:
    """Remove positions of exactly 0 and 0 before the first fix, from which the track leaps away."""
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return
    track = x.given.values + 1j * y.given.values
    moved = track != 0.0
    first = int(np.argmax(moved))
    if first == 0 or len(track) - first < FEWEST_ROWS:
        return
    usual = float(np.percentile(np.abs(np.diff(track[first:])), USUAL_STEP_PERCENTILE))
    if abs(track[first]) < MIN_LEAP * usual:
        return
    after = x.given.t[first] - work.begin
    work.remark(
        f"x_m, y_m: omitted {first} positions of 0, 0 before the first fix, which is "
        f"{abs(track[first]):.3g} m away, {after:.3f} s after the log begins"
    )
    for name, column in (("x_m", x), ("y_m", y)):
        kept = Samples(column.given.t[first:], column.given.values[first:])
        work.columns[name] = replace(column, given=kept)


def drop_interpolated_wraps(work: ConversionState) -> None:
    """Remove headings that a logger interpolated across the jump from a full turn to zero.

    Args:
        work: State of the conversion, which gets remarks.
    """
    column = work.columns.get("psi_rad")
    if column is None or column.held:
        return
    t, values = column.given.t, column.given.values
    rows = interpolated_wrap_rows(values)
    if not rows.any():
        return
    first = int(np.argmax(rows))
    work.remark(
        f"psi_rad: {int(rows.sum())} of {len(rows)} samples {ACROSS_WRAP}; the first is sample "
        f"{first + 1}, {t[first] - work.begin:.4g} s after the beginning"
    )
    work.columns["psi_rad"] = replace(column, given=Samples(t[~rows], values[~rows]))


def drop_repeats(work: ConversionState) -> None:
    """Remove fixes that the logger repeated, for they are not measurements."""
    for names in TOGETHER:
        there = [work.columns[n] for n in names if n in work.columns]
        if len(there) < len(names) or any(len(c.given.t) != len(there[0].given.t) for c in there):
            continue
        repeated = repeated_rows(np.column_stack([c.given.values for c in there]))
        if repeated.any():
            work.remark(
                f"{', '.join(names)}: {int(repeated.sum())} of {len(repeated)} samples repeat "
                "the one before and are not measurements, "
                f"{work.first_of(there[0].given.t[repeated])}; they are left empty"
            )
            for name, c in zip(names, there, strict=True):
                work.columns[name] = replace(
                    c, given=Samples(c.given.t[~repeated], c.given.values[~repeated])
                )


def position_queues(work: ConversionState) -> list[Queue]:
    """Return the intervals in which positions were read that had queued during a stall."""
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return []
    t, north, east = x.given.t, x.given.values, y.given.values
    if np.isfinite(work.begin) and work.begin < t[0]:  # rows without a fix at the beginning
        t = np.append(work.begin, t)
        north, east = np.append(np.nan, north), np.append(np.nan, east)
    return list(queued_positions(t, north, east))


def drop_queued(work: ConversionState, queues: Sequence[Queue], names: Sequence[str]) -> None:
    """Remove samples of some poses and rates that had queued with the positions.

    Args:
        work: State of the conversion.
        queues: Intervals in which queued positions were read.
        names: Columns of the poses and rates.
    """
    for queue in queues:
        dropped = []
        for name in names:
            column = work.columns.get(name)
            if column is None or column.held:
                continue
            t, values = column.given.t, column.given.values
            late = late_samples(t, values, queue)
            if late.any() and not late.all():
                work.columns[name] = replace(column, given=Samples(t[~late], values[~late]))
                dropped.append(name)
        if dropped:
            work.remark(
                f"{', '.join(dropped)}: the samples from {queue.begin - work.begin:.4g} s to "
                f"{queue.end - work.begin:.4g} s after the beginning had queued since "
                f"{queue.last - work.begin:.4g} s: {queue.evidence}; they are omitted"
            )


def regularize_positions(work: ConversionState) -> None:
    """Correct positions that a program read late, where their sensor measures in a rhythm.

    In a table the program wrote them into the rows of other sensors. There they are moved along the
    track to the times of these rows: rows of their own would make a recording half as long again,
    and a diagnosis as slow.

    Args:
        work: State of the conversion, which gets remarks.
    """
    x, y = work.columns.get("x_m"), work.columns.get("y_m")
    if x is None or y is None or not np.array_equal(x.given.t, y.given.t):
        return
    read = x.given.t
    found = regular_times(read, x.given.values + 1j * y.given.values)
    if found is None:
        return
    t, period = found
    shift = float(np.sqrt(np.mean((t - read) ** 2)))
    in_rows = _are_in_rows_of_others(work, read)
    how = "moved to the times of that rhythm"
    if in_rows:
        how = "moved along the track from the times of that rhythm to those of their rows"
    work.remark(
        f"x_m, y_m: the sensor measured every {period:.4g} s, but the program read it late; the "
        f"samples are {how}, by {shift:.2g} s rms"
    )
    for name, column in (("x_m", x), ("y_m", y)):
        samples = Samples(t, column.given.values)
        if in_rows:
            samples = Samples(read, values_at_rows(read, t, column.given.values))
        work.columns[name] = replace(column, given=samples)


def drop_stale(work: ConversionState) -> None:
    """Remove angles and rates that were logged again because no new message had arrived."""
    for name in (*POSE, *RATES):
        column = work.columns.get(name)
        if column is None or column.held:
            continue
        given = column.given
        stale = stale_rows(given.values)
        if not stale.any():
            continue
        longest = _longest_stale(given.t, stale)
        work.remark(
            f"{name}: {int(stale.sum())} of {len(stale)} samples repeat the one before exactly, "
            f"for up to {longest:.3g} s, because no new message had arrived, "
            f"{work.first_of(given.t[stale])}; they are left empty"
        )
        fresh = Samples(given.t[~stale], given.values[~stale])
        work.columns[name] = replace(column, given=fresh)


def _are_in_rows_of_others(work: ConversionState, t: Array) -> bool:
    """Whether most positions have the times of samples of another pose or rate."""
    for name, column in work.columns.items():
        if name in (*POSE, *RATES) and name not in PLACE and not column.held:
            if np.isin(t, column.given.t).mean() > MOST_IN_ROWS:
                return True
    return False


def _longest_stale(t: Array, stale: "np.ndarray[tuple[int, ...], np.dtype[np.bool_]]") -> float:
    """Longest time [s] from a new sample to the next one."""
    return float(np.diff(t[~stale]).max(initial=0.0))
