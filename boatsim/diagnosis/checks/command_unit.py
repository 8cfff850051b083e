"""Commands in per cent, degrees, revolutions a minute or pulses: beyond what the vessel's drives can be told."""

import math
from collections.abc import Iterator

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import ROUNDING, Recording

BEYOND, SURELY = (
    1.05,
    1.5,
)  # times the limit: from the former on it may be another unit, from the latter it is
FILLS = 0.1  # of the range, at least, by a command in its right unit
PULSES = (900.0, 2100.0)  # [us] of servo pulses; 1500 is neutral and 500 on either side are full


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Command channels that pass the vessel's limits and are within them in another unit; alike channels together."""
    groups: dict[tuple[str, float, float], list[str]] = {}
    for name, change in _beyond(recording, vessel):
        groups.setdefault((change[0], change[1], change[2]), []).append(name)
    found = []
    for (unit, factor, offset), names in groups.items():
        alike = [*names, *_of_the_same(recording, vessel, names)]
        evidence = "; ".join(
            f"{n} goes from {np.nanmin(recording[n]):.4g} to {np.nanmax(recording[n]):.4g}, and {vessel.name} takes "
            f"{vessel.commands[n].low:g} to {vessel.commands[n].high:g} {unit_of(n)}".rstrip()
            for n in names
        )
        changes = tuple(Change(n, n, factor, offset) for n in alike)
        limits = (max(abs(vessel.commands[n].low), abs(vessel.commands[n].high)) for n in names)
        surely = any(
            np.nanmax(np.abs(recording[n])) > SURELY * x for n, x in zip(names, limits, strict=True)
        )
        words = f"{evidence}: that {'is' if surely else 'may be'} {unit}"
        found.append(Finding("command_unit", words, sure=0.95 if surely else 0.7, changes=changes))
    return found


def _beyond(recording: Recording, vessel: Vessel) -> Iterator[tuple[str, tuple[str, float, float]]]:
    for name, command in vessel.commands.items():
        if name not in recording.signals or not math.isfinite(
            limit := max(abs(command.low), abs(command.high))
        ):
            continue
        values = recording[name][np.isfinite(recording[name])]
        if (
            len(values)
            and float(np.abs(values).max()) > BEYOND * limit
            and (unit := _unit(values, name, limit))
        ):
            yield name, unit


def _unit(
    values: "np.ndarray[tuple[int], np.dtype[np.float64]]", name: str, limit: float
) -> tuple[str, float, float] | None:
    """(unit in words, factor, offset) by which values (N,) come within a limit and fill it."""
    low, high = float(values.min()), float(values.max())
    if PULSES[0] <= low and high <= PULSES[1]:
        return "pulses in us", limit / 500.0, -3.0 * limit
    percent = ("per cent of full", limit / 100.0)
    tried = {
        "rad": [("degrees", UNITS["deg"]), percent],
        "rad/s": [("revolutions a minute", UNITS["rpm"]), percent],
        "N": [percent, ("thousandths", 1e-3)],
    }.get(unit_of(name), [percent])
    largest = max(abs(low), abs(high))
    for unit, factor in tried:
        if FILLS * limit <= largest * factor <= (1.0 + 5.0 * ROUNDING) * limit:
            return unit, factor, 0.0
    return None


def _of_the_same(recording: Recording, vessel: Vessel, names: list[str]) -> list[str]:
    """Further channels with the same unit and range: one logger wrote them all, be one of them but little used."""
    ranges = {(unit_of(n), vessel.commands[n].low, vessel.commands[n].high) for n in names}
    return [
        n
        for n, c in vessel.commands.items()
        if n in recording.signals and n not in names and (unit_of(n), c.low, c.high) in ranges
    ]
