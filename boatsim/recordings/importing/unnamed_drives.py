"""Outputs without telling names, such as m1 or ch3, and their drives by the motion."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.drive_evidence import (
    DriveEffect,
    MotionOfLog,
    effects_on_motion,
    without_copies,
)
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.signal_classification import MIN_SAMPLES, Classification
from boatsim.recordings.importing.signal_words import HELM, WORDS, side_from_tokens, tokenize_name
from boatsim.recordings.notes import unit_of

# Words before the number of an output of a controller
OUTPUT_STEMS = set(
    "m mot ch chan channel out act srv aux drv drive eng engine esc k u ctrl control cmd".split()
)
# Words of numbered signals that are no outputs
NO_OUTPUTS = set(
    "temp cell sat snr wp adc acc gyro mag q x y z w lat lon id seq rssi volt voltage current curr "
    "amp power press pressure error err status mode flag probe wave depth sonar range lidar beam "
    "baro cov std var".split()
)
MAX_OUTPUTS = 16  # outputs that are compared; controllers have no more
LEVER = 1e-6  # [m] a smaller lever is none
STEERS, CENTRE, TO_STARBOARD, TO_PORT = "steers", "centre", "to starboard", "to port"
ANY_THRUST = "any thrust"


@dataclass(frozen=True)
class MatchByMotion:
    """Outputs of drives by the motion.

    Attributes:
        found: Channel -> output, and what its owner must check.
        questions: Lines that ask for what the motion does not show.
        throttle: Output that pushes ahead, and `steering` output that turns, for two fixed drives
            that a mixer commands; None otherwise.
        steering: See `throttle`.
    """

    found: dict[str, tuple[Classification, str]] = field(default_factory=dict)
    questions: list[str] = field(default_factory=list)
    throttle: Classification | None = None
    steering: Classification | None = None


def numbered_outputs(log: Log, classified: Sequence[Classification]) -> list[Classification]:
    """Return signals of no known meaning that may be outputs: a word or letter and a number.

    Args:
        log: The log.
        classified: Its signals with a known meaning.
    """
    known = {g.name for g in classified}
    families: dict[str, list[Classification]] = {}
    for name, signal in log.signals.items():
        values = signal.values[np.isfinite(signal.values)]
        if name in known or len(values) < MIN_SAMPLES or not float(np.ptp(values)) > 0.0:
            continue
        tokens = tokenize_name(name.rpartition(".")[2])
        numbers = [i for i, word in enumerate(tokens) if word.isdigit()]
        whole = frozenset(tokenize_name(name))
        if len(numbers) != 1 or whole & NO_OUTPUTS:
            continue
        before, units = tokens[: numbers[0]], tokens[numbers[0] + 1 :]
        if len(before) != 1 or any(word not in WORDS for word in units):
            continue
        unit = WORDS[units[0]] if units else ""
        g = Classification(name, signal, "command", unit, 0.0, "", whole)
        families.setdefault(before[0], []).append(g)
    found: list[Classification] = []
    for stem, family in families.items():
        if stem in OUTPUT_STEMS or len(family) > 1:
            found += family
    if len(found) > MAX_OUTPUTS:
        found = [g for g in found if g.tokens & OUTPUT_STEMS]
    return found[:MAX_OUTPUTS]


def is_called_an_output(g: Classification) -> bool:
    """Return whether the name of a numbered signal has a word for an output."""
    return bool(g.tokens & OUTPUT_STEMS)


def match_by_motion(
    drives: Sequence[VesselChannel], outputs: Sequence[Classification], motion: MotionOfLog
) -> MatchByMotion:
    """Return the outputs of drives by what the vessel does with them.

    Args:
        drives: Channels of the vessel without a signal.
        outputs: Outputs that are not used yet.
        motion: Motion of the log.
    """
    outputs, _ = without_copies(outputs)
    effects = dict(zip([g.name for g in outputs], effects_on_motion(outputs, motion), strict=True))
    by_kind: dict[str, list[Classification]] = {}
    for g in outputs:
        if kind := _kind_of_effect(effects[g.name]):
            by_kind.setdefault(kind, []).append(g)
    wanted: dict[str, list[VesselChannel]] = {}
    for drive in drives:
        wanted.setdefault(kind_of_drive(drive), []).append(drive)
    result = MatchByMotion()
    if _is_mixed(wanted, by_kind):
        return MatchByMotion(throttle=by_kind[CENTRE][0], steering=by_kind[STEERS][0])
    if ANY_THRUST in wanted:  # its turning is not known
        thrusts = [kind for kind in (CENTRE, TO_STARBOARD, TO_PORT) if kind not in wanted]
        by_kind[ANY_THRUST] = [g for kind in thrusts for g in by_kind.get(kind, [])]
    for kind, own in wanted.items():
        there = by_kind.get(kind, [])
        if len(there) == len(own):
            for drive, g in zip(own, there, strict=True):
                result.found[drive.name] = (g, _note(effects[g.name]))
        if there and (len(own) > 1 or len(there) != len(own)):
            result.questions.append(_question(kind, own, there))
    return result


def kind_of_drive(drive: VesselChannel) -> str:
    """Return the effect of a drive: it steers, or its thrust turns the vessel to a side, or not."""
    unit = unit_of(drive.name)
    tokens = frozenset(tokenize_name(drive.name))
    if unit == "rad" or not unit and tokens & HELM:
        return STEERS
    side = side_from_tokens(tokens)
    if drive.lever is None:
        return {"port": TO_STARBOARD, "starboard": TO_PORT}.get(side, ANY_THRUST)
    if abs(drive.lever) < LEVER:
        return CENTRE
    return TO_STARBOARD if drive.lever > 0.0 else TO_PORT


def _kind_of_effect(effect: DriveEffect) -> str:
    """The kind of drive with an effect on the motion; "" for none."""
    if effect.ahead == 0.0:
        return STEERS if effect.turn else ""
    if effect.turn == 0.0:
        return CENTRE
    return TO_STARBOARD if effect.ahead * effect.turn > 0.0 else TO_PORT


def _is_mixed(
    wanted: Mapping[str, Sequence[VesselChannel]],
    by_kind: Mapping[str, Sequence[Classification]],
) -> bool:
    """Whether drives on both sides are fixed and one output pushes, another one turns."""
    fixed = wanted.keys() == {TO_STARBOARD, TO_PORT}
    sides = by_kind.keys() & {TO_STARBOARD, TO_PORT}
    return fixed and not sides and [len(by_kind.get(k, ())) for k in (CENTRE, STEERS)] == [1, 1]


def _note(effect: DriveEffect) -> str:
    """The note on an output that the motion shows, for its owner to check."""
    done = []
    if effect.ahead:
        way = "goes ahead" if effect.ahead > 0.0 else "goes astern"
        done.append(f"{way} (correlation {effect.ahead:+.2f})")
    if effect.turn:
        side = "starboard" if effect.turn > 0.0 else "port"
        done.append(f"turns to {side} (correlation {effect.turn:+.2f})")
    note = f"; CHECK: by the motion, for with it the boat {' and '.join(done)}"
    if effect.ahead < 0.0:
        note += "; is its sign reversed?"
    return note


def _question(kind: str, drives: Sequence[VesselChannel], outputs: Sequence[Classification]) -> str:
    """A line that asks which output is which drive, because the motion does not show it."""
    signals = ", ".join(g.name for g in outputs)
    names = " and ".join(drive.name for drive in drives)
    what = {
        STEERS: "turn the boat",
        CENTRE: "push the boat straight ahead",
        TO_STARBOARD: "push ahead and turn the boat to starboard",
        TO_PORT: "push ahead and turn the boat to port",
        ANY_THRUST: "push the boat ahead",
    }[kind]
    if len(outputs) == 1:
        return f"# CHECK: only {signals} seems to {what}; which signals are {names}?"
    which = f"is {names}" if len(drives) == 1 else f"are {names}"
    return f"# CHECK: which of {signals} {which}? All of these {what}"
