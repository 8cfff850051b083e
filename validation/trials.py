"""Diagnose a folder of trials and score the answers: `python -m validation.trials [TRIALS]`.

Options: `--out RESULTS`, `--unknowns`, `--jobs N`. `--make DIR --seed N` only writes such a folder
(the second practice set). `--answers RESULTS` scores the answers of any tool,
`RESULTS/Txxx/diagnosis.json` and `replay.csv`, without a diagnosis: see docs/benchmark.md.

TRIALS/Txxx/ holds run_1.csv, run_2.csv (to diagnose from), run_3.csv (held out) and answer.json.
The script writes RESULTS/Txxx/diagnosis.json, patched.toml and replay.csv (free runs over run_3: 6
s for a boat of 1.2 m, Froude-scaled for others). It then prints how the answers compare with the
truth, by vessel if there are several (named in recording.toml; `python -m validation.practice`
makes such a set):

- a trial is exact if every true effect is named and no other; an effect counts if it is visible
  (adds more than 6 nats in the program that made the trials);
- a name is wrong unless it is true, or the answer states that it cannot be distinguished from a
  true one;
- a cause outside the library of the program that made the trials, which has been added since,
  counts as flagged and described if it is named;
- held-out skill is 1 if the patched boat follows run_3 as closely as the fitted true structure, 0
  if it is no better than the recalibrated nominal;
- coverage is the share of true parameters within two reported standard deviations, over exact
  answers;
- reliability: the share of true effects among all effects reported with a probability in some
  range, in trials with one effect or none.

--unknowns adds a table of diagnoses without the true effect, its equivalents and its look-alikes in
the library.
"""

import argparse
import contextlib
import io
import itertools
import json
import math
import os
import re
import statistics
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from rich.progress import Progress

from validation.entry import BadEntry, horizon_of, read_answers, replay_errors, vessel_of

SHARED = Path(__file__).parents[2] / "shared" / "recordings" / "trials" / "practice"
BINS = (0.0, 0.02, 0.1, 0.3, 0.7, 0.95, 1.0)
Answers = dict[str, dict[str, Any]]  # by trial
KINDS = {  # cause outside the library -> axis and factors of a described law of its kind
    "sag": "^thrust",
    "seized_motor": "^thrust",
    "eddies": "(north|east).*repeats every",
    "stiction": "^roll.* roll rate",
    "lifting_hull": "^(sway|yaw).* surge speed",
    "bilge_pump": "^(sway|yaw|roll).*(swinging|, from)",
    "shifting_cargo": "^roll.*(swinging|, from)",
}
# causes outside the library of the program that made the trials -> the effect that has been added
# to the library since; a tool that names it has found the cause
ADDED_SINCE = {"sag": "thrust_fade"}
SLACK = 1.05  # largest error ratio to the recalibrated vessel on run_3
# the true structure must remove this share of the recalibrated error for a skill to be defined
WORTH = 0.15


def diagnose_one(trial: Path, out: Path, without: Sequence[str] = ()) -> dict[str, Any]:
    """Diagnose one trial, replay run_3 with the patched vessel, and return the answer."""
    from boatsim.cli import diagnosis as commands
    from boatsim.diagnosis import pipeline
    from boatsim.diagnosis.output import patched_vessel

    found = pipeline.diagnose(
        [trial / "run_1.csv", trial / "run_2.csv"],
        [trial / "run_3.csv"],
        vessel_of(trial),
        without=without,
    )
    out.mkdir(parents=True, exist_ok=True)
    patched_vessel.write_patched_vessel(
        found.problem,
        found.vessel,
        found.ranking.best,
        out / "patched.toml",
        found.ranking.described_terms,
    )
    with contextlib.redirect_stdout(io.StringIO()):
        commands.replay(trial / "run_3.csv", str(out / "patched.toml"), [], horizon_of(trial), out)
    (out / "diagnosis.json").write_text(json.dumps(found.findings.answer, indent=1))
    return dict(found.findings.answer)


