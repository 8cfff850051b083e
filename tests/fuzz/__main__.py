"""`python -m tests.fuzz --count N`: N mutated files in all, and what became of them, reader by
reader.

Each reader is driven in a process of its own. A file that ends in anything but a value or one clear
line is printed as a literal, with its traceback, and the exit code is 1. docs/fuzzing.md has what
100,000 gave, and how to go on for a night.
"""

import argparse
import faulthandler
import json
import subprocess
import sys
import traceback

from tests.fuzz.drive import PATIENCE, Broken, drive
from tests.fuzz.readers import READERS

COLUMNS = {  # of the table: what it is, width, digits
    "files": ("files", 8, 0),
    "read": ("read", 8, 0),
    "refused": ("refused", 9, 0),
    "raised": ("raised", 8, 0),
    "hung": ("hung", 6, 0),
    "slowest": ("slowest [s]", 13, 2),
    "memory": ("memory [MB]", 13, 0),
    "seconds": ("seconds", 9, 0),
}
ALONE = "--alone"  # in this process


def main() -> int:
    """Print a line for each reader."""
    asked = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description="Mutated files for every reader."
    )
    asked.add_argument("--count", type=int, default=1000, help="mutated files in all")
    asked.add_argument(
        "--seconds", type=float, default=float("inf"), help="for all of them, if that is less"
    )
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument(
        "--reader", choices=sorted(READERS), action="append", help="only this; may be repeated"
    )
    asked.add_argument(ALONE, action="store_true", help=argparse.SUPPRESS)
    given = asked.parse_args()
    chosen = given.reader or list(READERS)
    if given.alone:
        return alone(chosen[0], given.count, given.seconds, given.seed)
    print(
        f"{'reader':16}" + "".join(f"{heading:>{width}}" for heading, width, _ in COLUMNS.values())
    )
    shares, sums, codes = (
        sum(READERS[name].share for name in chosen),
        dict.fromkeys(COLUMNS, 0.0),
        [],
    )
    for name in chosen:
        share = READERS[name].share / shares
        code, figures = apart(
            name, round(given.count * share), given.seconds / len(chosen), given.seed
        )
        codes.append(code)
        for key, value in figures.items():
            sums[key] = max(sums[key], value) if key in ("slowest", "memory") else sums[key] + value
    print(row("all", sums))
    return max(codes)


def apart(name: str, count: int, seconds: float, seed: int) -> tuple[int, dict[str, float]]:
    """Drive a reader in a process of its own, and print its row."""
    words = [sys.executable, "-m", "tests.fuzz", ALONE, "--reader", name]
    words += [f"--count={count}", f"--seconds={seconds}", f"--seed={seed}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    *said, last = done.stdout.splitlines() or [""]
    try:
        figures = {key: float(value) for key, value in json.loads(last).items()}
        print(row(name, figures), *said, sep="\n", flush=True)
    except ValueError:  # native code has ended it
        print(
            f"{name}: its process ended with {done.returncode}",
            done.stdout,
            done.stderr[-4000:],
            sep="\n",
        )
        return 1, {}
    return done.returncode, figures


def row(name: str, figures: dict[str, float]) -> str:
    """A line of the table."""
    return f"{name:16}" + "".join(
        f"{figures[key]:{width}.{digits}f}" for key, (_, width, digits) in COLUMNS.items()
    )


def alone(name: str, count: int, seconds: float, seed: int) -> int:
    """Drive a reader here, and print what broke it and last its figures."""
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
    """A file that broke a reader, and how."""
    print(f"{name}: {broken.content[:4000]!r}")
    traceback.print_exception(broken.error, file=sys.stdout)


if __name__ == "__main__":
    sys.exit(main())
