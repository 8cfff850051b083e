"""Run the rehearsal: `python -m validation.owner_logs --out DIR [--seed N] [--cases K]`.

Every case has a folder with the logs, the vessel that `boatsim new` made, the map, the answer, and
history.txt with each command and its output. The same seed gives the same logs. A run that was
interrupted continues: a case whose folder has a result is not repeated.
"""

import argparse
import json
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from validation.owner_logs.cases import Case, cases
from validation.owner_logs.judge import Judge, Result
from validation.owner_logs.table import case_line, goal_rows


def judge_case(case: Case, out: Path, log_only: bool) -> Result:
    """Judge one case in its folder, or return the result that the folder already has."""
    folder = out / f"case_{case.number:02d}"
    if (result := folder / "result.json").exists():
        return read_result(result)
    return Judge(case, folder, log_only).judge()


def read_result(file: Path) -> Result:
    """Read the result of a case."""
    return Result(**json.loads(file.read_text(encoding="utf-8")))


def print_results(results: list[Result]) -> None:
    """Print a line for each case, then the goals."""
    print("\n".join([*map(case_line, results), "", *goal_rows(results)]))


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", type=int, default=12)
    parser.add_argument(
        "--only", type=int, nargs="*", help="numbers of cases, of those of the seed"
    )
    parser.add_argument(
        "--log-only", action="store_true", help="import and check alone, no diagnosis"
    )
    parser.add_argument("--show", action="store_true", help="only print the table of the folder")
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    if given.show:
        print_results([read_result(file) for file in sorted(given.out.glob("case_*/result.json"))])
        return
    begin = time.time()
    all_of_them = cases(given.seed, given.cases)
    asked = [c for c in all_of_them if not given.only or c.number in given.only]
    results = []
    with ProcessPoolExecutor(given.jobs) as pool:
        for result in pool.map(
            judge_case, asked, [given.out] * len(asked), [given.log_only] * len(asked)
        ):
            results.append(result)
            print(case_line(result), flush=True)
    print()
    print("\n".join(goal_rows(results)))
    print(f"seed {given.seed}, {len(results)} cases, {(time.time() - begin) / 60.0:.0f} min")


if __name__ == "__main__":
    main()
