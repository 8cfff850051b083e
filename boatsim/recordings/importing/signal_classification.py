"""Classification of the signals of a log by name, unit and range, with general rules."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.drive_names import (
    drive_kind,
    effort_by_unit,
    effort_of_words,
    is_direction_order,
    names_channel,
)
from boatsim.recordings.importing.log import Log, Signal, median_sampling_rate
from boatsim.recordings.importing.motion_names import (
    POSE_WORDS,
    column_of_motion,
    column_of_numbered,
    may_be_course,
)
from boatsim.recordings.importing.signal_units import (
    BY_RANGE,
    FULL_CIRCLE,
    most_degrees,
    unit_of_angle,
    unit_word,
)
from boatsim.recordings.importing.signal_words import (
    SATELLITES,
    WORDS,
    side_from_tokens,
    tokenize_name,
)
from boatsim.recordings.importing.single_axis import (
    WHY,
    column_of_single_axis,
    is_load_of_channel,
    unit_of_tumbling,
)
from boatsim.recordings.table import is_command

MIN_SAMPLES = 20
NOT_MEASURED = set(  # words of set points, errors and properties of signals
    "des desired target setpoint sp ref reference cmd command commanded error err innov "
    "innovation bias cov covariance "
    "var variance std sd accuracy reset resets delta test ratio "
    "valid status flags timeout home origin datum previous prev old next goal waypoint observer "
    "predicted simulated model".split()
)
SUPERFLUOUS = set(
    "data value raw filtered est estimate estimated meas measured".split()
)  # words at the end of names without meaning here
ANGLES = set("rudder steer steering nozzle azimuth azi helm delta wheel tiller".split())
MAX_RUDDER = 1.6  # [rad] a larger rudder angle is in degrees
LEAST_SCALED = 1e5  # [1e-7 deg] 0.01 degrees; smaller numbers are of no place in this unit
COLUMNS = (*POSE, *RATES)


@dataclass(frozen=True)
class Classification:
    """Classification of one signal.

    Attributes:
        name: Name of the signal.
        signal: The signal.
        column: Column of a recording, or latitude, longitude, command, actual or stick.
        word: Unit in an expression that converts the signal to SI; "" for none.
        score: The signal with the highest score is proposed.
        why: Assumption of the classification; "" for none.
        tokens: Words of the name.
    """

    name: str
    signal: Signal
    column: str
    word: str
    score: float
    why: str = ""
    tokens: frozenset[str] = field(default_factory=frozenset)


@dataclass(frozen=True)
class Body:
    """Facts about the vessel of a log that help to classify its signals.

    Attributes:
        channels: Names of its commands.
        dof: Its degrees of freedom; empty: unknown.
        turns_over: Whether it may roll to any angle.
    """

    channels: Sequence[str] = ()
    dof: Sequence[str] = ()
    turns_over: bool = False


UNKNOWN_BODY = Body()


def classify_signals(log: Log, body: Body = UNKNOWN_BODY) -> list[Classification]:
    """Return the classified signals of a log, the highest score first.

    Args:
        log: The log.
        body: The vessel.
    """
    found: list[Classification] = []
    for name, signal in log.signals.items():
        if (classified := classify_signal(name, signal, log, body)) is not None:
            found.append(classified)
    found = _with_unit_of_sensor(found)
    return sorted(found, key=lambda g: -g.score)


def classify_signal(
    name: str, signal: Signal, log: Log, body: Body = UNKNOWN_BODY
) -> Classification | None:
    """Return the classification of a signal by name, unit and range, None if it is unknown.

    Args:
        name: Name of the signal.
        signal: The signal.
        log: The log.
        body: The vessel.
    """
    values = signal.values[np.isfinite(signal.values)]
    if len(values) < MIN_SAMPLES or np.array_equal(signal.values, signal.t):
        return None  # the clock of a table is no signal
    words = tokenize_name(name) or [""]  # a name may have no word
    tokens = frozenset(words)
    if words[-2:] == ["e", "7"]:  # lat_e7, in 1e-7 degrees
        words = words[:-2]
    last = [w for w in words if w not in (*WORDS, *SUPERFLUOUS) or w == "n"] or words
    moves = 10.0 * bool(np.ptp(values) > 0.0)
    rate = (
        min(median_sampling_rate(signal.t), 50.0) / 100.0
    )  # the faster of two equal signals is preferred
    for place, match in (
        ("latitude", ("lat", "latitude")),
        ("longitude", ("lon", "lng", "long", "longitude")),
    ):
        if last[-1] in match and not tokens & NOT_MEASURED and moves:
            return _degrees(
                name, signal, place, tokens, moves + rate + 10.0 * bool(tokens & SATELLITES)
            )
    effort = effort_by_unit(signal, tokens, log) or effort_of_words(words, tokens)
    if effort and not _is_load(tokens, body):
        return Classification(name, signal, effort, "", moves + rate, "", tokens)
    kind = drive_kind(signal, tokens)
    if kind is None and signal.source and side_from_tokens(tokens):
        kind = drive_kind(signal, tokens | frozenset(tokenize_name(Path(signal.source).stem)))
    if kind is None and is_direction_order(name, tokens, log):
        word, why = unit_word(name, signal), ""
        if not (signal.unit or word) and 2.0 * np.pi < float(np.max(np.abs(values))) <= FULL_CIRCLE:
            word, why = "deg", "degrees by its range"
        return Classification(name, signal, "command", word, moves + rate, why, tokens | {"steer"})
    called = names_channel(name, body.channels)
    if name in body.channels or is_command(name) or called or _is_load(tokens, body):
        kind = "command"
    if kind:
        word, why = unit_word(name, signal), ""
        if (
            not (signal.unit or word)
            and tokens & ANGLES
            and MAX_RUDDER < float(np.max(np.abs(values))) <= most_degrees(tokens)
        ):
            word, why = "deg", "degrees by its range"
        return Classification(name, signal, kind, word, moves + rate, why, tokens)
    column: str | None = name
    if name not in COLUMNS:
        column = column_of_single_axis(last, body.dof)
        column = (
            column or column_of_numbered(name, tokens, log) or column_of_motion(last, tokens, log)
        )
    if column is None or tokens & NOT_MEASURED:
        return None
    if column == "psi_rad" and may_be_course(name):
        moves -= 1.0  # another heading is more probable
    word, why = unit_of_angle(column, signal, tokens, unit_word(name, signal))
    if body.turns_over and column in ("phi_rad", "p_radps") and why:
        word = unit_of_tumbling(column, signal.t, signal.values)
        why = "degrees by its motion" if word else "radians by its motion"
    if column != name and column == column_of_single_axis(last, body.dof):
        why = "; ".join(filter(None, (WHY, why)))
    own = (
        100.0 * (column == name)
        + 3.0 * (words[0] == "att")
        + 2.0 * bool(tokens & {"attitude", "imu", "odom"})
    )
    return Classification(name, signal, column, word, moves + rate + own, why, tokens)


def _with_unit_of_sensor(found: Sequence[Classification]) -> list[Classification]:
    """Classified signals, in which angles of one sensor have one unit.

    The range of a heading in degrees shows its unit, the range of roll and pitch seldom does.
    """
    in_degrees = set()
    for g in found:
        if g.column.endswith("_rad") and g.column in COLUMNS and g.word == "deg":
            in_degrees.add((_sensor(g.name), g.column[-4:]))
    result = []
    for g in found:
        if g.why == BY_RANGE and (_sensor(g.name), g.column[-4:]) in in_degrees:
            g = replace(g, word="deg", why="degrees as the heading of this sensor")
        result.append(g)
    return result


def _sensor(name: str) -> str:
    """Name of a signal without the word or number that names its axis."""
    words = re.split(r"(?<=[a-z])(?=[A-Z])|[_.\[\] ]+", name)
    kept = [w for w in words if w and not w.isdigit() and w.lower() not in POSE_WORDS]
    return "_".join(kept).lower()


def _is_load(tokens: frozenset[str], body: Body) -> bool:
    """Whether a signal has the same word for a load as a channel of the vessel, such as torque."""
    return any(is_load_of_channel(tokens, tokenize_name(channel)) for channel in body.channels)


def _degrees(
    name: str, signal: Signal, column: str, tokens: frozenset[str], score: float
) -> Classification | None:
    """Classification of a latitude or longitude, with its unit by name and range."""
    largest = float(np.nanmax(np.abs(signal.values)))
    if signal.unit == "rad" or "rad" in tokens:
        return Classification(name, signal, column, "", score, "", tokens)
    limit = 360.0
    if column == "latitude":
        limit = 90.0
    if largest <= limit:
        return Classification(name, signal, column, "deg", score, "", tokens)
    if LEAST_SCALED < largest <= limit * 1e7:
        return Classification(
            name, signal, column, "deg * 1e-7", score, "in 1e-7 degrees by its range", tokens
        )
    return None
