"""How large a recording may be: what is beyond is refused before it is read, or memory taken for it.

A log of 10 h at 50 Hz with 25 columns has 45 million cells.
"""

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from boatsim.recordings.raw_table import refuse

MOST_COLUMNS = 2000
MOST_CELLS = 100_000_000  # 0.8 GB as floats
LARGEST_FILE = 4 << 30  # bytes
LONGEST_HEADER = 1 << 20  # bytes of the first line of a text
# memory that a text takes while it is read, by its size: a cell of 8 characters is an object of 57
# bytes
GROWS = 12
# of memory that a binary table takes: as it is read, as floats, and what is asked of them
BYTES_PER_CELL = 24
GROUPS = (
    "/sys/fs/cgroup/memory.max",
    "/sys/fs/cgroup/memory/memory.limit_in_bytes",
)  # of a container, v2 and v1


def check_file(path: Path) -> None:
    """Raises BadInput for a file that can not be read in the memory there is."""
    size = path.stat().st_size
    if size > LARGEST_FILE:
        raise refuse(
            path, f"has {size / 1e9:.1f} GB; a recording has at most {LARGEST_FILE / 1e9:.1f} GB"
        )
    check_memory(path, GROWS * size)


def check_shape(path: Path, columns: int, cells: int = 0) -> None:
    """Raises BadInput for more columns or cells than a recording may have; `cells` 0 where they are not known yet."""
    if columns > MOST_COLUMNS:
        raise refuse(path, f"has {columns} columns; a recording has at most {MOST_COLUMNS}")
    if cells > MOST_CELLS:
        raise refuse(path, f"has {cells:.3g} cells; a recording has at most {MOST_CELLS:.3g}")
    check_memory(path, BYTES_PER_CELL * cells)


def check_memory(path: Path, needed: float) -> None:
    """Raises BadInput where reading would take more memory [bytes] than is free."""
    free = free_memory()
    if needed > free:
        raise refuse(
            path,
            f"needs about {needed / 1e9:.1f} GB of memory to be read; {free / 1e9:.1f} GB are free",
        )


def free_memory() -> float:
    """Memory [bytes] that can be taken without swapping, by the machine and by the container; inf where none says."""
    found = [float("inf")]
    with suppress(OSError, ValueError, StopIteration):
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        found.append(
            1024.0 * int(_second(line for line in lines if line.startswith("MemAvailable:")))
        )
    for file in GROUPS:
        with suppress(OSError, ValueError):  # "max" where there is no limit
            found.append(float(int(Path(file).read_text(encoding="ascii"))))
    return min(found)


def _second(lines: Iterable[str]) -> str:
    return next(iter(lines)).split()[1]
