"""Classification of the signals of a log by name, unit and range, with general rules."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import pi
from pathlib import Path

import numpy as np

from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.foreign_words import UNKNOWN as LOST_LETTER
from boatsim.recordings.importing.foreign_words import (
    english_unit,
    is_also_course,
    plain_name,
    translate_words,
)
from boatsim.recordings.importing.log import Log, Signal, median_sampling_rate
from boatsim.recordings.importing.single_axis import (
    WHY,
    column_of_single_axis,
    is_load_of_channel,
    unit_of_tumbling,
)
from boatsim.recordings.table import is_command

MIN_SAMPLES = 20
BRACKETED = re.compile(r"[\[(]([^\])]*)[\])]\s*$")  # Kurs [°]
WORDS = {  # unit as formats write it -> unit in expressions; "" is the SI unit
    **dict.fromkeys(("rad", "radian", "radians", "rad/s", "radps"), ""),
    **dict.fromkeys(("m", "metre", "meter", "metres", "meters", "m/s", "mps", "n"), ""),
    **dict.fromkeys(("deg", "degree", "degrees", "°"), "deg"),
    **dict.fromkeys(("deg/s", "degps", "°/s", "dps"), "degps"),
    **dict.fromkeys(("kn", "kt", "kts", "knots"), "kn"),
    **dict.fromkeys(("km/h", "kmh", "kph"), "kmh"),
    **dict.fromkeys(("%", "percent", "pct"), "percent"),
    **dict.fromkeys(("rpm", "1/min", "r/min"), "rpm"),
    **dict.fromkeys(("us", "µs"), "us"),
    "deg/min": "degpmin",
    "mm": "mm",
    "cdeg": "deg * 0.01",
    "cm": "cm",
    "km": "km",
    "ft": "ft",
}
NOT_MEASURED = set(  # words of set points, errors and properties of signals
    "des desired target setpoint sp ref reference cmd command commanded error err innov "
    "innovation bias cov covariance "
    "var variance std sd accuracy reset resets delta test ratio "
    "valid status flags timeout home origin datum previous prev old next goal waypoint observer "
    "predicted simulated model".split()
)
PLACES = set("pos position local pose odom odometry location".split())
MOTIONS = set(
    "velocity vel twist linear angular speed acc accel "
    "acceleration mag orientation quat force torque".split()
)
SATELLITES = set("gps gnss fix navsat rmc gga gll".split())
OUTPUTS = set(
    "rcou output outputs actuator actuators servo cmd command commanded thrust thruster "
    "thrusters throttle rudder "
    "steer steering motor motors pwm nozzle azimuth azi prop "
    "propeller rpm rps shaft esc helm delta jet wheel tiller".split()
)
ORDERED = set("reference ref setpoint sp desired des cmd command commanded order ordered".split())
# words of angles that are no directions of a drive
NO_DRIVE = set(
    "heading hdg psi course compass bearing track cog wind wave current camera gimbal pan tilt "
    "roll pitch yaw phi theta heel trim north east".split()
)
THRUSTS = set("throttle thrust rpm rps power".split())
SENSED = set("actual measured feedback fb telemetry esc state rsa sensed".split())
STICKS = set("rcin joy stick joystick manual pilot".split())
HELM = set("rudder steer steering nozzle azimuth azi helm delta jet angle pos wheel tiller".split())
SIDES = {
    **dict.fromkeys(("port", "left", "ps", "portside", "bb"), "port"),
    **dict.fromkeys(("starboard", "stbd", "stb", "right", "sb"), "starboard"),
}
LETTERS = {"l": "port", "p": "port", "r": "starboard", "s": "starboard"}  # sides of drives
PULSE = (800.0, 2200.0)  # [us] range of the pulses of all servos and motor controllers
TURNS = {
    "r_radps": ("z", "yaw"),
    "q_radps": ("y", "pitch"),
    "p_radps": ("x", "roll"),
}  # rate -> axis and name of the rotation
POSE_WORDS = {
    **dict.fromkeys(("yaw", "heading", "hdg", "psi", "compass"), "psi_rad"),
    **dict.fromkeys(("roll", "phi", "heel"), "phi_rad"),
    **dict.fromkeys(("pitch", "theta", "trim"), "theta_rad"),
    **dict.fromkeys(("north", "northing", "pn"), "x_m"),
    **dict.fromkeys(("east", "easting", "pe"), "y_m"),
}  # last word of a name -> column
# words in the name of a signal whose positive sense is the opposite of that of recordings
TO_PORT = {"left", "port"}
COUNTERCLOCKWISE = {"ccw", "counterclockwise", "anticlockwise"}
FROM_EAST = {"enu"}  # x east, y north, angles counterclockwise from east
CLOCKWISE = {"ned", "cw", "clockwise", "compass"}
FRAMES = FROM_EAST | {"ned"}
DISPLACEMENTS = {"surge": "x_m", "sway": "y_m", "heave": "z_m"}  # of a body on a rig
LENGTHS = {"m", "mm", "cm"}
SPEEDS = {"rate", "speed", "velocity", "vel"}
BODY = {"odom", "odometry", "body", "base"}  # frames with x forward
SUPERFLUOUS = set(
    "data value raw filtered est estimate estimated meas measured".split()
)  # words at the end of names without meaning here
OTHER = set(
    "alt roll pitch yaw lat lon error err curr current volt "
    "voltage temp temperature vel power".split()
)
NUMBERED = {
    "n",
    "shaft",
    *SIDES,
    *map(str, range(10)),
    *WORDS,
}  # other words in the name of a shaft speed
ANGLES = set("rudder steer steering nozzle azimuth azi helm delta wheel tiller".split())
MAX_RUDDER = 1.6  # [rad] a larger rudder angle is in degrees
LEAST_SCALED = 1e5  # [1e-7 deg] 0.01 degrees; smaller numbers are of no place in this unit
FULL_CIRCLE = 360.0  # [deg] largest order to a thruster that turns around
MANY_TURNS = 10.0 * FULL_CIRCLE  # [deg] no heading in whole degrees is counted on as far
MAX_WHEEL = 1080.0  # [deg] three turns from the middle; a larger number is no angle of a wheel
COLUMNS = (*POSE, *RATES)
# Words of three numbered signals, such as orientation_1 to _3: about x, y and z
ROTATIONS = set("orientation attitude euler rpy angles".split())
TURNING = set("rotational rotation angular gyro gyr omega rates".split())
BY_NUMBER = {
    "angles": ("phi_rad", "theta_rad", "psi_rad"),
    "rates": ("p_radps", "q_radps", "r_radps"),
}
# Words of the forces and moments that a controller asks for
EFFORTS = set("tau force forces moment torque wrench effort".split())
# Last word of such a name -> kind of the signal
EFFORT_AXES = {
    **dict.fromkeys(("x", "u", "surge"), "effort_x"),
    **dict.fromkeys(("y", "v", "sway"), "effort_y"),
    **dict.fromkeys(("n", "r", "yaw", "psi"), "effort_n"),
}
BY_RANGE = "radians by its range"
MOMENT_WORDS = {"moment", "torque"}


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


def tokenize_name(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case: ATT.DesYaw1 -> att, des, yaw, 1.

    Words of other European languages are translated: Ruderwinkel -> rudder, angle.
    """
    words: list[str] = []
    for word in translate_words(_words_as_written(name)):
        words += filter(None, word.split(LOST_LETTER))
    return words