def diagnose_all(
    jobs: int, todo: dict[str, tuple[Path, Path, tuple[str, ...]]], what: str
) -> Answers:
    """Return the answers of many diagnoses by name."""
    with ProcessPoolExecutor(jobs) as pool, Progress() as progress:
        task = progress.add_task(what, total=len(todo))
        waiting = {pool.submit(diagnose_one, *args): name for name, args in todo.items()}
        done = {}
        for future in as_completed(waiting):
            done[waiting[future]] = future.result()
            progress.advance(task)
    return dict(sorted(done.items()))


# ---- one trial


def outside_cause(answer: dict[str, Any]) -> str:
    """Return the cause of a trial that is outside the library of its program, or ""."""
    if answer["kind"] != "unknown" or not answer.get("effects"):
        return ""
    return str(answer["effects"][0]["name"]).partition(":")[2]


def true_names(answer: dict[str, Any]) -> set[str]:
    """Return the names of a correct answer."""
    if answer["kind"] == "unknown":
        return {"unknown"}
    return {e["name"] for e in answer["effects"]}


def reported_names(answer: dict[str, Any], found: dict[str, Any]) -> set[str]:
    """Return the reported names, equivalents replaced by the names in the answer."""
    truth = true_names(answer)
    same = {}
    for name, others in answer.get("equivalent", {}).items():
        same.update(dict.fromkeys(others, name))
    same[ADDED_SINCE.get(outside_cause(answer), "")] = "unknown"
    names = set()
    for effect in found["effects"]:
        name = effect["name"]
        if name in answer.get("tolerated", []):
            continue
        if name in truth:
            names.add(name)
        else:
            names.add(same.get(name, name))
    if found["unknown"]["flag"]:
        names.add("unknown")
    return names


def resolve_ties(answer: dict[str, Any], found: dict[str, Any]) -> set[str]:
    """Return the reported names, each ambiguous one replaced by a true one it is tied with."""
    truth = true_names(answer)
    tied = {}
    for e in found["effects"]:
        if found["verdict"] == "ambiguous":
            tied[e["name"]] = truth & set(e["tied_with"])
    names = set()
    for name in reported_names(answer, found):
        if name in truth:
            names.add(name)
        else:
            names.add(min(tied.get(name, ()), default=name))
    return names


def deviations(answer: dict[str, Any], found: dict[str, Any]) -> list[float]:
    """Return the errors of the comparable parameters in reported standard deviations."""
    out = []
    stated = {e["name"]: e["parameters"] for e in found["effects"]}
    for effect in answer["effects"]:
        for key, true in (effect.get("parameters") or {}).items():
            fitted = stated.get(effect["name"], {}).get(key)
            if fitted is None or isinstance(true, bool) or key in effect.get("not_compared", []):
                continue
            error = fitted["value"] - true
            if key == "toward_rad":
                error = math.remainder(error, 2 * math.pi)
            out.append(abs(error) / fitted["sd"])
    return out


def held_out_skill(trial: Path, out: Path, answer: dict[str, Any]) -> float | None:
    """Return the held-out skill on run_3; None if the true structure saves no error.

    The skill is the error saved by the patched boat per error saved by the true structure. It is -1
    if free runs are missing or do not cover run_3.
    """
    reference = answer.get("reference_position_rms_m", {})
    recalibrated, true = reference.get("recalibrated"), reference.get("true_structure")
    if (
        recalibrated is None
        or true is None
        or recalibrated - true <= max(1e-3, WORTH * recalibrated)
    ):
        return None
    patched = replay_errors(trial, out / "replay.csv", horizon_of(trial))
    if patched is None:
        return -1.0
    saved: float = (recalibrated - patched) / (recalibrated - true)
    return max(-1.0, min(1.0, saved))


def names_unknown_cause(answer: dict[str, Any], found: dict[str, Any]) -> bool:
    """Return whether the unknown cause is named, because the library has it by now."""
    law = ADDED_SINCE.get(outside_cause(answer))
    return any(effect["name"] == law for effect in found["effects"])


