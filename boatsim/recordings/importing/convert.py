"""Conversion of a log by its map to a recording: SI units, SNAME axes and one clock.

Remarks of the recording list all samples that were left out or held.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.column_values import column_values, wave_values
from boatsim.recordings.importing.conversion_remarks import (
    remark_disorder,
    remark_held,
    remark_spans,
    remark_times,
)
from boatsim.recordings.importing.conversion_state import HELD, Column, ConversionState
from boatsim.recordings.importing.currents import current_columns
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.log_times import with_continued_clocks, with_time_of_map
from boatsim.recordings.importing.mapping import Map
from boatsim.recordings.importing.position_columns import add_position
from boatsim.recordings.importing.recording_rows import (
    complete_rows,
    parts_of_rows,
    row_times_of_columns,
)
from boatsim.recordings.importing.resample import (
    clean_samples,
    count_unordered_samples,
    mean_held_values,
    nearest_samples,
)
from boatsim.recordings.importing.sample_repairs import (
    PLACE,
    check_heading,
    check_values,
    drop_half_fixes,
    drop_interpolated_wraps,
    drop_queued,
    drop_repeats,
    drop_stale,
    drop_unfixed,
    position_queues,
    regularize_positions,
)
from boatsim.recordings.importing.several_logs import align_clocks, file_spans
from boatsim.recordings.notes import Notes
from boatsim.recordings.table import Recording, is_command

UNBOUNDED = (-np.inf, np.inf)  # range of a measured direction, and of a drive that turns around


def unwrapped(values: Array) -> Array:
    """Return angles (N,) [rad] that go on across a full turn, so that their means are right.

    Args:
        values: Angles (N,) [rad]; nan where none was measured.
    """
    known = np.isfinite(values)
    smooth = np.array(values, dtype=float)
    smooth[known] = np.unwrap(smooth[known])
    return smooth


def convert_log(
    log: Log, map: Map, file: str, channels: Mapping[str, tuple[float, float]] | None = None
) -> Recording:
    """Convert a log to a recording, with the signals that a map assigns to the columns.

    Args:
        log: The log.
        map: Signals of the columns.
        file: Name of the map in messages.
        channels: Allowed range (low, high) of the vessel's commands.

    Raises:
        BadInput: One line with the key of the map for a signal that does not exist or cannot be
            converted.
    """
    log = with_continued_clocks(with_time_of_map(log, map, file))
    log = align_clocks(log, map.begins, file)
    spans = file_spans(log)
    begin = min((span.begin for span in spans.values()), default=0.0)
    remarks = list(log.remarks)
    work = ConversionState(
        log, file, map, channels or {}, remarks=remarks, begin=begin, spans=spans
    )
    if map.position:
        add_position(work, map.position)
    disorder: dict[tuple[int, int, float], list[str]] = {}
    for name, what in map.columns.items():
        t, values = column_values(work, name, what)
        t = t - map.latency.get(name, 0.0)
        if name.endswith("_rad") and work.channels.get(name) == UNBOUNDED:
            values = unwrapped(values)
        known = np.isfinite(values)  # of a table whose sensors share the rows
        disorder.setdefault(count_unordered_samples(t[known]), []).append(name)
        is_held = name in work.channels or is_command(name) or name.startswith(HELD)
        work.columns[name] = Column(check_values(work, name, clean_samples(t, values)), is_held)
    remark_disorder(work, disorder)
    drop_half_fixes(work)
    check_heading(work)
    drop_unfixed(work)
    drop_interpolated_wraps(work)
    drop_repeats(work)
    queues = position_queues(work)
    # before the rhythm of the positions, which would move theirs and leave the angles late
    drop_queued(work, queues, PLACE)
    regularize_positions(work)
    rows, near = row_times_of_columns(work)
    # after the times of the rows, in which commands go on
    drop_queued(work, queues, (*POSE, *RATES))
    drop_stale(work)
    signals: dict[str, Array] = {}
    for name, column in work.columns.items():
        if column.held:
            signals[name] = mean_held_values(rows, column.given)
        else:
            signals[name] = nearest_samples(rows, column.given, near)
    remark_held(work, rows)
    rows, signals = complete_rows(work, rows, signals)
    for name, probes in map.waves.items():
        signals[name] = np.interp(rows, *wave_values(work, name, probes))
    if map.current:
        signals |= current_columns(work, rows, signals, map.current)
    remark_spans(work, rows)
    remark_times(work, rows)
    return Recording(
        log.path.stem,
        np.round(rows - rows[0], 6),
        signals,
        notes=Notes(use=parts_of_rows(work, rows)),
        remarks=tuple(work.remarks),
        path=log.path,
    )
