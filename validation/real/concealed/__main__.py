"""Real recordings with known alterations: `python -m validation.real.concealed [--only NAME...]`.

The plain vessel of every real recording already lacks something. So the unaltered recordings are
diagnosed first and the vessel is patched; this is repeated with the patched vessel, at most three
times. What is still identified in the unaltered recordings is not counted.

Each case then alters the recordings as its cause would have, by closed form, or removes one of the
identified effects from the patched vessel. The truth is printed together with a fit of the same
cause to the unaltered recordings: a real boat has a little of everything, to which an alteration
adds, so the size of both together is right too. A cause is visible if the true structure, with
fitted sizes, gains more than 6 nats in the filter of the diagnosis. A cause that is not visible
must not be reported.

--only takes names of sets or parts of names of cases; --list prints the cases. The two releases
take a minute or two. Short pieces of a few runs are used of the other sets, as printed; a single
diagnosis may still take ten minutes, because so much is missing from their plain vessels. Sets
whose recordings are not on this machine are skipped.
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from validation.real.common import OUT, print_table
from validation.real.concealed.alterations import unaltered
from validation.real.concealed.base import PatchedVesselStudy
from validation.real.concealed.cases import STUDIES, Case, Study
from validation.real.concealed.judging import Verdict, goal_rows, identified_names, sizes_of

HEADER = ["set", "concealed", "truth", "unaltered", "gain [nats]", "outcome", "answer"]


def table_row(study: Study, case: Case, verdict: Verdict) -> list[str]:
    """Return a row of the table."""
    gain = ""
    if verdict.gain is not None:
        gain = f"{verdict.gain:.1f}"
    truth = sizes_of(case.truth) or "nothing"
    return [study.name, case.name, truth, verdict.own, gain, verdict.outcome, verdict.answer]


def is_requested(study: Study, case: str, only: Sequence[str]) -> bool:
    """Whether a case is requested by the name of its set or by a part of its name."""
    return not only or study.name in only or any(part in case for part in only)


def any_requested(study: Study, only: Sequence[str]) -> bool:
    """Whether any case of a set is requested."""
    if not only or study.name in only or any("removed" in part for part in only):
        return True
    for case in study.cases(study.open(None, unaltered).vessel):
        if is_requested(study, case.name, only):
            return True
    return False


def main() -> None:
    """Run every set, print each case when it is judged, then all of them with the goals."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.real.concealed", description=__doc__
    )
    only = "names of sets, or parts of names of cases"
    parser.add_argument("--only", nargs="+", default=[], help=only)
    parser.add_argument("--list", action="store_true", help="print the cases and run none")
    folder = "folder of the patched vessels"
    parser.add_argument("--out", type=Path, default=OUT / "concealed", help=folder)
    options = parser.parse_args()
    rows, verdicts = list[list[str]](), list[Verdict]()
    for study in STUDIES:
        if not study.runs.exists():
            print(f"{study.name}: skipped, its recordings are not on this machine")
            continue
        if options.list:
            print_cases(study, options.only)
        elif any_requested(study, options.only):
            run(study, options.only, options.out, rows, verdicts)
    if verdicts:
        print_table("concealed causes and answers", HEADER, rows)
        print_table("goals", ["", "", "goal"], goal_rows(verdicts))


def print_cases(study: Study, only: Sequence[str]) -> None:
    """Print the cases of a set, with the sizes for its plain vessel."""
    print(f"{study.name}: {study.about}")
    for case in study.cases(study.open(None, unaltered).vessel):
        if is_requested(study, case.name, only):
            print(f"  {case.name}: {sizes_of(case.truth) or 'nothing that a recording shows'}")
    print("  each effect that is identified in the unaltered recordings, removed")


def run(
    study: Study,
    only: Sequence[str],
    out: Path,
    rows: list[list[str]],
    verdicts: list[Verdict],
) -> None:
    """Run the requested cases of a set, and append their rows and verdicts."""
    begin = time.perf_counter()
    patched = PatchedVesselStudy(study, out)
    print(f"\n{study.name}: {study.about}")
    print(f"  the vessel lacks: {sizes_of(patched.found) or 'nothing'}")
    left = ", ".join(sorted(identified_names(patched.before))) or "nothing"
    verdict = patched.before.findings.answer["verdict"]
    print(f"  still identified with the patched vessel: {left} ({verdict})", flush=True)
    for case in patched.cases():
        if is_requested(study, case.name, only):
            verdicts.append(patched.verdict(case))
            rows.append(table_row(study, case, verdicts[-1]))
            seconds = time.perf_counter() - begin
            print(f"  {' | '.join(rows[-1][1:])}  [{seconds:.0f} s]", flush=True)


if __name__ == "__main__":
    main()