def describes_unknown_cause(answer: dict[str, Any], found: dict[str, Any]) -> bool:
    """Return whether the unknown cause is named, or a described law has a term of its kind."""
    if names_unknown_cause(answer, found):
        return True
    kind = KINDS[outside_cause(answer)]
    return any(
        re.search(kind, f"{law['axis']} {term['of']}")
        for law in found["described"]
        for term in law["terms"]
    )


def error_ratio_to_recalibrated(found: dict[str, Any]) -> float | None:
    """Return the error of the patched boat on run_3 per error of the recalibrated one.

    The value is the geometric mean over all signals, or None if no errors are reported.
    """
    rms = [v for k, v in found["fit"].items() if k.endswith(("_rms_m", "_rms_rad")) and v]
    ratios = [v["patched"] / v["recalibrated"] for v in rms if v["recalibrated"] > 0.0]
    if ratios:
        return statistics.geometric_mean(ratios)
    return None


# ---- all trials


def share_text(rows: Sequence[bool]) -> str:
    """Return the share of true rows as text, such as 5/6."""
    if rows:
        return f"{sum(rows)}/{len(rows)}"
    return "none"


def quantile(values: Sequence[float], q: float) -> float:
    """Return the value below which a share q of the values lies."""
    return sorted(values)[int(q * (len(values) - 1))]


def name_counts(answers: Answers, found: Answers) -> dict[str, str]:
    """Return the counts of right and wrong names by kind of trial."""
    false_alarms: list[bool] = []
    single: list[bool] = []
    concealed_single: list[bool] = []
    single_or_tied: list[bool] = []
    pair: list[bool] = []
    wrong: list[bool] = []
    unknown: dict[bool, list[bool]] = {False: [], True: []}  # by whether it is concealed
    described: list[bool] = []
    described_by_kind: list[bool] = []
    called_unknown: list[bool] = []
    for n, answer in found.items():
        truth = answers[n]
        names = true_names(truth)
        reported = reported_names(truth, answer)
        meant = resolve_ties(truth, answer)
        kind = truth["kind"]
        visible = truth.get("visible") and not truth.get("borderline")
        if kind == "none":
            false_alarms.append(bool(reported))
        if kind in ("single", "pair"):
            called_unknown.append("unknown" in reported)
        if kind != "unknown":
            wrong.append(bool(meant - names - {"unknown"}))
        if visible and kind == "single":
            single.append(reported == names)
            single_or_tied.append(meant == names and len(reported) == len(meant))
            if truth["concealed"]:
                concealed_single.append(reported == names)
        if visible and kind == "pair":
            pair.append(reported == names)
        if visible and kind == "unknown":
            unknown[truth["concealed"]].append("unknown" in reported)
            described.append(bool(answer["described"]) or names_unknown_cause(truth, answer))
            described_by_kind.append(describes_unknown_cause(truth, answer))
    return {
        "false alarms among nothing-missing trials": share_text(false_alarms),
        "visible single effects, exactly named": share_text(single),
        "  of these concealed by the tracker": share_text(concealed_single),
        "  exactly named, or reported as tied": share_text(single_or_tied),
        "visible pairs, both named and nothing else": share_text(pair),
        "wrong names (none, singles, pairs)": share_text(wrong),
        "visible unknown cause flagged, pilot": share_text(unknown[False]),
        "visible unknown cause flagged, concealed": share_text(unknown[True]),
        "visible unknown cause described": share_text(described),
        "  with a term of its kind": share_text(described_by_kind),
        "known cause called unknown": share_text(called_unknown),
    }


