"""Write the second practice set: `python -m validation.practice --out DIR [--seed N]`.

The same seed gives the same files; `python -m validation.trials --make DIR --seed N` makes them
too, and `python -m validation.trials DIR --out RESULTS` diagnoses and scores them.
"""

import argparse
import time
from pathlib import Path

from validation.practice.make import make_trial, trials
from validation.practice.plans import PLANS

PER_VESSEL = 12  # trials


def make_set(out: Path, seed: int, per_vessel: int = PER_VESSEL, vessel: str | None = None) -> None:
    """Make all trials, or those of one vessel, and print a line for each."""
    begin = time.time()
    for trial in trials(seed, per_vessel):
        if vessel not in (None, trial.vessel):
            continue
        answer = make_trial(trial, seed, out)
        what = " + ".join(e["name"] for e in answer["effects"]) or "nothing"
        seen = "" if not answer["effects"] else "visible" if answer["visible"] else "invisible"
        how = "kept" if answer["concealed"] else "hand"
        close = " (borderline)" if answer.get("borderline") else ""
        print(
            f"{trial.name:24s} {answer['kind']:8s} {how} {what:42s} {seen}{close} "
            f"{answer.get('marginal_gain_nats', '')}"
        )
    print(f"written to {out} in {time.time() - begin:.0f} s")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--per-vessel", type=int, default=PER_VESSEL)
    parser.add_argument(
        "--vessel",
        choices=sorted(PLANS),
        help="only this vessel; its trials are those of the whole set",
    )
    args = parser.parse_args()
    make_set(args.out, args.seed, args.per_vessel, args.vessel)


if __name__ == "__main__":
    main()
