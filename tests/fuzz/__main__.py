"""`python -m tests.fuzz --count N`: N mutated files in all, and what became of them, reader by reader.

A night: `python -m tests.fuzz --count 100000 --seed $(date +%s)`. A file that ends in anything but a value or one clear
line is printed as a literal, with its traceback, and the exit code is 1.
"""

import argparse
import sys
import time
import traceback

from tests.fuzz.drive import Broken, drive
from tests.fuzz.readers import READERS


def main() -> int:
    """Print a line for each reader."""
    asked = argparse.ArgumentParser(prog="python -m tests.fuzz", description="Mutated files for every reader.")
    asked.add_argument("--count", type=int, default=600, help="mutated files in all")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--reader", choices=sorted(READERS), action="append", help="only this; may be repeated")
    given = asked.parse_args()
    chosen, failed = given.reader or list(READERS), False
    shares = sum(READERS[name].share for name in chosen)
    print(f"{'reader':16}{'files':>8}{'read':>8}{'refused':>9}{'broken':>8}{'slowest [s]':>13}{'seconds':>9}")
    for name in chosen:
        begin = time.perf_counter()
        found = drive(READERS[name], round(given.count * READERS[name].share / shares), given.seed)
        seconds = time.perf_counter() - begin
        counts = f"{found.files:8}{found.read:8}{found.refused:9}{len(found.broken):8}"
        print(f"{name:16}{counts}{found.slowest:13.2f}{seconds:9.1f}", flush=True)
        for broken in found.kinds():
            failed = True
            show(name, broken)
    return int(failed)


def show(name: str, broken: Broken) -> None:
    """A file that broke a reader, and how."""
    print(f"{name}: {broken.content[:4000]!r}")
    traceback.print_exception(broken.error, file=sys.stdout)


if __name__ == "__main__":
    sys.exit(main())