def fit_figures(trials: Path, out: Path, answers: Answers, found: Answers) -> dict[str, str]:
    """Return held-out skill, parameter errors and computing time."""
    skills = []
    for n in found:
        if answers[n]["kind"] in ("single", "pair"):
            value = held_out_skill(trials / n, out / n, answers[n])
            if value is not None:
                skills.append(value)
    z = []
    for n, answer in found.items():
        if reported_names(answers[n], answer) == true_names(answers[n]):
            z.extend(deviations(answers[n], answer))
    table = {}
    seconds = [f["seconds"] for f in found.values() if "seconds" in f]
    if seconds:
        words = f"{statistics.median(seconds):.2f} / {quantile(seconds, 0.95):.2f}"
        table["seconds per diagnosis, median / p95"] = words
    if skills and any((out / n / "replay.csv").is_file() for n in found):
        tenth = (
            f"{statistics.median(skills):.3f} / {sorted(skills)[len(skills) // 10]:.3f} "
            f"({len(skills)} trials)"
        )
        table["held-out skill, median / lowest tenth"] = tenth
    ratios = []
    for answer in found.values():
        if any(law["carries_over"] for law in answer["described"]):
            ratio = error_ratio_to_recalibrated(answer)
            if ratio is not None:
                ratios.append(ratio)
    if ratios:
        words = f"{statistics.median(ratios):.2f} / {max(ratios):.2f} ({len(ratios)} trials)"
        table["described: error ratio, median / worst"] = words
        table[f"  above {SLACK:g} of the recalibrated"] = share_text([r > SLACK for r in ratios])
    if z:
        table["true parameters within 2 sd"] = f"{sum(x <= 2 for x in z) / len(z):.3f} of {len(z)}"
        table["median error of a parameter in sd"] = f"{statistics.median(z):.2f}"
    return table


def reliability(answers: Answers, found: Answers) -> list[tuple[str, int, float, float]]:
    """Return the calibration table of the reported probabilities.

    Returns:
        Rows of (range, effects, mean reported probability, share true), over trials with one
        effect or none.
    """
    pairs: list[tuple[float, bool]] = []
    for n, f in found.items():
        if answers[n]["kind"] not in ("none", "single") or answers[n].get("tolerated"):
            continue
        truth = true_names(answers[n])
        same = set(truth)
        for name in truth:
            same.update(answers[n].get("equivalent", {}).get(name, []))
        stated = {c["name"]: c["probability"] for c in f["candidates"]}
        together = sum(stated.pop(name, 0.0) for name in same)
        pairs.extend(zip(stated.values(), itertools.repeat(False), strict=False))
        if truth:
            pairs.append((together, True))
        pairs.append((max(0.0, 1.0 - sum(stated.values()) - together), not truth))
    table = []
    for low, high in zip(BINS[:-1], BINS[1:], strict=True):
        inside = [(p, true) for p, true in pairs if low <= p < high or p == high == 1.0]
        if inside:
            probabilities, true = zip(*inside, strict=True)
            table.append(
                (
                    f"{low:.2f} to {high:.2f}",
                    len(inside),
                    statistics.mean(probabilities),
                    statistics.mean(map(float, true)),
                )
            )
    return table


def diagnose_without_true_effect(
    trials: Path, out: Path, jobs: int, answers: Answers, found: Answers
) -> None:
    """Diagnose every visible single effect again without it and its look-alikes."""
    left_out = {}
    for n, answer in answers.items():
        if n in found and answer["kind"] == "single" and answer.get("visible"):
            (name,) = true_names(answer)
            alike = [t for e in found[n]["effects"] if e["name"] == name for t in e["tied_with"]]
            left_out[n] = tuple(
                dict.fromkeys((name, *answer.get("equivalent", {}).get(name, []), *alike))
            )
    todo = {n: (trials / n, out / "unknowns" / n, names) for n, names in left_out.items()}
    again = diagnose_all(jobs, todo, "without the truth")
    flagged = {n: f["unknown"]["flag"] for n, f in again.items()}
    print("\nunknowns: the true effect and its look-alikes removed from the library")
    for what, concealed in (("pilot", False), ("concealed", True)):
        print(
            f"  flagged, {what:10s} "
            f"{share_text([flagged[n] for n in again if answers[n]['concealed'] is concealed])}"
        )
    print(
        "  flagged, or nothing named  "
        f"{share_text([flagged[n] or not f['effects'] for n, f in again.items()])}"
    )
    skills = {n: held_out_skill(trials / n, out / "unknowns" / n, answers[n]) for n in again}
    skilled = [s for s in skills.values() if s is not None]
    if skilled:
        print(
            f"  skill, truth removed       {statistics.median(skilled):.3f} ({len(skilled)} trials)"
        )
    by_law = [s for n, s in skills.items() if s is not None and again[n]["described"]]
    if by_law:
        print(
            f"  of these by a description  {statistics.median(by_law):.3f} ({len(by_law)} trials)"
        )
    for n, f in again.items():
        instead = [f"{e['name']} ({e['gain_nats']:.0f} nats)" for e in f["effects"]]
        law = "described" if f["described"] else "unknown"
        reported = ", ".join([*([law] if flagged[n] else []), *instead]) or "nothing missing"
        print(f"    {n} without {', '.join(left_out[n])}: {reported}")