def _words_as_written(name: str) -> list[str]:
    """The words and numbers of a name in lower case, without accents, not translated."""
    if not name.isascii() and (found := BRACKETED.search(name)):
        name = f"{name[: found.start()]} {english_unit(found[1]) or found[1]}"
    parted = re.sub(
        r"(?<=[a-z])(?=[A-Z])|(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", plain_name(name)
    ).lower()
    parted = re.sub(
        r"\b(rad|deg|grad|m)[_ ]?(?:/|p|per_?)?[_ ]?s(?:ec)?\b", r"\1/s", parted.replace("_", " ")
    )
    words: list[str] = []
    for token in re.split(rf"[^a-z0-9%°/{LOST_LETTER}]+", parted):
        unit = english_unit(token)
        if token in WORDS:
            words.append(token)
        elif "/" in token and unit:
            words.append(unit)
        else:
            words += token.split("/")
    return list(filter(None, words))


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
    effort = _effort(words, tokens)
    if effort and not _is_load(tokens, body):
        return Classification(name, signal, effort, "", moves + rate, "", tokens)
    kind = _drive_kind(signal, tokens)
    if kind is None and signal.source and side_from_tokens(tokens):
        kind = _drive_kind(signal, tokens | frozenset(tokenize_name(Path(signal.source).stem)))
    if kind is None and _is_direction_order(name, tokens, log):
        word, why = _unit_word(name, signal), ""
        if not (signal.unit or word) and 2.0 * np.pi < float(np.max(np.abs(values))) <= FULL_CIRCLE:
            word, why = "deg", "degrees by its range"
        return Classification(name, signal, "command", word, moves + rate, why, tokens | {"steer"})
    called = names_channel(name, body.channels)
    if name in body.channels or is_command(name) or called or _is_load(tokens, body):
        kind = "command"
    if kind:
        word, why = _unit_word(name, signal), ""
        if (
            not (signal.unit or word)
            and tokens & ANGLES
            and MAX_RUDDER < float(np.max(np.abs(values))) <= _most_degrees(tokens)
        ):
            word, why = "deg", "degrees by its range"
        return Classification(name, signal, kind, word, moves + rate, why, tokens)
    column: str | None = name
    if name not in COLUMNS:
        column = column_of_single_axis(last, body.dof)
        column = column or _of_numbered(name, tokens, log) or _motion(last, tokens, log)
    if column is None or tokens & NOT_MEASURED:
        return None
    if column == "psi_rad" and may_be_course(name):
        moves -= 1.0  # another heading is more probable
    word, why = _angle(column, signal, tokens, _unit_word(name, signal))
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


