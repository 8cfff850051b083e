"""Measure a long run, and what remains of a run that is killed.

    python -m benchmarks.long_run [--hours 24]

Runs of joystick_boat with a row every 20 ms in separate processes: peak memory for an hour and for the
given time, of the process alone and with the pages of its log that the system caches. Then a run is
killed after a minute, as by `kill -9`, and the files on the disk are read.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from boatsim.recordings.table import read
from boatsim.simulate.growing_table import PIECE

HOUR, KILLED_AFTER, LOOK = 3600.0, 60.0, 0.2  # [s]
ON_DISK = ("recording.csv", "camera.csv", "run.rrd")
SCENARIO = """
vessel = "joystick_boat"
duration = {}
step = 0.02
[controller]
use = "l1_joystick"
[[goal]]
sway_mps = 0.07
[[check]]
signal = "v_mps"
norm = "rms"
below = 1.0
"""


def start_run(folder: Path, hours: float) -> "subprocess.Popen[bytes]":
    """Start a run in a process."""
    (folder / "long.toml").write_text(SCENARIO.format(hours * HOUR))
    words = [
        sys.executable,
        "-m",
        "boatsim",
        "run",
        str(folder / "long.toml"),
        "--out",
        str(folder / "out"),
    ]
    return subprocess.Popen(words, stdout=subprocess.DEVNULL)


def process_memory(process: int) -> tuple[float, float]:
    """Return the memory [MB] of a process: alone, and with pages of files; zero if it has ended."""
    try:
        lines = Path(f"/proc/{process}/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0.0, 0.0
    said = {
        line.partition(":")[0]: line.split()[1]
        for line in lines
        if line.startswith("Rss") or "VmHWM" in line
    }
    return float(said.get("RssAnon", 0.0)) / 1024, float(said.get("VmHWM", 0.0)) / 1024


def measure_whole_run(hours: float) -> str:
    """Run to the end and return a row of the table."""
    with TemporaryDirectory() as base:
        folder, since, own, all_of_it = Path(base), time.monotonic(), 0.0, 0.0
        run = start_run(folder, hours)
        while run.poll() is None:
            now = process_memory(run.pid)
            own, all_of_it = max(own, now[0]), max(all_of_it, now[1])
            time.sleep(LOOK)
        took = time.monotonic() - since
        content = json.loads((folder / "out" / "norms.json").read_text(encoding="utf-8"))
        written = sum(f.stat().st_size for f in (folder / "out").iterdir()) / 1e6
        return f"{hours:10g}{content['steps']:12}{took:10.0f}{own:12.0f}{all_of_it:16.0f}{written:14.0f}"


def check_killed_run(hours: float) -> list[str]:
    """Kill a run and return lines that describe its files."""
    with TemporaryDirectory() as base:
        folder = Path(base)
        run = start_run(folder, hours)
        time.sleep(KILLED_AFTER)
        at = time.time()
        run.kill()
        run.wait()
        (left,) = folder.glob("out.part-*")
        lines = [
            f"killed after {KILLED_AFTER:g} s, leaves {', '.join(sorted(f.name for f in left.iterdir()))}"
        ]
        for name in ON_DISK:
            found, behind = read(left / name), at - (left / name).stat().st_mtime
            lines.append(
                f"  {name:14} {len(found)} rows, to {found.t[-1]:.2f} s; written {behind:.2f} s before it"
            )
        norms = left / "norms.json"
        so_far = json.loads(norms.read_text(encoding="utf-8"))
        behind = at - norms.stat().st_mtime
        return [
            *lines,
            f"  norms.json     of the first {so_far['steps']} steps; written {behind:.2f} s before it",
        ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=24.0, help="of the long run")
    given = parser.parse_args()
    os.nice(10)
    print(f"memory holds {PIECE} rows of the log; the rest lies in a file\n")
    print(
        f"{'hours':>10}{'steps':>12}{'took [s]':>10}{'own [MB]':>12}{'with files [MB]':>16}{'written [MB]':>14}"
    )
    for hours in (1.0, given.hours):
        print(measure_whole_run(hours), flush=True)
    print()
    print("\n".join(check_killed_run(given.hours)))


if __name__ == "__main__":
    main()