def print_figures(trials: Path, out: Path, answers: Answers, found: Answers) -> None:
    """Print the figures of all trials, then of each vessel if there are several."""
    vessels = {n: vessel_of(trials / n) for n in found}
    several = sorted(set(vessels.values())) if len(set(vessels.values())) > 1 else []
    for vessel in ("", *several):
        part = {n: f for n, f in found.items() if vessel in ("", vessels[n])}
        print(f"\n{vessel}, {len(part)} trials" if vessel else "")
        for what, value in {
            **name_counts(answers, part),
            **fit_figures(trials, out, answers, part),
        }.items():
            print(f"{what:44s} {value}")
    print()


def print_wrong(answers: Answers, found: Answers) -> None:
    """Print the trials whose answer is not exact."""
    for n, f in found.items():
        reported, truth = reported_names(answers[n], f), true_names(answers[n])
        if reported != truth:
            seen = "" if answers[n].get("visible", True) else " (invisible)"
            print(
                f"  {n} {answers[n]['kind']}: truth {sorted(truth)}, "
                f"reported {sorted(reported)}{seen}"
            )


def score(trials: Path, results: Path, answers: Answers) -> None:
    """Print how the answers of any tool compare with the truth.

    Raises:
        BadEntry: if an answer is missing or invalid.
    """
    found = read_answers(results, list(answers))
    print(f"{len(found)} trials; answers in {results}")
    print_figures(trials, results, answers, found)
    print_wrong(answers, found)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("trials", type=Path, nargs="?", default=SHARED)
    parser.add_argument("--out", type=Path, default=Path("out/trials"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--unknowns", action="store_true", help="also the table of unknowns")
    parser.add_argument(
        "--answers", type=Path, metavar="RESULTS", help="score these answers, without a diagnosis"
    )
    parser.add_argument(
        "--make", type=Path, metavar="DIR", help="only write the second practice set to this folder"
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the new set")
    args = parser.parse_args()
    if args.make:
        from validation.practice.__main__ import make_set

        make_set(args.make, args.seed)
        return
    answers = {}
    for t in sorted(args.trials.glob("T*")):
        answers[t.name] = json.loads((t / "answer.json").read_text())
    if not answers:
        raise SystemExit(f"{args.trials}: no trials found")
    if args.answers:
        try:
            score(args.trials, args.answers, answers)
        except BadEntry as error:
            raise SystemExit(str(error)) from None
        return
    begin = time.time()
    found = diagnose_all(
        args.jobs, {n: (args.trials / n, args.out / n, ()) for n in answers}, "diagnosing"
    )
    print(
        f"{len(found)} trials in {time.time() - begin:.0f} s on {args.jobs} processes; "
        f"answers in {args.out}"
    )
    print_figures(args.trials, args.out, answers, found)
    print_wrong(answers, found)
    print("\nreliability: effects by reported probability, in trials with one effect or none")
    for span, count, mean, true in reliability(answers, found):
        print(f"  {span}   {count:5d} effects, mean {mean:.3f}, true {true:.3f}")
    if args.unknowns:
        diagnose_without_true_effect(args.trials, args.out, args.jobs, answers, found)


if __name__ == "__main__":
    main()
