"""The `.rrd` of our own runs: every column lies as scalars under `signals/` on one time line."""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rerun.chunk import RrdReader

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.limits import check_shape
from boatsim.recordings.raw import Raw

TIMELINE = "sim_time"
SIGNALS = "signals"


def read(path: Path) -> Raw:
    """The columns of a run's `.rrd`, t_s first; rows in which a signal was not logged are nan. Raises BadInput."""
    series: dict[str, tuple[list[Array], list[Array]]] = {}
    cells = 0
    try:
        for name, nanoseconds, values in _scalars(path):
            times, pieces = series.setdefault(name, ([], []))
            times.append(nanoseconds)
            pieces.append(values)
            cells += len(values)
            check_shape(path, len(series), cells)
    except (ValueError, OSError, RuntimeError) as error:
        raise BadInput(f"{path}: can not be read as .rrd ({' '.join(str(error).split())[:200]})") from error
    if not series:
        raise BadInput(f"{path}: is not the log of a boatsim run; it has nothing under /{SIGNALS}")
    rows = np.unique(np.concatenate([part for times, _ in series.values() for part in times]))
    check_shape(path, len(series), len(series) * len(rows))
    columns = {"t_s": rows * 1e-9}
    for name, (times, pieces) in series.items():
        columns[name] = np.full(len(rows), math.nan)
        columns[name][np.searchsorted(rows, np.concatenate(times))] = np.concatenate(pieces)
    return Raw(path, columns, range(1, 1 + len(rows)))


def last_time(path: Path | str) -> float:
    """Time [s] at which a log of ours ends."""
    last = 0
    for chunk in RrdReader(path).stream():
        batch = chunk.to_record_batch()
        if TIMELINE in batch.schema.names and len(batch):
            last = max(last, int(np.max(batch.column(TIMELINE).cast("int64"))))
    return last * 1e-9


def _scalars(path: Path) -> Iterator[tuple[str, Array, Array]]:
    """Name, times [ns] and values of each chunk of a run's signals."""
    for chunk in RrdReader(path).stream():
        under, _, name = chunk.entity_path.strip("/").rpartition("/")
        if under != SIGNALS or chunk.is_static:
            continue
        batch = chunk.to_record_batch()
        values = batch.column(batch.schema.names.index("Scalars:scalars"))
        times = batch.column(batch.schema.names.index(TIMELINE)).cast("int64")
        yield name, times.to_numpy(zero_copy_only=False), values.flatten().to_numpy(zero_copy_only=False)
