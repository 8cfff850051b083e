"""Tables of a campaign: reliability of stated probabilities, false names, unknown causes."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import fmean
from typing import Any

BINS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0)
SURE = 0.99  # probability from which a statement is called sure
MANY = 4  # selected effects of a log that together describe an unknown cause
WEAK = 0.7  # probability below which a name is improbable
QUANTILE = 1.96  # two-sided 95 % of a normal distribution

Record = dict[str, Any]


@dataclass(frozen=True)
class Statement:
    """One name with its stated probability, and whether it was right."""

    probability: float
    right: bool


@dataclass(frozen=True)
class Bin:
    """Statements within a range of probabilities."""

    low: float
    high: float
    count: int
    stated: float  # mean stated probability
    right: float  # share that was right


def right_names(record: Record) -> set[str]:
    """Return the names that are right for a trial: its causes, or their equivalents."""
    if record["kind"] in ("unknown", "removed"):
        return set()
    names = set(record["causes"])
    for cause in record["causes"]:
        names.update(record["equivalent"].get(cause, []))
    return names


def statements(records: Iterable[Record]) -> list[Statement]:
    """Return all names with a stated probability, those called possible included."""
    found = []
    for record in records:
        right = right_names(record)
        for effect in (*record["effects"], *record.get("also_possible", [])):
            found.append(Statement(effect["probability"], effect["name"] in right))
    return found


def reliability(stated: Sequence[Statement]) -> list[Bin]:
    """Return the reliability table of statements."""
    table = []
    for low, high in zip(BINS[:-1], BINS[1:], strict=True):
        inside = []
        for one in stated:
            if low <= one.probability < high or one.probability == high == 1.0:
                inside.append(one)
        if inside:
            mean = fmean(one.probability for one in inside)
            right = fmean(float(one.right) for one in inside)
            table.append(Bin(low, high, len(inside), mean, right))
    return table


def calibration_error(table: Sequence[Bin]) -> float:
    """Return the expected calibration error of a reliability table."""
    total = sum(row.count for row in table)
    if not total:
        return float("nan")
    return sum(row.count * abs(row.stated - row.right) for row in table) / total


def figures(records: Sequence[Record]) -> dict[str, str]:
    """Return the counts that the goals of a campaign refer to, as text."""
    stated = statements(records)
    none = of_kind(records, "none")
    unknown = [r for r in of_kind(records, "unknown") if clearly_visible(r)]
    removed = of_kind(records, "removed")
    kept = statements(r for r in records if r["kind"] != "removed")
    known = of_kind(records, "single", "pair", "several")
    single = [r for r in of_kind(records, "single") if clearly_visible(r)]
    pair = [r for r in of_kind(records, "pair") if clearly_visible(r)]
    several = [r for r in of_kind(records, "several") if clearly_visible(r)]
    mixed = [r for r in of_kind(records, "mixed") if clearly_visible(r)]
    piloted = [r for r in unknown if not r["concealed"]]
    concealed = [r for r in unknown if r["concealed"]]
    return {
        "expected calibration error": f"{calibration_error(reliability(stated)):.3f}",
        "the same where no true effect was removed": (
            f"{calibration_error(reliability(kept)):.3f}"
        ),
        f"names stated at {SURE:g} or more, right": share(_sure(stated)),
        "the same where no true effect was removed, right": share(_sure(kept)),
        "logs without a cause, with a name": count(none, named),
        "logs without a cause, called unknown": count(none, flagged),
        "visible unknown causes flagged, pilot": count(piloted, flagged),
        "visible unknown causes flagged, concealed": count(concealed, flagged),
        "visible unknown causes given a name": count(unknown, named),
        "effect removed from the candidates, flagged": count(removed, flagged),
        "effect removed from the candidates, given a name": count(removed, named),
        "known causes called unknown": count(known, flagged),
        "visible single causes, exactly named": count(single, exact),
        "visible pairs, exactly named": count(pair, exact),
        "three visible causes, exactly named": count(several, exact),
        "known causes, a wrong name": count(known, wrong),
        "known cause beside an unknown one, named": count(mixed, names_a_cause),
        "known cause beside an unknown one, flagged": count(mixed, flagged),
        "known cause beside an unknown one, a wrong name": count(mixed, wrong),
        "names below 0.7 beside an unknown cause, right": share(_weak(records, unknown=True)),
        "names below 0.7 otherwise, right": share(_weak(records, unknown=False)),
        "of four or more selected effects, right": share(_selected(records, MANY)),
        "logs whose recalibrated model is worse than the file": count(records, harmed),
    }


def _sure(stated: Sequence[Statement]) -> list[bool]:
    """Whether each name that is stated as sure is right."""
    return [one.right for one in stated if one.probability >= SURE]


def _weak(records: Sequence[Record], unknown: bool) -> list[bool]:
    """Whether each improbable name, beside an unknown cause or otherwise, is right."""
    found = []
    for record in records:
        for effect in record["effects"]:
            if flagged(record) == unknown and effect["probability"] < WEAK:
                found.append(not wrong({**record, "effects": [effect]}))
    return found


def _selected(records: Sequence[Record], fewest: int) -> list[bool]:
    """Whether each selected effect of the logs with many of them is right, named or not."""
    found = []
    for record in records:
        right, selected = right_names(record), record["signs"]["effects"]
        for effect in selected if len(selected) >= fewest else ():
            if not effect["refines"]:
                found.append(bool(right & {effect["name"], *effect["tied_with"]}))
    return found


def of_kind(records: Iterable[Record], *kinds: str) -> list[Record]:
    """Return the records of some kinds of trial."""
    return [record for record in records if record["kind"] in kinds]


def clearly_visible(record: Record) -> bool:
    """Whether the cause of a trial is visible and not borderline."""
    return bool(record["visible"] and not record["borderline"])


def named(record: Record) -> bool:
    """Whether any effect was named."""
    return bool(record["effects"])


def flagged(record: Record) -> bool:
    """Whether an unknown cause was reported."""
    return bool(record["unknown"]["flag"])


def exact(record: Record) -> bool:
    """Whether each cause was named, or tied with the name, and nothing else was reported."""
    if flagged(record) or len(record["effects"]) != len(record["causes"]):
        return False
    missing = set(record["causes"])
    for effect in record["effects"]:
        meant = {effect["name"], *effect["tied_with"]}
        for cause in sorted(missing):
            same = {cause, *record["equivalent"].get(cause, [])}
            if meant & same:
                missing.remove(cause)
                break
    return not missing


def wrong(record: Record) -> bool:
    """Whether an effect was named that is neither a cause nor tied with one."""
    right = right_names(record)
    for effect in record["effects"]:
        if not right & {effect["name"], *effect["tied_with"]}:
            return True
    return False


def names_a_cause(record: Record) -> bool:
    """Whether a cause of the library was named, or is tied with a name."""
    right = right_names(record)
    return any(right & {effect["name"], *effect["tied_with"]} for effect in record["effects"])


def harmed(record: Record) -> bool:
    """Whether recalibration made free runs over held-out data worse than the file as written.

    Position and heading count alike: the geometric mean of their ratios is above 1.
    """
    ratio = 1.0
    for family in ("position_rms_m", "heading_rms_rad", "roll_rms_rad"):
        errors = record["fit"].get(family) or {}
        if errors.get("nominal"):
            ratio *= errors["recalibrated"] / errors["nominal"]
    return ratio > WORSE


WORSE = 1.02  # product of the error ratios from which recalibration has harmed


def share(right: Sequence[bool]) -> str:
    """Return a share with its 95 % interval as text."""
    n = len(right)
    if not n:
        return "none"
    p = sum(right) / n
    low, high = wilson_interval(p, n)
    return f"{sum(right)}/{n} = {p:.3f} ({low:.3f} to {high:.3f})"


def wilson_interval(share_of_trials: float, count: int) -> tuple[float, float]:
    """Return the 95 % interval of a probability (E. B. Wilson, JASA 22, 1927).

    Args:
        share_of_trials: Observed share.
        count: Number of trials, at least one.
    """
    p, n, z = share_of_trials, count, QUANTILE
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return max(middle - half, 0.0), min(middle + half, 1.0)


def count(records: Sequence[Record], holds: Callable[[Record], bool]) -> str:
    """Return the share of records for which a statement holds, as text."""
    return share([holds(record) for record in records])


def print_tables(records: Sequence[Record]) -> None:
    """Print all tables of a campaign."""
    vessels = sorted({record["vessel"] for record in records})
    print(f"{len(records)} diagnoses of {len({r['trial'] for r in records})} trials", end="")
    print(f" over {len(vessels)} vessels: {', '.join(vessels)}\n")
    print_figures(figures(records))
    print("\nreliability of stated probabilities")
    print(f"{'stated':>14} {'names':>6} {'mean stated':>12} {'right':>8}")
    for row in reliability(statements(records)):
        interval = f"{row.low:.2f} to {row.high:.2f}"
        print(f"{interval:>14} {row.count:6d} {row.stated:12.3f} {row.right:8.3f}")
    for title, chosen in (
        ("vessel file exact", [r for r in records if not r["rough"]]),
        ("vessel file rough", [r for r in records if r["rough"]]),
    ):
        print(f"\n{title}")
        print_figures(figures(chosen))


def print_figures(table: dict[str, str]) -> None:
    """Print a table of figures."""
    for words, figure in table.items():
        print(f"{words:55s} {figure}")
