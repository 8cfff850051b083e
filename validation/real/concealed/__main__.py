"""Real recordings altered so that the right answer is known: `python -m validation.real.concealed [--only NAME...]`.

Something is missing from the plain vessel of every real recording already. So the unaltered recordings are diagnosed
first, the vessel patched, and that again with what is still named, at most three times; what is named of the unaltered
recordings even then counts for nothing. Then each case alters the recordings as its cause would have, by closed form,
or takes one of the effects found out of the patched vessel again. Beside the truth stands what a fit makes of the same
cause in the unaltered recordings: a real boat has a little of everything, to which an alteration adds, so that the size
of both together is right too. A cause can be told from a recording (is visible) if the true structure, its sizes
fitted, gains more than 6 nats in the tool's own filter; what can not be told must be left alone.

--only takes names of sets or parts of names of cases, --list prints the cases alone. The two releases take a minute or
two. Of the others short pieces of a few runs are used, as printed, and still a single diagnosis may take ten minutes,
for so much is missing from their plain vessels. Sets whose recordings are not there are skipped.
"""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from validation.real.common import OUT, table
from validation.real.concealed.alterations import unaltered
from validation.real.concealed.base import Patched
from validation.real.concealed.cases import STUDIES, Case, Study
from validation.real.concealed.judging import Verdict, names_of, shares, sizes_of


def row(study: Study, case: Case, verdict: Verdict) -> list[str]:
    """A line of the table."""
    gain = "" if verdict.gain is None else f"{verdict.gain:.1f}"
    return [
        study.name,
        case.name,
        sizes_of(case.truth) or "nothing",
        verdict.own,
        gain,
        verdict.outcome,
        verdict.said,
    ]


HEADER = ["set", "concealed", "truth", "unaltered", "gain [nats]", "judged", "said"]


def wanted(study: Study, case: Case, only: Sequence[str]) -> bool:
    """Whether a case is asked for."""
    return not only or any(o == study.name or o in case.name for o in only)


def main() -> None:
    """Every set in turn, each case printed as it is judged, then all of them against the goals."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.real.concealed", description=__doc__
    )
    parser.add_argument(
        "--only", nargs="+", default=[], help="names of sets, or parts of names of cases"
    )
    parser.add_argument("--list", action="store_true", help="print the cases and run none")
    parser.add_argument(
        "--out", type=Path, default=OUT / "concealed", help="where patched vessels go"
    )
    asked = parser.parse_args()
    rows, verdicts = list[list[str]](), list[Verdict]()
    for study in STUDIES:
        if not study.there():
            print(f"{study.name}: skipped, its recordings are not there")
            continue
        if asked.list:
            listed(study, asked.only)
            continue
        if asked.only and study.name not in asked.only and not _any_case(study, asked.only):
            continue
        some = run(study, asked.only, asked.out)
        rows += [r for r, _ in some]
        verdicts += [v for _, v in some]
    if verdicts:
        table("what was concealed, and what was said of it", HEADER, rows)
        table("against the goals", ["", "", "goal"], [list(s) for s in shares(verdicts)])


def _any_case(study: Study, only: Sequence[str]) -> bool:
    vessel = study.open(None, unaltered).vessel
    return any(wanted(study, c, only) for c in study.cases(vessel)) or any(
        "taken out again" in o for o in only
    )


def listed(study: Study, only: Sequence[str]) -> None:
    """The cases of a set; sizes that depend on the patched vessel are those of the plain one."""
    print(f"{study.name}: {study.about}")
    for case in study.cases(study.open(None, unaltered).vessel):
        if wanted(study, case, only):
            print(
                f"  {case.name}: {sizes_of(case.truth) or 'nothing, which no recording can tell'}"
            )
    print("  each effect that is found in the unaltered recordings, taken out again")


def run(study: Study, only: Sequence[str], out: Path) -> list[tuple[list[str], Verdict]]:
    """All cases of a set."""
    begin = time.perf_counter()
    patched = Patched(study, out)
    print(f"\n{study.name}: {study.about}")
    print(f"  the vessel lacks: {sizes_of(patched.found) or 'nothing'}")
    left = ", ".join(sorted(names_of(patched.before))) or "nothing"
    print(
        f"  with that, still named: {left} ({patched.before.findings.answer['verdict']})",
        flush=True,
    )
    found = []
    for case in patched.cases():
        if wanted(study, case, only):
            verdict = patched.verdict(case)
            cells = row(study, case, verdict)
            print(f"  {' | '.join(cells[1:])}  [{time.perf_counter() - begin:.0f} s]", flush=True)
            found.append((cells, verdict))
    return found


if __name__ == "__main__":
    main()
