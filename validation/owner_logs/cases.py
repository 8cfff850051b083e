"""Cases of a seed: a boat, a format, an optional fault, an optional cause, and two logs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from validation.owner_logs.boats import Boat, Rng, sample_fleet
from validation.owner_logs.causes import CAUSES
from validation.owner_logs.faults import FAULTS, Fault
from validation.owner_logs.formats import ardupilot, nmea, px4, ros, tables
from validation.owner_logs.formats.log import WrittenLog
from validation.owner_logs.instruments import (
    InstrumentQuality,
    RecordedSignals,
    record_voyage,
    sample_instruments,
)
from validation.owner_logs.pilot import Owner, pilot
from validation.owner_logs.sail import Linkage, simulate_voyage

FORMATS = ("csv", "BIN", "mcap", "ros", "ulog", "nmea", "parquet")
KINDS = (
    "good",
    "fault",
    "cause",
    "good",
    "fault",
    "cause",
    "good",
    "both",
    "cause",
    "good",
    "fault",
    "both",
)
SHORTEST, LONGEST = 240.0, 360.0  # [s] duration of a log


@dataclass(frozen=True)
class Case:
    """One question of the examination."""

    number: int
    kind: str  # good, fault, cause, both
    boat: Boat
    form: str
    fault: str = ""
    cause: str = ""
    strength: str = ""  # of the cause, in words
    lasts: tuple[float, float] = (SHORTEST, SHORTEST)  # [s] of the log and of the second one
    seed: int = 0

    @property
    def wrong(self) -> Fault | None:
        """Its fault."""
        if self.fault:
            return FAULTS[self.fault]
        return None


def cases(seed: int, count: int) -> list[Case]:
    """Return all cases; faults and causes come in random order, each once before any repeats."""
    boats, rng = sample_fleet(seed), np.random.default_rng([seed, 2])
    faults, causes, forms, turns = list[str](), list[str](), list[str](), list[int]()
    found = []
    for i in range(count):
        forms = forms or [str(f) for f in rng.permutation(FORMATS)]
        turns = turns or [int(b) for b in rng.permutation(3)]
        kind, boat = KINDS[i % len(KINDS)], boats[turns.pop()]
        form = _choose_dialect(forms.pop(), boat, rng)
        fault = cause = ""
        if kind in ("fault", "both"):
            fault = _take_suitable(
                faults, list(FAULTS), partial(_fault_is_possible, boat, kind), rng
            )
            form = _choose_possible(FAULTS[fault], form, rng)
        if kind in ("cause", "both"):
            cause = _take_suitable(causes, list(CAUSES), partial(_cause_is_possible, boat), rng)
        lasts = tuple(float(np.round(rng.uniform(SHORTEST, LONGEST))) for _ in range(2))
        found.append(
            Case(i + 1, kind, boat, form, fault, cause, "", lasts, int(rng.integers(2**31)))
        )  # type: ignore[arg-type]
    return found


def _fault_is_possible(boat: Boat, kind: str, name: str) -> bool:
    """Return whether a boat's log may have a fault; tables in newtons need specified thrusts."""
    fault = FAULTS[name]
    in_newtons = "plain.csv" in fault.formats
    return (
        fault.fits(boat)
        and not (in_newtons and not boat.stated)
        and not (fault.blind and kind == "both")
    )


def _cause_is_possible(boat: Boat, name: str) -> bool:
    """Return whether a boat can have a cause."""
    return CAUSES[name].fits(boat)


def _take_suitable(
    bag: list[str], everything: Sequence[str], fits: Callable[[str], bool], rng: Rng
) -> str:
    """Remove and return the first suitable item of the bag; refill the bag if there is none."""
    if not any(map(fits, bag)):
        bag += [str(n) for n in rng.permutation(everything) if n not in bag]
    chosen = next(n for n in bag if fits(n))
    bag.remove(chosen)
    return chosen


def _choose_dialect(form: str, boat: Boat, rng: Rng) -> str:
    if form in ("csv", "parquet"):
        if boat.stated and rng.integers(2):
            return f"plain.{form}"
        return form
    if form == "ros":
        return str(rng.choice(["ros1", "ros2"]))
    return form


def _choose_possible(fault: Fault, form: str, rng: Rng) -> str:
    if not fault.formats or form in fault.formats:
        return form
    return str(rng.choice(fault.formats))


@dataclass(frozen=True)
class Logs:
    """The files of a case."""

    first: WrittenLog
    second: WrittenLog
    truth: dict[str, float]  # true values, such as the sd of a fix


def make(case: Case, folder: Path) -> tuple[Logs, Case]:
    """Simulate and write both logs."""
    rng = np.random.default_rng(case.seed)
    boat, link, strength = case.boat, Linkage(gains=(1.0,) * len(case.boat.plant.propellers)), ""
    if case.cause:
        around, link, strength = CAUSES[case.cause].make(boat, rng)
        link = replace(link, gains=link.gains[: len(boat.plant.propellers)])
        boat = replace(boat, plant=replace(boat.plant, around=around))
    on = sample_instruments(boat, rng)
    written = []
    for number, lasts in enumerate(case.lasts, 1):
        wrong = case.wrong if number == 1 else None
        written.append(
            _write_one_log(case, boat, link, wrong, on, lasts, folder, f"log_{number}", rng)
        )
    return Logs(written[0], written[1], {"fix_sd": on.fix_sd}), replace(case, strength=strength)


def _write_one_log(
    case: Case,
    boat: Boat,
    link: Linkage,
    wrong: Fault | None,
    on: InstrumentQuality,
    lasts: float,
    folder: Path,
    stem: str,
    rng: Rng,
) -> WrittenLog:
    hand = pilot(boat, rng, lasts, wrong.without if wrong else ())
    if wrong and wrong.limit > 1.0:
        hand = Owner([replace(s, throttle=1.0) for s in hand.plan])
    seen = record_voyage(boat, simulate_voyage(boat, link, hand, lasts, rng), on, rng)
    if wrong and wrong.seen:
        seen = wrong.seen(seen, boat, rng)
    return write(case, boat, seen, wrong, folder, stem)


def write(
    case: Case, boat: Boat, seen: RecordedSignals, wrong: Fault | None, folder: Path, stem: str
) -> WrittenLog:
    """Write a log in the format of the case."""
    form = case.form
    if form.startswith("plain."):
        columns = tables.recording_columns(seen, boat)
        columns = wrong.columns(columns, boat) if wrong and wrong.columns else columns
        return tables.write(columns, {}, folder / f"{stem}.{form.removeprefix('plain.')}")
    if form in ("csv", "parquet"):
        return tables.write(*tables.instrument_columns(seen, boat), folder / f"{stem}.{form}")
    if form in ("mcap", "ros1", "ros2"):
        writer = {"mcap": ros.write_mcap, "ros1": ros.write_ros1_bag, "ros2": ros.write_ros2_bag}[
            form
        ]
        ned = bool(wrong and wrong.ned)
        local = ned or bool(case.wrong and case.wrong.ned) or case.seed % 2 == 0
        return writer(seen, boat, folder, stem, local, ned)
    return {"BIN": ardupilot.write, "ulog": px4.write, "nmea": nmea.write}[form](
        seen, boat, folder, stem
    )