def may_be_course(name: str) -> bool:
    """Return whether the word of a name for a heading may also be a course over ground.

    Args:
        name: Name of the signal.
    """
    return is_also_course(_words_as_written(name))


def _is_load(tokens: frozenset[str], body: Body) -> bool:
    """Whether a signal has the same word for a load as a channel of the vessel, such as torque."""
    return any(is_load_of_channel(tokens, tokenize_name(channel)) for channel in body.channels)


def _most_degrees(tokens: frozenset[str]) -> float:
    """The largest number that may be an angle of a rudder, a thruster or a steering wheel [deg]."""
    if tokens & {"wheel", "azimuth", "azi"}:  # these turn around, and may be counted on
        return MAX_WHEEL
    return 90.0


def _angle(column: str, signal: Signal, tokens: frozenset[str], word: str) -> tuple[str, str]:
    """Unit of an angle or its rate, by the range if it is unknown, and the assumption."""
    if (
        not column.endswith(("_rad", "_radps"))
        or signal.unit
        or word
        or tokens & {"rad", "radps", "rad/s"}
    ):
        return word, ""
    unit, largest = "degps", pi
    if column.endswith("_rad"):
        unit, largest = "deg", 2.0 * pi + 0.3
    if float(np.nanmax(np.abs(signal.values))) > largest:
        if column == "psi_rad" and _is_in_hundredths(signal):
            return "deg * 0.01", "hundredths of degrees by its range and whole numbers"
        return unit, "degrees by its range"
    return word, BY_RANGE


def _is_in_hundredths(signal: Signal) -> bool:
    """Whether a heading is in 0.01 degrees: whole numbers up to 36000, far beyond a circle."""
    values = signal.values[np.isfinite(signal.values)]
    is_whole = bool((values == np.round(values)).all())
    return is_whole and values.min() >= 0.0 and MANY_TURNS < values.max() <= 100.0 * FULL_CIRCLE


