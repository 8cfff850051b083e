"""Measure the cost of reading large files and of refusing larger ones: `python -m benchmarks.reading`.

Each file is read in a separate process. Seconds are the CPU time of reading, without the start of
Python; memory is the peak of the process, libraries included.
"""

import json
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyarrow as pa
from pyarrow import parquet

from boatsim.errors import BadInput
from boatsim.recordings.importing.log import open_log
from boatsim.recordings.table import Recording, read, write_csv

HOURS, RATE = 10.0, 50.0  # [h], [Hz]
NAMES = (
    "x_m",
    "y_m",
    "psi_rad",
    "thrust_port_N",
    "thrust_starboard_N",
    "steer_port_rad",
    "steer_starboard_rad",
)
WIDE = 30_000  # columns
PIECE = 2_000_000  # rows written together
PIECES = 64  # number of pieces: 5.1 GB of five columns


def random_long_recording() -> Recording:
    """Return ten hours of slow oscillations with noise."""
    rng, t = np.random.default_rng(0), np.arange(round(HOURS * 3600 * RATE)) / RATE
    slow = [
        0.3 * np.sin(0.01 * (i + 1) * t) + 0.003 * rng.standard_normal(len(t))
        for i in range(len(NAMES))
    ]
    return Recording("long", t, dict(zip(NAMES, slow, strict=True)))


def write_files(folder: Path) -> None:
    """Write the files."""
    run = random_long_recording()
    write_csv(run, folder / "ten_hours.csv")
    parquet.write_table(pa.table({"t_s": run.t, **run.signals}), folder / "ten_hours.parquet")
    head, *rows = (folder / "ten_hours.csv").read_text().splitlines()
    (folder / "with_words.csv").write_text(
        "\n".join([head + ",mode", *(row + ",AUTO" for row in rows)])
    )
    names = ["t_s", *(f"c{i}" for i in range(WIDE - 1))]
    (folder / "wide.csv").write_text("\n".join([",".join(names), *[",".join("1" * WIDE)] * 100]))
    parquet.write_table(pa.table({n: np.arange(100.0) for n in names}), folder / "wide.parquet")
    with (folder / "many_cells.csv").open("wb") as file:
        file.write(b"t_s,x_m,y_m,psi_rad\n")
        for _ in range(400):
            file.write(b"1,2,3,4\n" * 250_000)
    piece = pa.table({n: np.zeros(PIECE) for n in ("t_s", *NAMES[:4])})
    with parquet.ParquetWriter(
        folder / "zeros.parquet", piece.schema, compression="zstd"
    ) as writer:
        for _ in range(PIECES):
            writer.write_table(piece)


def read_and_print_cost(path: Path, as_log: bool) -> None:
    """Read a file in this process and print seconds, memory [MB] and the result as JSON."""
    begin = time.process_time()
    try:
        if as_log:
            rows = len(next(iter(open_log(path).signals.values())).t)
        else:
            rows = len(read(path))
        found = f"{rows} rows"
    except BadInput as error:
        found = str(error).removeprefix(f"{path}: ")
    took = time.process_time() - begin
    status = Path("/proc/self/status").read_text(encoding="ascii")
    # getrusage would include the memory of the parent process
    peak = int(status.partition("VmHWM:")[2].split()[0]) / 1024
    print(json.dumps([took, peak, found]))


def main() -> None:
    """Print the table."""
    if len(sys.argv) == 3:
        return read_and_print_cost(Path(sys.argv[1]), sys.argv[2] == "log")
    print(f"{'file':20}{'size [MB]':>10}{'read as':>11}{'seconds':>9}{'memory [MB]':>13}  answer")
    with TemporaryDirectory() as base:
        write_files(Path(base))
        for path in sorted(Path(base).iterdir()):
            for how in ("recording", "log"):
                words = [sys.executable, "-m", "benchmarks.reading", str(path), how]
                done = subprocess.run(words, stdout=subprocess.PIPE, check=True)
                seconds, peak, found = json.loads(done.stdout)
                size = path.stat().st_size / 1e6
                print(
                    f"{path.name:20}{size:10.1f}{how:>11}{seconds:9.2f}{peak:13.0f}  {found}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
