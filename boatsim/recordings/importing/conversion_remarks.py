"""Remarks on a recording: disorder, rates, held commands, files and times."""

from collections.abc import Mapping
from datetime import UTC, datetime
from math import isfinite

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.clocks import YEAR_2000, YEAR_2100
from boatsim.recordings.importing.conversion_state import ConversionState
from boatsim.recordings.importing.log import median_sampling_rate
from boatsim.recordings.importing.resample import MIN_LOST, longest_command_gap
from boatsim.recordings.table import MAX_GAP

MAX_FILES = 20  # of which the remarks list the spans


def remark_disorder(
    work: ConversionState, disorder: Mapping[tuple[int, int, float], list[str]]
) -> None:
    """Add remarks on samples out of order and on several samples at one time.

    Args:
        work: State of the conversion.
        disorder: Numbers of samples after a later one and at one time, and the first time [s] ->
            columns.
    """
    for (late, doubled, first), names in disorder.items():
        where = work.first_of(np.array([first]))
        if late:
            work.remark(
                f"{', '.join(names)}: {late} samples are logged after a later one, {where}; "
                "they are sorted by time"
            )
        if doubled:
            work.remark(
                f"{', '.join(names)}: {doubled} samples have the time of another one, {where}; "
                "of these the one logged last is used"
            )


def remark_spans(work: ConversionState, rows: Array) -> None:
    """Add remarks on the part that several files have in common.

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
    """
    for name, span in list(work.spans.items())[:MAX_FILES]:
        if len(work.spans) > 1:
            before, after = rows[0] - span.begin, span.end - rows[-1]
            file = work.log.path.with_name(name)
            work.remarks.append(
                f"{file}: {span.in_words()}; {max(before, 0.0):.3g} s before and "
                f"{max(after, 0.0):.3g} s after the rows are left out"
            )


def remark_rates(work: ConversionState, rows: Array) -> None:
    """Add remarks on signals that are measured less or more often than rows are written.

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
    """
    rate = median_sampling_rate(rows)
    slow: dict[str, list[str]] = {}
    quick: dict[str, list[str]] = {}
    for name, c in work.columns.items():
        inside = int(np.sum((c.given.t >= rows[0] - 1e-9) & (c.given.t <= rows[-1] + 1e-9)))
        if not c.held and c.given.rate < 0.9 * rate:
            slow.setdefault(f"{c.given.rate:.3g}", []).append(name)
        elif c.given.rate > 1.1 * rate and inside > len(rows):
            quick.setdefault(
                f"{c.given.rate:.3g} times a second: {inside - len(rows)} samples", []
            ).append(name)
    for times, names in slow.items():
        work.remark(
            f"{', '.join(names)}: measured {times} times a second; the other rows, {rate:.3g} a "
            "second, are empty"
        )
    for what, names in quick.items():
        work.remark(
            f"{', '.join(names)}: logged {what} between the {rate:.3g} rows a second are left out"
        )


def remark_held(work: ConversionState, rows: Array) -> None:
    """Add remarks on commands that are held for long without a new value.

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
    """
    for name, c in work.columns.items():
        if c.held and (longest := longest_command_gap(rows, c.given)):
            work.remark(
                f"{name} is held for up to {longest:.3g} s without a new value; was it still in "
                "force?"
            )


def remark_times(work: ConversionState, rows: Array) -> None:
    """Add remarks on the first time and on the longest gap of a recording.

    Args:
        work: State of the conversion.
        rows: Times (N,) of the rows [s].
    """
    if YEAR_2000 < rows[0] < YEAR_2100:
        work.remark(
            "t_s = 0 is "
            f"{datetime.fromtimestamp(float(rows[0]), UTC).isoformat(timespec='milliseconds')}"
        )
    elif isfinite(work.begin):
        work.remark(f"t_s = 0 is {rows[0] - work.begin:.3f} s after the log begins")
    steps = np.diff(rows)
    if (longest := float(steps.max())) > max(MIN_LOST, 5.0 * float(np.median(steps))):
        where = float(rows[int(np.argmax(steps))] - rows[0])
        more = ""
        if longest > MAX_GAP:
            more = (
                "; a diagnosis refuses it: write into recording.toml use = "
                f"[[0, {where:.6g}], [{where + longest:.6g}, {rows[-1] - rows[0]:.6g}]]"
            )
        work.remark(f"there is a gap of {longest:.3g} s at t = {where:.3f} s{more}")
