"""Signals of the channels of a vessel by name or number, and of a helm by the turning."""

import re
from collections.abc import Mapping, Sequence
from itertools import filterfalse, repeat

from boatsim.recordings.importing.channel_units import is_steering_channel, units_are_compatible
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import is_constant
from boatsim.recordings.importing.signal_words import (
    HELM,
    ORDERED,
    end_from_tokens,
    side_from_tokens,
    tokenize_name,
)
from boatsim.recordings.importing.single_axis import is_load_of_channel
from boatsim.recordings.importing.turning import Turning

MANY_DRIVES = 3  # from which on drives are matched by number: sides no longer tell them apart
NOTE_BY_NUMBER = "; CHECK: by number, in the order of the vessel's drives"


def match_by_names(
    best: Mapping[str, Sequence[Classification]],
    drives: Sequence[VesselChannel],
    moving: Sequence[Classification],
    turning: Turning,
) -> dict[str, tuple[Classification, str]]:
    """Return signals of the channels by number and name, and of a helm by the turning.

    Args:
        best: Column -> classified signals, the most probable first.
        drives: Channels of the vessel.
        moving: Commands of the log that are not constant.
        turning: Turning of the vessel.

    Returns:
        Channel -> signal, and what its owner must check.
    """
    exact = {g.name: g for g in moving}
    found = _with_note({d.name: exact[d.name] for d in drives if d.name in exact}, "")
    for steers in (True, False):
        group = [d for d in drives if d.name not in found and is_steering_channel(d) is steers]
        found |= _match_by_number(group, unassigned(moving, found))
    unnumbered = [d for d in drives if d.name not in found]
    found |= _with_note(match_by_similarity(unnumbered, unassigned(moving, found)), "")
    helms = [d for d in drives if d.name not in found and is_steering_channel(d)]
    if helms:
        named: list[Classification] = []
        for name, (g, _) in found.items():
            if frozenset(tokenize_name(name)) & HELM and not side_from_tokens(g.tokens):
                named.append(g)
        measured = list(filterfalse(is_constant, best.get("actual", [])))
        found |= _match_steering_channels(
            helms, named, unassigned(moving, found), measured, turning
        )
    return found


def unassigned(
    signals: Sequence[Classification], found: Mapping[str, tuple[Classification, str]]
) -> list[Classification]:
    """Return the signals that no channel has yet.

    Args:
        signals: The signals.
        found: Channel -> signal, and what its owner must check.
    """
    used = [g for g, _ in found.values()]
    return [g for g in signals if g not in used]


def _match_steering_channels(
    helms: Sequence[VesselChannel],
    named: Sequence[Classification],
    left: Sequence[Classification],
    measured: Sequence[Classification],
    turning: Turning,
) -> dict[str, tuple[Classification, str]]:
    """Signals of channels that steer: by name, by the turning, or a measured angle."""
    if named:
        return _assign_to_all(helms, named[0], "; CHECK: one helm is used for all")
    if steers := turning.steering_signal([g for g in left if units_are_compatible(helms[0], g)]):
        why = f"; CHECK: chosen because the boat turns with it (correlation {steers[1]:+.2f})"
        return _assign_to_all(helms, steers[0], why)
    why = "; CHECK: the measured angle is used as the command"
    rudders = [g for g in measured if g.tokens & HELM and units_are_compatible(helms[0], g)]
    if len(rudders) == 1:
        return _assign_to_all(helms, rudders[0], why)
    return _with_note(match_by_similarity(helms, rudders), why)


def _with_note(
    matched: Mapping[str, Classification], note: str
) -> dict[str, tuple[Classification, str]]:
    """The signals of channels, each with the same note."""
    return dict(zip(matched, zip(matched.values(), repeat(note)), strict=True))


def _assign_to_all(
    helms: Sequence[VesselChannel], g: Classification, why: str
) -> dict[str, tuple[Classification, str]]:
    return dict.fromkeys([helm.name for helm in helms], (g, why))


def _match_by_number(
    drives: Sequence[VesselChannel], signals: Sequence[Classification]
) -> dict[str, tuple[Classification, str]]:
    """Signals of many drives of one kind that differ in one number, in the order of the drives.

    Orders go before what a drive reports. Names with a side, and one or two drives, are matched
    otherwise.
    """
    if len(drives) < MANY_DRIVES:
        return {}
    own = [re.findall(r"\d+", drive.name) for drive in drives]
    if all(len(numbers) == 1 for numbers in own) and len({*map(tuple, own)}) == len(drives):
        drives = sorted(drives, key=lambda drive: int(re.findall(r"\d+", drive.name)[0]))
    families: dict[str, dict[int, Classification]] = {}
    for g in signals:
        numbers = re.findall(r"\d+", g.name)
        if len(numbers) == 1 and not side_from_tokens(g.tokens):
            families.setdefault(re.sub(r"\d+", "#", g.name), {})[int(numbers[0])] = g
    best: list[list[Classification]] = []
    for family in families.values():
        order = [family[number] for number in sorted(family)]
        consecutive = max(family) - min(family) == len(drives) - 1
        alike = all(bool(g.tokens & HELM) == is_steering_channel(drives[0]) for g in order)
        matching = len(order) == len(drives) and consecutive and alike
        if matching and all(map(units_are_compatible, drives, order)):
            best.append(order)
    ordered = [order for order in best if order[0].tokens & ORDERED] or best
    if len(ordered) != 1:
        return {}
    found = {}
    for drive, g in zip(drives, ordered[0], strict=True):
        found[drive.name] = (g, NOTE_BY_NUMBER)
    return found


def match_by_similarity(
    drives: Sequence[VesselChannel], moving: Sequence[Classification]
) -> dict[str, Classification]:
    """Return the signal with the most similar name of each channel; no signal is used twice.

    Args:
        drives: Channels of the vessel.
        moving: Signals that are not constant.
    """
    pairs = []
    for drive in drives:
        for i, g in enumerate(moving):
            pairs.append((_name_similarity(drive, g), -i, drive.name, g))
    pairs.sort(key=lambda pair: pair[:2], reverse=True)
    found: dict[str, Classification] = {}
    for score, _, name, g in pairs:
        if score < 1.0 or name in found or g in found.values():
            continue
        best_rival = 0.0
        for rival_score, _, rival_name, rival in pairs:
            if rival_name == name and rival is not g and rival not in found.values():
                best_rival = max(best_rival, rival_score)
        if score > best_rival:
            found[name] = g
    return found


def _name_similarity(drive: VesselChannel, g: Classification) -> float:
    if drive.name == g.name:
        return 10.0
    theirs = g.tokens | frozenset(tokenize_name(g.signal.about))
    ours = frozenset(tokenize_name(drive.name))
    if not units_are_compatible(drive, g) or bool(ours & HELM) != bool(theirs & HELM):
        return 0.0
    special = bool(ours & HELM) + is_load_of_channel(theirs, ours)
    for place_from_tokens in (side_from_tokens, end_from_tokens):
        mine, other = place_from_tokens(ours), place_from_tokens(theirs)
        if mine != other and "" not in (mine, other):
            return 0.0
        special += mine == other and mine != ""
    return 1.0 * special + 0.5 * len(ours & theirs)
