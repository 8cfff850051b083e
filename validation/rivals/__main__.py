"""Answer trials with a textbook method: `python -m validation.rivals METHOD SET --out DIR`.

METHOD is `least_squares` or `sparse_regression`. The script writes DIR/Txxx/diagnosis.json,
patched.toml and replay.csv, as the diagnosis does; `python -m validation.trials SET --answers DIR`
scores them. `--plain` uses the textbook BIC.
"""

import argparse
from pathlib import Path

from rich.progress import track

from validation.rivals.least_squares import LeastSquares
from validation.rivals.question import read_question, write_answer
from validation.rivals.sparse_regression import SparseRegression

RIVALS = {"least_squares": LeastSquares, "sparse_regression": SparseRegression}


def answer_trial(rival: str, trial: Path, out: Path, plain: bool = False) -> None:
    """Answer one trial."""
    question = read_question(trial)
    write_answer(question, *RIVALS[rival](question, plain).answer(), trial, out)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rival", choices=sorted(RIVALS))
    parser.add_argument("trials", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument(
        "--plain", action="store_true", help="BIC as in a textbook: every value independent"
    )
    args = parser.parse_args()
    trials = sorted(t for t in args.trials.glob("T*") if t.is_dir())
    if not trials:
        raise SystemExit(f"{args.trials}: no trials found")
    for trial in track(trials, args.rival):
        answer_trial(args.rival, trial, args.out / trial.name, args.plain)


if __name__ == "__main__":
    main()
