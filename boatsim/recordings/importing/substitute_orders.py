"""Signals in place of orders that a log does not have: two sticks, or reports of the drives."""

from collections.abc import Mapping, Sequence
from itertools import filterfalse

from boatsim.recordings.importing.channel_units import are_of_one_kind
from boatsim.recordings.importing.channels import SIDED, VesselChannel
from boatsim.recordings.importing.channels_by_motion import Unnamed, match_unnamed
from boatsim.recordings.importing.channels_by_name import match_by_names
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import is_constant
from boatsim.recordings.importing.signal_words import side_from_tokens, tokenize_name
from boatsim.recordings.importing.turning import Turning

NOTE_OF_STICK = "; CHECK: the log has no orders; a stick is taken as the order of the drive"
NOTE_OF_REPORT = "; CHECK: reported, not ordered: lags between order and report cannot be found"
# Words of the axes of one stick, which is not one of a drive
STICK_AXES = set("x y z horizontal vertical roll pitch yaw surge sway".split())


def sticks_of_sides(
    drives: Sequence[VesselChannel], best: Mapping[str, Sequence[Classification]]
) -> dict[str, tuple[Classification, str]]:
    """Return the sticks of two drives, one on each side.

    Args:
        drives: Channels of the vessel without a signal.
        best: Column -> classified signals, the most probable first.

    Returns:
        Channel -> stick, and what its owner must check; none unless there is one stick and one
        channel of each side.
    """
    by_side: dict[str, list[Classification]] = {}
    for g in filterfalse(is_constant, best.get("stick", [])):
        side = side_from_tokens(g.tokens)
        if side and not g.tokens & STICK_AXES:
            by_side.setdefault(side, []).append(g)
    found = {}
    for drive in drives:
        side = side_from_tokens(frozenset(tokenize_name(drive.name)))
        sticks = by_side.get(side, [])
        if len(sticks) == 1:
            found[drive.name] = (sticks[0], NOTE_OF_STICK)
    used = {g.name for g, _ in found.values()}
    if len(found) != len(SIDED) or len(used) != len(SIDED):
        return {}
    return found


def reports_as_orders(
    drives: Sequence[VesselChannel],
    best: Mapping[str, Sequence[Classification]],
    turning: Turning,
    unnamed: Unnamed,
) -> dict[str, tuple[Classification, str]]:
    """Return the states that drives without an order report, in place of the orders.

    Args:
        drives: Channels of the vessel without a signal.
        best: Column -> classified signals, the most probable first.
        turning: Turning of the vessel.
        unnamed: Outputs without telling names, and the motion.

    Returns:
        Channel -> report of the same kind, such as a shaft rate, and what its owner must check.
    """
    found: dict[str, tuple[Classification, str]] = {}
    for kind in dict.fromkeys(drive.name.rpartition("_")[2] for drive in drives):
        own = [drive for drive in drives if drive.name.rpartition("_")[2] == kind]
        reports = []
        for g in filterfalse(is_constant, best.get("actual", [])):
            if are_of_one_kind(own[0], g):
                reports.append(g)
        reports.sort(key=lambda g: g.name)
        if not reports:
            continue
        named = match_by_names(best, own, reports, turning)
        no_outputs = unnamed._replace(outputs=())
        matched = match_unnamed(own, named, reports, turning, no_outputs)
        for name, (g, why) in matched.found.items():
            found[name] = (g, why + NOTE_OF_REPORT)
    return found