def has_stated_unit(name: str, signal: Signal) -> bool:
    """Return whether the format or the name of a signal states its unit."""
    words = set(tokenize_name(name))
    return bool(signal.unit or _unit_word(name, signal) or words & {"rad", "radps", "rad/s"})


def _unit_word(name: str, signal: Signal) -> str:
    """The unit as a word of expressions, by the format, else by the name."""
    if signal.unit:
        word = WORDS.get(signal.unit.lower())
        if word is None:
            word = WORDS.get(english_unit(signal.unit), "")
        return word
    words = tokenize_name(name) or [""]
    if "rpm" in words:
        return "rpm"
    return WORDS.get(words[-1], "")


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


def _drive_kind(signal: Signal, tokens: frozenset[str]) -> str | None:
    """The kind of a signal of the drives: "stick", "command" or "actual"; None for another."""
    about = frozenset(tokenize_name(signal.about))
    if tokens & STICKS or {"rc", "in"} <= tokens or {"rc", "input"} <= tokens or "stick" in about:
        return "stick"
    driven = (
        tokens & OUTPUTS
        or about
        or {"rc", "out"} <= tokens
        or "n" in tokens
        and not tokens - NUMBERED
    )
    driven = driven or _is_share_of_a_side(signal, tokens) or _is_force_of_a_side(signal, tokens)
    if not driven or tokens & OTHER or "wheel" in tokens and tokens & SPEEDS:
        return None
    if tokens & SENSED and not tokens & {"cmd", "command", "commanded"}:
        return "actual"
    return "command"


def _is_direction_order(name: str, tokens: frozenset[str], log: Log) -> bool:
    """Whether a signal is the order of an angle next to one of a thrust, in a stream of a drive."""
    if "angle" not in tokens or not tokens & ORDERED or tokens & (OTHER | NO_DRIVE):
        return False
    stream = name.rpartition(".")[0]
    for other in log.signals:
        if stream and other != name and other.rpartition(".")[0] == stream:
            if frozenset(tokenize_name(other)) & THRUSTS:
                return True
    return False


def _is_share_of_a_side(signal: Signal, tokens: frozenset[str]) -> bool:
    """Whether a name has nothing but a side and per cent, as `left_pct`."""
    if not side_from_tokens(tokens) or tokens - NUMBERED - set(LETTERS):
        return False
    units = map(WORDS.get, (signal.unit.lower(), *tokens))
    return "percent" in units


def _is_force_of_a_side(signal: Signal, tokens: frozenset[str]) -> bool:
    """Whether a name has nothing but a side, F or force, and the unit N, as `F_port [N]`."""
    is_force = signal.unit == "N" and bool(side_from_tokens(tokens))
    return is_force and not tokens - {"f", "force"} - NUMBERED - set(LETTERS)


def names_channel(name: str, channels: Sequence[str]) -> bool:
    """Whether a name is that of a command of the vessel without its unit, such as `fan_a1`.

    Args:
        name: Name of a signal.
        channels: Names of the vessel's commands, which end in a unit.
    """
    return any(channel.rpartition("_")[0] == name for channel in channels)


def has_opposite_sense(column: str, tokens: frozenset[str]) -> bool:
    """Whether a name states that the positive sense is to port or counterclockwise.

    Args:
        column: Column of the signal, whose positive sense is to starboard and clockwise.
        tokens: Words of its name.
    """
    if column in ("y_m", "v_mps"):
        return bool(tokens & TO_PORT)
    if column in ("psi_rad", "r_radps"):
        return bool(tokens & (COUNTERCLOCKWISE | FROM_EAST))
    return False


