"""Diagnoses a folder of trials in parallel: `python -m benchmarks.trials TRIALS [--out RESULTS] [--all]`.

TRIALS/Txxx/ holds run_1.csv, run_2.csv (to diagnose from), run_3.csv (held out) and answer.json. Writes
RESULTS/Txxx/diagnosis.json and replay.csv of run_3 with the patched vessel, then prints how the answers compare with
the truth and the seconds per diagnosis. Without --all only trials whose truth is in the vessel's library count.
"""

import argparse
import contextlib
import io
import json
import os
import statistics
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from rich.progress import Progress

SHARED = Path(__file__).parents[2] / "shared" / "recordings" / "trials" / "practice"


def diagnose_one(trial: Path, out: Path) -> None:
    """Diagnose one trial and replay its held-out run with the patched vessel."""
    from boatsim.diagnose import analysis, commands, patch

    vessel = "trial_boat"
    found = analysis.diagnose([trial / "run_1.csv", trial / "run_2.csv"], [trial / "run_3.csv"], vessel)
    out.mkdir(parents=True, exist_ok=True)
    kinds = {e.name(): type(e) for e in found.problem.program.suspects}
    patch.write(found.vessel, found.ranking.best, kinds, out / "patched.toml")
    with contextlib.redirect_stdout(io.StringIO()):
        commands.replay(trial / "run_3.csv", str(out / "patched.toml"), [], 6.0, out)
    (out / "diagnosis.json").write_text(json.dumps(found.findings.answer, indent=1))


def in_library(answer: dict[str, Any]) -> bool:
    """Whether the tool has a name for every concealed effect."""
    from boatsim import vessel

    known = set(vessel.load("trial_boat").diagnosis.suspects)
    return all(e["name"] in known for e in answer["effects"])


def compare(answer: dict[str, Any], found: dict[str, Any]) -> dict[str, Any]:
    """One trial's row: what was there, what was said."""
    truth = {e["name"] for e in answer["effects"]}
    said = {e["name"] for e in found["effects"]} - set(answer.get("tolerated", []))
    same = {other: name for name, others in answer.get("equivalent", {}).items() for other in others}
    said = {n if n in truth else same.get(n, n) for n in said}
    return {
        "kind": answer["kind"],
        "visible": answer.get("visible", True) and not answer.get("borderline", False),
        "concealed": answer["concealed"],
        "truth": truth,
        "said": said,
        "named": bool(said),
        "exact": said == truth,
        "wrong": bool(said - truth),
        "seconds": found["seconds"],
    }


def share(rows: list[dict[str, Any]], key: str) -> str:
    """5/6 of the rows have the property."""
    return f"{sum(bool(r[key]) for r in rows)}/{len(rows)}"


def print_figures(rows: dict[str, dict[str, Any]]) -> None:
    """Figures and every trial that is not exactly right."""
    by = {k: [r for r in rows.values() if r["kind"] == k] for k in ("none", "single", "pair")}
    singles, pairs = ([r for r in by[k] if r["visible"]] for k in ("single", "pair"))
    seconds = sorted(r["seconds"] for r in rows.values())
    figures = {
        "false alarms among nothing-missing trials": share(by["none"], "named"),
        "visible single effects, exactly named": share(singles, "exact"),
        "  of these concealed by the tracker": share([r for r in singles if r["concealed"]], "exact"),
        "visible pairs, both named and nothing else": share(pairs, "exact"),
        "wrong names (none, singles, pairs)": share([r for k in by for r in by[k]], "wrong"),
        "seconds per diagnosis, median": f"{statistics.median(seconds):.2f}",
        "seconds per diagnosis, p95": f"{seconds[int(0.95 * (len(seconds) - 1))]:.2f}",
    }
    for what, value in figures.items():
        print(f"{what:44s} {value}")
    for name, r in sorted(rows.items()):
        if not r["exact"]:
            seen_words = "" if r["visible"] else " (invisible: adds less than 6 nats)"
            print(f"  {name} {r['kind']}: truth {sorted(r['truth'])}, said {sorted(r['said'])}{seen_words}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trials", type=Path, nargs="?", default=SHARED)
    parser.add_argument("--out", type=Path, default=Path("out/trials"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--all", action="store_true", help="also trials whose truth is not in the library")
    args = parser.parse_args()
    answers = {t.name: json.loads((t / "answer.json").read_text()) for t in sorted(args.trials.glob("T*"))}
    chosen = [n for n, a in answers.items() if args.all or in_library(a)]
    if not chosen:
        raise SystemExit(f"{args.trials}: no trials there")
    begin = time.time()
    with ProcessPoolExecutor(args.jobs) as pool, Progress() as progress:
        task = progress.add_task("diagnosing", total=len(chosen))
        waiting = [pool.submit(diagnose_one, args.trials / n, args.out / n) for n in chosen]
        for done in as_completed(waiting):
            done.result()
            progress.advance(task)
    took = time.time() - begin
    print(f"{len(chosen)} trials of {len(answers)} in {took:.0f} s on {args.jobs} processes; answers in {args.out}")
    found = {n: json.loads((args.out / n / "diagnosis.json").read_text()) for n in chosen}
    print_figures({n: compare(answers[n], found[n]) for n in chosen})


if __name__ == "__main__":
    main()
