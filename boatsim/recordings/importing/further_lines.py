"""Lines of a proposed map for measured states of the drives and the pilot's sticks."""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import filterfalse

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.channel_line import expression_with_unit
from boatsim.recordings.importing.channel_units import are_of_one_kind
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.channels_by_name import match_by_similarity
from boatsim.recordings.importing.revolution_unit import RevolutionUnit
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import expression_of, is_constant, unique_names

ACTUAL = "actual"  # kind of a measured state of a drive, with which the name of its column begins


def further_lines(
    best: Mapping[str, list[Classification]],
    drives: Sequence[VesselChannel],
    used: Sequence[Classification],
    unit: RevolutionUnit,
) -> list[str]:
    """Return lines for measured states of the drives and the pilot's sticks.

    No effect needs them; each kind has a heading.

    Args:
        best: Column -> classified signals, the most probable first.
        drives: Channels of the vessel; a state of one is named after it, so that it can be compared
            with the order.
        used: Signals that are orders already.
        unit: Unit of revolutions.
    """
    taken = {g.name for g in used}
    lines: list[str] = []
    for kind, about in (
        (ACTUAL, "measured state of the drives"),
        ("stick", "the pilot's sticks, recorded with the commands"),
    ):
        moving = []
        for g in filterfalse(is_constant, best.get(kind, [])):
            if g.name not in taken:
                moving.append(g)
        moving.sort(key=lambda g: g.name)
        named = []
        if kind == ACTUAL:
            reports = _reports_of_channels(drives, moving, unit)
            named = [_line(f"{ACTUAL}_{name}", g) for name, g in reports.items()]
            signals = {g.name for g in reports.values()}
            moving = [g for g in moving if g.name not in signals]
        further = named + _lines_of_kind(kind, moving)
        if further:
            lines += ["", f"# {about}", *further]
    return lines


def _reports_of_channels(
    drives: Sequence[VesselChannel], reports: Sequence[Classification], unit: RevolutionUnit
) -> dict[str, Classification]:
    """Channel -> what its drive reports, in the same kind of unit, by the name."""
    found = {}
    for drive in drives:
        alike = []
        for g in reports:
            known, _ = unit.with_unit(g, drive)
            if are_of_one_kind(drive, known):
                alike.append(known)
        matched = match_by_similarity([drive], alike)
        if drive.name in matched:
            found[drive.name] = matched[drive.name]
    counts = Counter(g.name for g in found.values())
    return {name: g for name, g in found.items() if counts[g.name] == 1}


def _line(name: str, g: Classification) -> str:
    return f"{toml_key(name)} = {toml_value(expression_with_unit(g, name))}"


def _lines_of_kind(kind: str, found: Sequence[Classification]) -> list[str]:
    """Lines of further columns, named by kind and signal."""
    names = []
    for g in found:
        plain = re.sub(r"[^a-z0-9]+", "_", g.name.lower()).strip("_")
        names.append(f"{kind}_{plain.removeprefix(f'{kind}_')}")
    lines = []
    for name, g in zip(unique_names(names), found, strict=True):
        expression = expression_of(g)
        if g.word == "us":
            expression = g.name
        lines.append(f"{toml_key(name)} = {toml_value(expression)}")
    return lines
