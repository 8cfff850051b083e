"""`python -m tests.fuzz --count N`: N mutated inputs in all, and what became of them, kind by kind.

Each kind is read in a process of its own. An input that ends in anything but a value or one clear
line is printed as a literal, with its traceback, and the exit code is 1. With `--state FILE` an
interrupted command continues where it stopped. docs/fuzzing.md has what 100,000 gave, and how to go
on for a night.
"""

import argparse
import faulthandler
import json
import subprocess
import sys
import traceback
from pathlib import Path
from typing import Any

from tests.fuzz.drive import PATIENCE, Broken, drive
from tests.fuzz.readers import READERS

COLUMNS = {  # of the table: what it is, width, digits
    "files": ("inputs", 8, 0),
    "refused": ("refused", 9, 0),
    "read": ("accepted", 10, 0),
    "raised": ("tracebacks", 12, 0),
    "hung": ("hangs", 7, 0),
    "slowest": ("slowest [s]", 13, 2),
    "memory": ("memory [MB]", 13, 0),
    "seconds": ("seconds", 9, 0),
}
ALONE = "--alone"  # in this process


def main() -> int:
    """Print a line for each kind of input."""
    asked = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description="Mutated inputs of every kind."
    )
    asked.add_argument("--count", type=int, default=1000, help="mutated inputs in all")
    asked.add_argument(
        "--seconds", type=float, default=float("inf"), help="for all of them, if that is less"
    )
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument(
        "--reader", choices=sorted(READERS), action="append", help="only this; may be repeated"
    )
    asked.add_argument("--state", type=Path, help="file of finished kinds, to continue from")
    asked.add_argument(ALONE, action="store_true", help=argparse.SUPPRESS)
    given = asked.parse_args()
    chosen = given.reader or list(READERS)
    if given.alone:
        return alone(chosen[0], given.count, given.seconds, given.seed)
    about = {"seed": given.seed, "count": given.count, "kinds": chosen, "commit": commit()}
    finished = _finished(given.state, about)
    print(f"seed {given.seed}, commit {about['commit']}")
    headings = "".join(f"{heading:>{width}}" for heading, width, _ in COLUMNS.values())
    print(f"{'kind':17}{headings}", flush=True)
    shares = sum(READERS[name].share for name in chosen)
    sums, codes = dict.fromkeys(COLUMNS, 0.0), []
    for name in chosen:
        if name not in finished:
            count = round(given.count * READERS[name].share / shares)
            finished[name] = apart(name, count, given.seconds / len(chosen), given.seed)
            _keep(given.state, name, finished[name])
        print(*finished[name]["lines"], sep="\n", flush=True)
        codes.append(finished[name]["code"])
        for key, value in finished[name]["figures"].items():
            most = key in ("slowest", "memory")
            sums[key] = max(sums[key], value) if most else sums[key] + value
    print(row("all", sums))
    return max(codes)


def commit() -> str:
    """The commit of the program, with a + if files were changed since."""
    asked = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty=+"]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def _finished(state: Path | None, about: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Finished kinds of the same command; the file is begun if there is none."""
    if state is None:
        return {}
    if not state.exists():
        state.write_text(f"{json.dumps(about)}\n", encoding="utf-8")
    first, *others = state.read_text(encoding="utf-8").splitlines()
    if json.loads(first) != about:
        sys.exit(f"{state} is of another command or commit: {first}")
    return dict(map(json.loads, others))


def _keep(state: Path | None, name: str, found: dict[str, Any]) -> None:
    if state is not None:
        with state.open("a", encoding="utf-8") as file:
            file.write(f"{json.dumps([name, found])}\n")


def apart(name: str, count: int, seconds: float, seed: int) -> dict[str, Any]:
    """Read a kind in a process of its own; its exit code, figures and the lines to print."""
    words = [sys.executable, "-m", "tests.fuzz", ALONE, "--reader", name]
    words += [f"--count={count}", f"--seconds={seconds}", f"--seed={seed}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    *said, last = done.stdout.splitlines() or [""]
    try:
        figures = {key: float(value) for key, value in json.loads(last).items()}
        return {"code": done.returncode, "figures": figures, "lines": [row(name, figures), *said]}
    except ValueError:  # native code has ended it
        ended = f"{name}: its process ended with {done.returncode}"
        return {"code": 1, "figures": {}, "lines": [ended, done.stdout, done.stderr[-4000:]]}


def row(name: str, figures: dict[str, float]) -> str:
    """A line of the table."""
    cells = ""
    for key, (_, width, digits) in COLUMNS.items():
        cells += f"{figures[key]:{width}.{digits}f}"
    return f"{name:17}{cells}"


def alone(name: str, count: int, seconds: float, seed: int) -> int:
    """Read a kind here, and print what broke it and last its figures."""
    faulthandler.enable()
    faulthandler.dump_traceback_later(
        seconds + 60.0 * PATIENCE if seconds < float("inf") else 6 * 3600.0, exit=True
    )
    found = drive(READERS[name], count, seed, seconds)
    for broken in found.kinds():
        show(name, broken)
    print(json.dumps(found.figures()))
    return int(bool(found.broken))


def show(name: str, broken: Broken) -> None:
    """An input that broke a reader, and how."""
    print(f"{name}: {broken.content[:4000]!r}")
    traceback.print_exception(broken.error, file=sys.stdout)


if __name__ == "__main__":
    sys.exit(main())
