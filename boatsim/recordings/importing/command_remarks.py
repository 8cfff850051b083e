"""Remarks to the owner of a log on its commands: sides, lost signs, unused signals."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.channel_line import channel_line
from boatsim.recordings.importing.channel_units import are_of_one_kind, is_thrust_by_revolutions
from boatsim.recordings.importing.channels import SIDED, VesselChannel
from boatsim.recordings.importing.channels_by_name import match_by_similarity
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import expression_of, printable_name
from boatsim.recordings.importing.signal_words import side_from_tokens, tokenize_name
from boatsim.recordings.importing.track import values_in_si
from boatsim.recordings.importing.turning import MIN_CORRELATION, Turning, held_values
from boatsim.recordings.order_signs import (
    EFFORT_COLUMNS,
    laws_of_unsigned_orders,
    rows_without_sign,
)


def exchanged_side_lines(
    drives: Sequence[VesselChannel],
    chosen: Mapping[str, tuple[Classification, str]],
    turning: Turning,
) -> list[str]:
    """Return a comment if the boat turns to the other side than fixed drives ask for.

    Args:
        drives: Channels of the vessel.
        chosen: Channel -> signal, and what its owner must check.
        turning: Turning of the vessel.
    """
    terms = []
    for drive in drives:
        if drive.lever and drive.name in chosen:
            terms.append((chosen[drive.name][0], float(np.sign(drive.lever))))
    if len({sign for _, sign in terms}) < len(SIDED):
        return []
    sense = turning.correlation(*terms)
    if sense > -MIN_CORRELATION:
        return []
    return [
        "# CHECK: the boat turns to the other side than these commands ask for (correlation "
        f"{sense:+.2f}): are two drives exchanged, or is the heading counted counterclockwise?"
    ]


def unsigned_order_lines(
    drives: Sequence[VesselChannel],
    chosen: Mapping[str, tuple[Classification, str]],
    best: Mapping[str, Sequence[Classification]],
) -> tuple[list[str], list[Classification]]:
    """Return lines of the force and moment from which orders that lost their sign were computed.

    Args:
        drives: Channels of the vessel.
        chosen: Channel -> signal, and what its owner must check.
        best: Column -> classified signals, the most probable first.

    Returns:
        Lines, and the signals of the force and the moment; both empty if no order lost its sign.
    """
    efforts = {kind: best[kind][0] for kind in EFFORT_COLUMNS if best.get(kind)}
    if len(chosen) < len(drives) or len(efforts) < len(EFFORT_COLUMNS):
        return [], []
    signals = {name: values_in_si(g) for name, (g, _) in chosen.items()}
    t = next(iter(signals.values()))[0]
    if len(t) == 0:
        return [], []
    orders = {name: held_values(at, values, t) for name, (at, values) in signals.items()}
    asked = [held_values(*values_in_si(efforts[kind]), t) for kind in EFFORT_COLUMNS]
    laws = laws_of_unsigned_orders(orders, *asked)
    if not laws:
        return [], []
    share = rows_without_sign(laws).mean()
    names = [printable_name(g.name) for g, _ in chosen.values()]
    lines = [
        f"# CHECK: {', '.join(names)} follow from the force and moment below, but are never",
        f"# negative, where these ask for it in {100.0 * share:.2g} % of the rows. Did the drives",
        "# push astern? A diagnosis decides by the motion and restores the signs.",
    ]
    for kind, g in efforts.items():
        lines.append(f"{EFFORT_COLUMNS[kind]} = {toml_value(expression_of(g))}")
    return lines, list(efforts.values())


def unused_line(g: Classification, drives: Sequence[VesselChannel]) -> str:
    """Return a comment on a command that is not used, with the line of revolutions of a thruster.

    Args:
        g: The command.
        drives: Channels of the vessel.
    """
    for drive in drives:
        same_side = side_from_tokens(frozenset(tokenize_name(drive.name))) == side_from_tokens(
            g.tokens
        )
        if same_side and is_thrust_by_revolutions(drive, g):
            return f"# or by revolutions: {channel_line(drive.name, g, drive)}"
    return f"# not used: {printable_name(g.name)}"


def open_line(drive: VesselChannel, constant: Sequence[Classification]) -> str:
    """Return the comment of a channel that the owner must complete, and why it has no signal.

    Args:
        drive: The channel.
        constant: Commands of the log that are constant and were therefore not proposed.
    """
    alike = list(match_by_similarity([drive], constant).values())
    alike = alike or [g for g in constant if _may_command_side_of(drive, g)]
    why = "no signal has a similar name"
    if alike:
        known = alike[0].signal.values[np.isfinite(alike[0].signal.values)]
        why = (
            f"the signal {printable_name(alike[0].name)} is constant ({known[0]:g}) and was "
            "therefore not proposed"
        )
    return f'# {toml_key(drive.name)} = "..."  # {drive.low:g} to {drive.high:g}; {why}'


def _may_command_side_of(drive: VesselChannel, g: Classification) -> bool:
    """Whether a signal with another name has a unit and a side that suit a channel."""
    side = side_from_tokens(frozenset(tokenize_name(drive.name)))
    is_of_kind = are_of_one_kind(drive, g) or is_thrust_by_revolutions(drive, g)
    return is_of_kind and side == side_from_tokens(g.tokens)
