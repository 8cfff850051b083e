"""Reader of the `.rrd` of runs: columns are scalars under `signals/` on one time line.

The file is read in a child process, for rerun's native code ends its process on a damaged file.
"""

import itertools
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rerun.chunk import RrdReader

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.limits import check_table_size
from boatsim.recordings.raw_table import Raw

TIMELINE = "sim_time"
SIGNALS = "signals"
READ = """
import json, sys
sys.path[:] = json.loads(sys.argv[1])
from boatsim.recordings.readers import rrd
rrd.main_of_child_process()
"""
REFUSED = 3  # exit code of the child process when it prints the reason


def read(path: Path) -> Raw:
    """Return the table of a run's `.rrd`, t_s first.

    A signal is nan in rows in which it was not logged.

    Raises:
        BadInput: If the file is damaged, too large or not of a run.
    """
    with tempfile.TemporaryDirectory(prefix="boatsim-") as folder:
        table = Path(folder) / "table.npz"
        command = [
            sys.executable,
            "-P",
            "-c",
            READ,
            json.dumps(sys.path),
            os.fspath(path),
            os.fspath(table),
        ]
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False
        )
        if done.returncode == REFUSED:
            raise BadInput(done.stdout.decode("utf-8", "replace"))
        if done.returncode != 0:
            raise BadInput(f"{path}: cannot be read as .rrd (rerun's reader fails on it)")
        with np.load(table, allow_pickle=False) as found:
            columns = {}
            for i, name in enumerate(found["names"]):
                columns[str(name)] = found[f"c{i}"]
    return Raw(path, columns, range(1, 1 + len(columns["t_s"])))


def main_of_child_process() -> None:
    """Read the file in the child process.

    `sys.argv` has the path of the `.rrd` and of the table to write.
    """
    path, table = map(Path, sys.argv[2:])
    try:
        columns = read_columns(path)
    except BadInput as error:
        sys.stdout.buffer.write(str(error).encode("utf-8", "replace"))
        sys.exit(REFUSED)
    arrays: dict[str, Any] = {}
    for i, values in enumerate(columns.values()):
        arrays[f"c{i}"] = values
    np.savez(table, names=np.array(list(columns)), **arrays)


def read_columns(path: Path) -> dict[str, Array]:
    """Return the columns by name, each (N,).

    Raises:
        BadInput: If the file cannot be read; a damaged file may end the process.
    """
    series: dict[str, tuple[list[Array], list[Array]]] = {}
    cells = 0
    try:
        for name, nanoseconds, values in _scalars(path):
            times, pieces = series.setdefault(name, ([], []))
            times.append(nanoseconds)
            pieces.append(values)
            cells += len(values)
            check_table_size(path, len(series), cells)
    except (ValueError, OSError, RuntimeError) as error:
        raise BadInput(
            f"{path}: cannot be read as .rrd ({' '.join(str(error).split())[:200]})"
        ) from error
    if not series:
        raise BadInput(f"{path}: is not the log of a boatsim run; it has nothing under /{SIGNALS}")
    times_of_all = itertools.chain.from_iterable(times for times, _ in series.values())
    rows = np.unique(np.concatenate(list(times_of_all)))
    check_table_size(path, len(series), len(series) * len(rows))
    columns = {"t_s": rows * 1e-9}
    for name, (times, pieces) in series.items():
        columns[name] = np.full(len(rows), math.nan)
        columns[name][np.searchsorted(rows, np.concatenate(times))] = np.concatenate(pieces)
    return columns


def last_time(path: Path | str) -> float:
    """Return the last time of a run's log [s]."""
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
        yield (
            name,
            times.to_numpy(zero_copy_only=False),
            values.flatten().to_numpy(zero_copy_only=False),
        )
