"""Signals of the channels that no name tells.

The motion shows them, else their order; what neither shows is a question to the owner of the log.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from boatsim.recordings.importing.channel_units import (
    is_thrust_by_revolutions,
    may_be_command_of,
    units_are_compatible,
    with_unit_of_helm,
)
from boatsim.recordings.importing.channels import SIDED, VesselChannel
from boatsim.recordings.importing.channels_by_name import NOTE_BY_NUMBER, unassigned
from boatsim.recordings.importing.drive_evidence import MotionOfLog
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import printable_name
from boatsim.recordings.importing.signal_words import side_from_tokens, tokenize_name
from boatsim.recordings.importing.turning import MIN_CORRELATION, Turning
from boatsim.recordings.importing.unnamed_drives import (
    MAX_OUTPUTS,
    TO_PORT,
    TO_STARBOARD,
    MatchByMotion,
    is_called_an_output,
    kind_of_drive,
    match_by_motion,
)

NOTE_BY_ORDER = "; CHECK: by order only"


class Unnamed(NamedTuple):
    """Outputs without telling names, and the motion that may show what they are.

    Attributes:
        outputs: The outputs.
        motion: Motion of the log.
    """

    outputs: Sequence[Classification]
    motion: MotionOfLog


def match_unnamed(
    drives: Sequence[VesselChannel],
    named: Mapping[str, tuple[Classification, str]],
    moving: Sequence[Classification],
    turning: Turning,
    unnamed: Unnamed,
) -> MatchByMotion:
    """Return signals of the channels that no name tells, by the motion or by order.

    Args:
        drives: Channels of the vessel.
        named: Channel -> signal by name, and what its owner must check.
        moving: Commands of the log that are not constant.
        turning: Turning of the vessel.
        unnamed: Outputs without telling names, and the motion.

    Returns:
        Signals of all channels that are known, and questions on the others; or the two orders of
        a mixer.
    """
    found, questions = _corrected_by_motion(drives, named, unnamed.motion)
    left = unassigned(moving, found)
    missing = [d for d in drives if d.name not in found]
    ordered = _signals_of_matching_stream(left, len(missing))
    is_decided = len(missing) == 1 == len(ordered) or _are_two_sides(missing, ordered)
    mixer: MatchByMotion | None = None
    if missing and not is_decided:
        outputs = [*left, *unnamed.outputs][:MAX_OUTPUTS]
        match = match_by_motion(missing, outputs, unnamed.motion)
        if match.throttle:
            mixer = match
        for drive in missing:
            if drive.name in match.found and may_be_command_of(drive, match.found[drive.name][0]):
                g, why = match.found[drive.name]
                found[drive.name] = (with_unit_of_helm(g, drive), why)
        questions += match.questions
    if mixer is not None:
        return mixer
    left = unassigned(moving, found)
    missing = [d for d in drives if d.name not in found]
    ordered = _signals_of_matching_stream(left, len(missing))
    called = unassigned([*left, *filter(is_called_an_output, unnamed.outputs)], found)
    if not ordered and not questions:
        ordered = _signals_of_matching_stream(called, len(missing))
    by_order = _match_by_order(missing, ordered, turning)
    guessed = [d for d in missing if by_order.get(d.name, ("", NOTE_BY_ORDER))[1] == NOTE_BY_ORDER]
    if guessed and called and not questions:
        questions.append(_question_of_order(guessed, called))
    found |= by_order
    return MatchByMotion(found, questions)


def _question_of_order(missing: Sequence[VesselChannel], ordered: Sequence[Classification]) -> str:
    """A line that asks which signal is which drive, where neither name nor motion shows it."""
    signals = ", ".join(printable_name(g.name) for g in ordered)
    names = " and ".join(drive.name for drive in missing)
    verb = "is" if len(missing) == 1 else "are"
    return f"# CHECK: which of {signals} {verb} {names}? Neither names nor the motion show it"


def _are_two_sides(missing: Sequence[VesselChannel], ordered: Sequence[Classification]) -> bool:
    """Whether two channels of the two sides are left for two signals; their difference decides."""
    sides = [side_from_tokens(frozenset(tokenize_name(d.name))) for d in missing]
    return len(ordered) == 2 and sorted(sides) == list(SIDED)


def _corrected_by_motion(
    drives: Sequence[VesselChannel],
    named: Mapping[str, tuple[Classification, str]],
    motion: MotionOfLog,
) -> tuple[dict[str, tuple[Classification, str]], list[str]]:
    """Signals by number, in another order if the motion contradicts it, and questions."""
    found = dict(named)
    group = [d for d in drives if d.name in named and named[d.name][1] == NOTE_BY_NUMBER]
    kinds = {d.name: kind_of_drive(d) for d in group}
    if len(set(kinds.values()) & {TO_STARBOARD, TO_PORT}) < len(SIDED):
        return found, []
    match = match_by_motion(group, [named[d.name][0] for d in group], motion)
    if len(match.found) < len(group):
        return found, []
    by_kind: dict[str, list[set[str]]] = {kind: [set(), set()] for kind in kinds.values()}
    for name, kind in kinds.items():
        by_kind[kind][0].add(named[name][0].name)
        by_kind[kind][1].add(match.found[name][0].name)
    if all(by_number == by_motion for by_number, by_motion in by_kind.values()):
        return found, []
    return found | match.found, match.questions


def _match_by_order(
    missing: Sequence[VesselChannel], left: Sequence[Classification], turning: Turning
) -> dict[str, tuple[Classification, str]]:
    """Signals of channels by order; two sides are exchanged if the turning shows it."""
    why = "; CHECK: the only signal that is left"
    if len(left) > 1:
        why = NOTE_BY_ORDER
    sides = [side_from_tokens(frozenset(tokenize_name(d.name))) for d in missing]
    if len(left) == 2 and sorted(sides) == list(SIDED):
        port = sides.index(SIDED[0])
        sense = turning.correlation((left[port], 1.0), (left[1 - port], -1.0))
        if abs(sense) > MIN_CORRELATION:
            if sense < 0.0:
                left = [left[1], left[0]]
            why = f"; CHECK: side by the turning of the boat (correlation {abs(sense):.2f})"
    found: dict[str, tuple[Classification, str]] = {}
    for drive, g in zip(missing, left, strict=False):
        if units_are_compatible(drive, g) or is_thrust_by_revolutions(drive, g):
            found[drive.name] = (g, why)
    return found


def _signals_of_matching_stream(
    moving: Sequence[Classification], count: int
) -> list[Classification]:
    """The signals of the stream with this number of signals; [] if no stream has it."""
    streams: dict[str, list[Classification]] = {}
    for g in moving:
        streams.setdefault(g.name.rpartition(".")[0], []).append(g)
    for signals in (*streams.values(), list(moving)):
        if len(signals) == count:
            return signals
    return []
