"""Limits of the size of recordings, which are checked before memory is allocated.

A log of 10 h at 50 Hz with 25 columns has 45 million cells.
"""

from contextlib import suppress
from pathlib import Path

from boatsim.recordings.raw_table import file_error

MAX_COLUMNS = 2000
MAX_CELLS = 100_000_000  # 0.8 GB as floats
MAX_FILE_BYTES = 4 << 30  # bytes
MAX_HEADER_BYTES = 1 << 20  # bytes of the first line of a text
# Memory to read a text file per byte of it: a cell of 8 characters is an object of 57 bytes
MEMORY_PER_BYTE = 12
# Memory of a binary table: the content of the file, floats, and copies in computations
BYTES_PER_CELL = 24
# Memory limit of a container, cgroup versions 2 and 1
CGROUP_LIMITS = (
    "/sys/fs/cgroup/memory.max",
    "/sys/fs/cgroup/memory/memory.limit_in_bytes",
)


def check_file_size(path: Path) -> None:
    """Check that a recording's file is small enough to be read into memory."""
    size = path.stat().st_size
    if size > MAX_FILE_BYTES:
        raise file_error(
            path, f"has {size / 1e9:.1f} GB; a recording has at most {MAX_FILE_BYTES / 1e9:.1f} GB"
        )
    check_free_memory(path, MEMORY_PER_BYTE * size)


def check_table_size(path: Path, columns: int, cells: int = 0) -> None:
    """Check that a table has few enough columns and cells to be read into memory.

    `cells` is 0 where the number of cells is not known yet.

    Raises:
        BadInput: If it is too large or does not fit into the free memory.
    """
    if columns > MAX_COLUMNS:
        raise file_error(path, f"has {columns} columns; a recording has at most {MAX_COLUMNS}")
    if cells > MAX_CELLS:
        raise file_error(path, f"has {cells:.3g} cells; a recording has at most {MAX_CELLS:.3g}")
    check_free_memory(path, BYTES_PER_CELL * cells)


def check_free_memory(path: Path, needed: float) -> None:
    """Check that the memory needed to read a file [bytes] is free. Raises BadInput if it is not."""
    free = free_memory()
    if needed > free:
        raise file_error(
            path,
            f"needs about {needed / 1e9:.1f} GB of memory to be read; {free / 1e9:.1f} GB are free",
        )


def free_memory() -> float:
    """Return the free memory of the machine or its container [bytes]; infinity where unknown."""
    found = [float("inf")]
    with suppress(OSError, ValueError):
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        for line in lines:
            if line.startswith("MemAvailable:"):
                found.append(1024.0 * int(line.split()[1]))
                break
    for file in CGROUP_LIMITS:
        with suppress(OSError, ValueError):  # "max" where there is no limit
            found.append(float(int(Path(file).read_text(encoding="ascii"))))
    return min(found)
