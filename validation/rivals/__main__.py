"""Answer trials with another method: `python -m validation.rivals METHOD SET --out DIR`.

METHOD is `least_squares` or `sparse_regression`, or one that uses a package of the extra `rivals`:
`pysindy_weak`, `mujoco_sysid`, `sbi_posterior`. The script writes DIR/Txxx/diagnosis.json,
patched.toml and replay.csv, as the diagnosis does; `python -m validation.trials SET --answers DIR`
scores them. `--plain` uses the textbook BIC in the first two.
"""

import argparse
import time
from importlib import import_module
from pathlib import Path
from typing import Protocol

from rich.progress import track

from boatsim.diagnosis.problem import Fit
from boatsim.errors import BadInput
from validation.rivals.question import Question, read_question, write_answer

# module and class of each method; those of packages are imported only when they are used
RIVALS = {
    "least_squares": "LeastSquares",
    "sparse_regression": "SparseRegression",
}
PACKAGED = {
    "pysindy_weak": "PySindyWeak",
    "mujoco_sysid": "MujocoSysid",
    "sbi_posterior": "SbiPosterior",
}


class Rival(Protocol):
    """A method that answers a trial."""

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, the evidence of each effect [nats], and the unknown flag."""


def make_rival(name: str, question: Question, plain: bool) -> Rival:
    """Return a method for one trial.

    Args:
        name: One of RIVALS or PACKAGED.
        question: The trial.
        plain: Whether to use the textbook BIC.

    Raises:
        BadInput: If the package of the method is not installed.
    """
    module = import_module(f"validation.rivals.{name}")
    rival: Rival = getattr(module, (RIVALS | PACKAGED)[name])(question, plain)
    return rival


def answer_trial(rival: str, trial: Path, out: Path, plain: bool = False) -> None:
    """Answer one trial.

    Args:
        rival: Name of the method.
        trial: Folder of the trial.
        out: Folder for the answer.
        plain: Whether to use the textbook BIC.

    Raises:
        BadInput: If the package of the method is not installed.
    """
    question = read_question(trial)
    write_answer(question, *make_rival(rival, question, plain).answer(), trial, out)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rival", choices=sorted(RIVALS | PACKAGED))
    parser.add_argument("trials", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument(
        "--plain", action="store_true", help="BIC as in a textbook: every value independent"
    )
    args = parser.parse_args()
    trials = sorted(t for t in args.trials.glob("T*") if t.is_dir())
    if not trials:
        raise SystemExit(f"{args.trials}: no trials found")
    begin = time.time()
    for trial in track(trials, args.rival):
        try:
            answer_trial(args.rival, trial, args.out / trial.name, args.plain)
        except BadInput as error:
            raise SystemExit(str(error)) from None
    print(f"{args.rival}: {len(trials)} trials in {time.time() - begin:.0f} s")


if __name__ == "__main__":
    main()
