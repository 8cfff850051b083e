"""Lines of a proposed map for the commands to the drives."""

import re
from collections.abc import Mapping, Sequence

from boatsim.recordings.importing.channel_line import channel_line
from boatsim.recordings.importing.channel_units import is_steering_channel
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.channels_by_motion import Unnamed, match_unnamed
from boatsim.recordings.importing.channels_by_name import match_by_names, unassigned
from boatsim.recordings.importing.command_remarks import (
    exchanged_side_lines,
    open_line,
    unsigned_order_lines,
    unused_line,
)
from boatsim.recordings.importing.effort_allocation import (
    EFFORTS,
    allocation_lines,
    lines_of_mixer,
    mixing_lines,
)
from boatsim.recordings.importing.revolution_unit import RevolutionUnit
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import is_constant, unique_names
from boatsim.recordings.importing.signal_words import HELM, side_from_tokens, tokenize_name
from boatsim.recordings.importing.substitute_orders import reports_as_orders, sticks_of_sides
from boatsim.recordings.importing.turning import Turning


def command_lines(
    best: Mapping[str, Sequence[Classification]],
    drives: Sequence[VesselChannel],
    turning: Turning,
    unit: RevolutionUnit,
    unnamed: Unnamed,
) -> tuple[list[str], list[Classification]]:
    """Return lines of the vessel's channels, or without a vessel of all moving outputs.

    Args:
        best: Column -> classified signals, the most probable first.
        drives: Channels of the vessel that have no line yet; none without a vessel.
        turning: Turning of the vessel.
        unit: Unit of revolutions.
        unnamed: Outputs without telling names, and the motion.

    Returns:
        Lines, and the signals that they use.
    """
    channels = [drive.name for drive in drives]
    moving: list[Classification] = []
    constant: list[Classification] = []
    for g in best.get("command", []):
        if g.name in channels or not is_constant(g):
            moving.append(g)
        else:
            constant.append(g)
    moving.sort(key=lambda g: _natural_sort_key(g.name))
    lines: list[str] = []
    if not drives:
        for name, g in zip(unique_names(list(map(_column_name, moving))), moving, strict=True):
            lines.append(channel_line(name, g, None))
        return lines, moving
    taken: list[Classification] = []
    allocated, mixed = mixing_lines(drives, moving or best.get("stick", []), turning)
    taken += mixed
    chosen: dict[str, tuple[Classification, str]] = {}
    questions: list[str] = []
    if not allocated:
        chosen = match_by_names(best, drives, moving, turning)
        by_motion = match_unnamed(drives, chosen, moving, turning, unnamed)
        is_open = bool(by_motion.questions) or len(by_motion.found) < len(drives)
        if not chosen and is_open and allocation_lines(drives, best):  # orders that have names
            named_only = unnamed._replace(outputs=())
            by_motion = match_unnamed(drives, chosen, moving, turning, named_only)
        chosen, questions = by_motion.found, by_motion.questions
        if by_motion.throttle and by_motion.steering and not chosen:
            pair = (by_motion.throttle, by_motion.steering)
            allocated = lines_of_mixer(drives, *pair, turning)
            taken += pair
    if not chosen and not allocated:
        allocated = allocation_lines(drives, best)
        taken += [best[kind][0] for kind in EFFORTS if allocated and kind in best]
    if not allocated and not questions:
        chosen = _with_substitutes(chosen, drives, best, moving, turning, unnamed)
    for drive in drives:
        if drive.name in allocated:
            lines.append(allocated[drive.name])
            continue
        if drive.name not in chosen:
            lines.append(open_line(drive, constant))
            continue
        g, why = chosen[drive.name]
        sense = 0.0
        if is_steering_channel(drive) and g.name != drive.name:
            sense = drive.turns * turning.correlation((g, 1.0))
        taken.append(g)
        g, unit_note = unit.with_unit(g, drive)
        lines.append(channel_line(drive.name, g, drive, sense) + unit_note + why)
    lines += questions
    lines += exchanged_side_lines(drives, chosen, turning)
    unsigned, efforts = unsigned_order_lines(drives, chosen, best)
    lines += unsigned
    taken += efforts
    for g in moving:
        if g not in taken:
            lines.append(unused_line(g, drives))
    return lines, taken


def _with_substitutes(
    chosen: Mapping[str, tuple[Classification, str]],
    drives: Sequence[VesselChannel],
    best: Mapping[str, Sequence[Classification]],
    moving: Sequence[Classification],
    turning: Turning,
    unnamed: Unnamed,
) -> dict[str, tuple[Classification, str]]:
    """Signals of channels, with sticks or reports of the drives where the log has no orders."""
    found = dict(chosen)
    missing = [drive for drive in drives if drive.name not in found]
    if not missing or unassigned(moving, found):
        return found
    found |= sticks_of_sides(missing, best)
    missing = [drive for drive in missing if drive.name not in found]
    return found | reports_as_orders(missing, best, turning, unnamed)


def _natural_sort_key(name: str) -> list[tuple[int, str]]:
    """Sort key by which output 10 comes after output 9."""
    key = []
    for part in filter(None, re.split(r"(\d+)", name)):
        if part.isdigit():
            key.append((int(part), ""))
        else:
            key.append((-1, part))
    return key


def _column_name(g: Classification) -> str:
    words = g.tokens | frozenset(tokenize_name(g.signal.about))
    name = "throttle"
    if words & HELM:
        name = "steer"
    if side := side_from_tokens(words):
        name += f"_{side}"
    return name + {"deg": "_rad", "rpm": "_radps"}.get(g.word, "")