def _of_numbered(name: str, tokens: frozenset[str], log: Log) -> str | None:
    """The angle or rate of one of three signals that differ by a number only; None for another."""
    found = re.fullmatch(r"(.*\D)(\d)([\])]?)", name)
    if not found:
        return None
    there = [n for n in range(4) if f"{found[1]}{n}{found[3]}" in log.signals]
    if there not in ([0, 1, 2], [1, 2, 3]):
        return None
    axis = int(found[2]) - there[0]
    if tokens & TURNING and tokens & (SPEEDS | {"velocities", "rates", "gyro", "gyr", "omega"}):
        return BY_NUMBER["rates"][axis]
    if tokens & ROTATIONS and not tokens & (SPEEDS | {"quaternion", "quat"}):
        return BY_NUMBER["angles"][axis]
    return None


def effort_of_name(name: str) -> str:
    """Return the kind of a force or moment that was asked for, by its name; "" for another signal.

    Args:
        name: Name of the signal, such as "tau_N".

    Returns:
        "effort_x", "effort_y" or "effort_n".
    """
    words = tokenize_name(name)
    return _effort(words, frozenset(words)) or ""


def _effort(words: Sequence[str], tokens: frozenset[str]) -> str | None:
    """The kind of a force or moment that was asked for; None for another signal."""
    if not tokens & EFFORTS or tokens & (SENSED | {"wind", "wave", "current"}):
        return None
    axes = [w for w in words if w in EFFORT_AXES]
    if len(axes) == 0 and tokens & MOMENT_WORDS and words[-1] == "z":
        return "effort_n"
    if not axes:
        return None
    kind = EFFORT_AXES[axes[0]]
    if kind == "effort_x" and tokens & MOMENT_WORDS:
        return None
    return kind


def _motion(last: list[str], tokens: frozenset[str], log: Log) -> str | None:
    """The pose or velocity of a name; None for another."""
    last = [word for word in last if word not in TO_PORT | COUNTERCLOCKWISE | FRAMES] or last
    end = last[-1]
    if found := _angular_rate(end, tokens):
        return found
    if end in POSE_WORDS:
        return POSE_WORDS[end]
    if (
        end in ("x", "y")
        and not tokens & MOTIONS
        and (tokens & (PLACES | SATELLITES) or len(last) == 1)
    ):
        if tokens & FROM_EAST and not log.frame:
            return {"x": "y_m", "y": "x_m"}[end]
        return {"x": "x_m", "y": "y_m"}[end]
    if end in ("x", "y") and {"twist", "linear"} <= tokens and tokens & BODY and log.frame == "ENU":
        return {"x": "u_mps", "y": "v_mps"}[end]
    if end in DISPLACEMENTS and tokens & LENGTHS and not tokens & SPEEDS:
        return DISPLACEMENTS[end]
    if end in ("surge", "sway") or tokens & {"surge", "sway"} and tokens & SPEEDS:
        if "surge" in tokens:
            return "u_mps"
        return "v_mps"
    if len(last) == 1:
        return {"u": "u_mps", "v": "v_mps"}.get(end)
    return None


def _angular_rate(end: str, tokens: frozenset[str]) -> str | None:
    """The angular rate of a name; None for another."""
    for column, (axis, spelt) in TURNS.items():
        number = str("xyz".index(axis))
        by_axis = end == axis or end == number and tokens & {"xyz", "rad"}
        if (
            tokens & {"gyr", "gyro", "angular", "omega"}
            and by_axis
            or end in (f"g{axis}", f"gyr{axis}", f"gyro{axis}")
        ):
            return column
        if tokens & {spelt} and (
            tokens & SPEEDS or tokens & {"rad/s", "deg/s", "dps", "radps", "degps"}
        ):
            return column
        if end in (f"{spelt}rate", f"{spelt}speed"):
            return column
    rates = (
        {"rot", "omega"} & {end}
        or "turn" in tokens
        and tokens & SPEEDS
        or end == "r"
        and not tokens - {"r"} - set(WORDS)
    )
    if rates:
        return "r_radps"
    return None


def side_from_tokens(tokens: frozenset[str]) -> str:
    """Return "port", "starboard" or "" by the words or single letters of a name."""
    for sides in (SIDES, LETTERS):
        for token in sorted(tokens):
            if token in sides:
                return sides[token]
    return ""
