"""What each signal of a log probably is, by its name, unit and range: general rules, which know no boat and no log."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi

import numpy as np

from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.log import Log, Signal, rate_of
from boatsim.recordings.table import is_command

FEWEST = 20  # samples
WORDS = {  # units as formats spell them -> as expressions do; "" is the SI unit itself
    "deg": "deg",
    "degree": "deg",
    "degrees": "deg",
    "°": "deg",
    "rad": "",
    "radian": "",
    "radians": "",
    "m": "",
    "metre": "",
    "meter": "",
    "metres": "",
    "meters": "",
    "mm": "mm",
    "cm": "cm",
    "km": "km",
    "ft": "ft",
    "deg/s": "degps",
    "degps": "degps",
    "°/s": "degps",
    "dps": "degps",
    "deg/min": "degpmin",
    "rad/s": "",
    "radps": "",
    "m/s": "",
    "mps": "",
    "kn": "kn",
    "kt": "kn",
    "kts": "kn",
    "knots": "kn",
    "km/h": "kmh",
    "kmh": "kmh",
    "kph": "kmh",
    "%": "percent",
    "percent": "percent",
    "pct": "percent",
    "rpm": "rpm",
    "1/min": "rpm",
    "r/min": "rpm",
    "n": "",
    "us": "us",
    "µs": "us",
}
NOT_MEASURED = set(  # what is wanted, off, or about a signal
    "des desired target setpoint sp ref reference cmd command commanded error err innov innovation bias cov covariance "
    "var variance std sd accuracy reset resets delta test ratio valid status flags timeout home origin".split()
)
PLACES = set("pos position local pose odom odometry location".split())
MOTIONS = set(
    "velocity vel twist linear angular speed acc accel acceleration mag orientation quat force torque".split()
)
SATELLITES = set("gps gnss fix navsat rmc gga gll".split())
OUTPUTS = set(
    "rcou output outputs actuator actuators servo cmd command commanded thrust thruster thrusters throttle rudder "
    "steer steering motor motors pwm nozzle azimuth prop propeller rpm rps shaft esc helm delta jet".split()
)
SENSED = set("actual measured feedback fb telemetry esc state rsa sensed".split())
STICKS = set("rcin joy stick joystick manual pilot".split())
HELM = set("rudder steer steering nozzle azimuth helm delta jet angle pos".split())
SIDES = {
    "port": "port",
    "left": "port",
    "ps": "port",
    "portside": "port",
    "starboard": "starboard",
    "stbd": "starboard",
    "right": "starboard",
    "sb": "starboard",
}
LETTERS = {"l": "port", "p": "port", "r": "starboard", "s": "starboard"}  # sides of drives
PULSE = (800.0, 2200.0)  # [us] between which the pulses of all servos and motor controllers lie
TURNS = {
    "r_radps": ("z", "yaw"),
    "q_radps": ("y", "pitch"),
    "p_radps": ("x", "roll"),
}  # about which axis
SPEEDS = {"rate", "speed", "velocity", "vel"}
BODY = {"odom", "odometry", "body", "base"}  # frames of a velocity in which x is forward
SUPERFLUOUS = set(
    "data value raw filtered est estimate estimated meas measured".split()
)  # ends of names
OTHER = set(
    "alt roll pitch yaw lat lon error err curr current volt voltage temp temperature vel power".split()
)
NUMBERED = {
    "n",
    "shaft",
    *SIDES,
    *map(str, range(10)),
    *WORDS,
}  # what else a shaft speed's name has in it
ANGLES = set("rudder steer steering nozzle azimuth helm delta".split())
STEEPEST = 1.6  # [rad] beyond it an angle of a rudder is in degrees
COLUMNS = (*POSE, *RATES)


@dataclass(frozen=True)
class Guess:
    """One signal taken for one column; `word` brings it to SI."""

    name: str
    signal: Signal
    column: str  # of ours, or latitude, longitude, command, actual, stick
    word: str  # unit of an expression, "" for none
    score: float  # the highest is proposed
    why: str = ""  # what was taken for granted
    tokens: frozenset[str] = field(default_factory=frozenset)


def tokens_of(name: str) -> list[str]:
    """Words of a signal's name, lower case, numbers apart: ATT.DesYaw -> att, des, yaw; motor1 -> motor, 1."""
    parted = re.sub(
        r"(?<=[a-z])(?=[A-Z])|(?<=[A-Za-z])(?=\d)|(?<=\d)(?=[A-Za-z])", " ", name
    ).lower()
    parted = re.sub(
        r"\b(rad|deg|m)[_ ]?(?:/|p|per_?)?[_ ]?s(?:ec)?\b", r"\1/s", parted.replace("_", " ")
    )
    split = re.split(r"[^a-z0-9%°/]+", parted)
    return [w for t in split for w in ([t] if t in WORDS else t.split("/")) if w]


def guesses(log: Log, channels: Sequence[str] = ()) -> list[Guess]:
    """What every signal is that is anything, likeliest first; `channels` are names of the vessel's commands."""
    found = [
        g for name, s in log.signals.items() if (g := guess(name, s, log, channels)) is not None
    ]
    return sorted(found, key=lambda g: -g.score)


def guess(name: str, signal: Signal, log: Log, channels: Sequence[str] = ()) -> Guess | None:
    """What a signal is, if its name, unit and range say so."""
    values = signal.values[np.isfinite(signal.values)]
    if len(values) < FEWEST:
        return None
    words = tokens_of(name) or [""]  # a name need not have a word
    tokens = frozenset(words)
    last = [w for w in words if w not in (*WORDS, *SUPERFLUOUS) or w == "n"] or words
    moves = 10.0 if float(np.ptp(values)) > 0.0 else 0.0
    rate = min(rate_of(signal.t), 50.0) / 100.0  # of two alike the quicker
    for place, match in (
        ("latitude", ("lat", "latitude")),
        ("longitude", ("lon", "lng", "long", "longitude")),
    ):
        if last[-1] in match and not tokens & NOT_MEASURED and moves:
            return _degrees(
                name, signal, place, tokens, moves + rate + 10.0 * bool(tokens & SATELLITES)
            )
    if kind := "command" if name in channels or is_command(name) else _drives(signal, tokens):
        word, why = _word(name, signal), ""
        if (
            not (signal.unit or word)
            and tokens & ANGLES
            and STEEPEST < float(np.max(np.abs(values))) <= 90.0
        ):
            word, why = "deg", "degrees by its range"
        return Guess(name, signal, kind, word, moves + rate, why, tokens)
    column = name if name in COLUMNS else _motion(last, tokens, log)
    if column is None or tokens & NOT_MEASURED:
        return None
    word, why = _angle(column, signal, tokens, _word(name, signal))
    own = (
        100.0 * (column == name)
        + 3.0 * (words[0] == "att")
        + 2.0 * bool(tokens & {"attitude", "imu", "odom"})
    )
    return Guess(name, signal, column, word, moves + rate + own, why, tokens)


def _angle(column: str, signal: Signal, tokens: frozenset[str], word: str) -> tuple[str, str]:
    """Unit of an angle or its rate, by its range where nothing says it."""
    if (
        not column.endswith(("_rad", "_radps"))
        or signal.unit
        or word
        or tokens & {"rad", "radps", "rad/s"}
    ):
        return word, ""
    angle = column.endswith("_rad")
    if float(np.nanmax(np.abs(signal.values))) > (2.0 * pi + 0.3 if angle else pi):
        return ("deg" if angle else "degps"), "degrees by its range"
    return word, "radians by its range"


def _word(name: str, signal: Signal) -> str:
    """The unit as a word of expressions, by the format or else by the name."""
    if signal.unit:
        return WORDS.get(signal.unit.lower(), "")
    words = tokens_of(name) or [""]
    return "rpm" if "rpm" in words else WORDS.get(words[-1], "")


def _degrees(
    name: str, signal: Signal, column: str, tokens: frozenset[str], score: float
) -> Guess | None:
    """Latitudes and longitudes are degrees, or whole numbers of 1e-7 degrees, or radians, by unit and range."""
    largest = float(np.nanmax(np.abs(signal.values)))
    if signal.unit == "rad" or "rad" in tokens:
        return Guess(name, signal, column, "", score, "", tokens)
    if largest <= (90.0 if column == "latitude" else 360.0):
        return Guess(name, signal, column, "deg", score, "", tokens)
    if largest <= (0.9e9 if column == "latitude" else 3.6e9):
        return Guess(
            name, signal, column, "deg * 1e-7", score, "in 1e-7 degrees by its range", tokens
        )
    return None


def _drives(signal: Signal, tokens: frozenset[str]) -> str | None:
    """Whether a signal is the pilot's stick, what is sent to a drive, or what a drive is measured to do."""
    said = frozenset(tokens_of(signal.about))
    if tokens & STICKS or {"rc", "in"} <= tokens or {"rc", "input"} <= tokens or "stick" in said:
        return "stick"
    driven = (
        tokens & OUTPUTS
        or said
        or {"rc", "out"} <= tokens
        or "n" in tokens
        and not tokens - NUMBERED
    )
    if not driven or tokens & OTHER:
        return None
    return (
        "actual" if tokens & SENSED and not tokens & {"cmd", "command", "commanded"} else "command"
    )


def _motion(last: list[str], tokens: frozenset[str], log: Log) -> str | None:
    """The pose or rate that a name speaks of."""
    end = last[-1]
    if found := _turn(end, tokens):
        return found
    if end in ("yaw", "heading", "hdg", "psi", "compass"):
        return "psi_rad"
    if end in ("roll", "phi", "heel", "pitch", "theta", "trim"):
        return "phi_rad" if end in ("roll", "phi", "heel") else "theta_rad"
    if end in ("north", "northing", "pn"):
        return "x_m"
    if end in ("east", "easting", "pe"):
        return "y_m"
    if (
        end in ("x", "y")
        and not tokens & MOTIONS
        and (tokens & (PLACES | SATELLITES) or len(last) == 1)
    ):
        return {"x": "x_m", "y": "y_m"}[end]
    if end in ("x", "y") and {"twist", "linear"} <= tokens and tokens & BODY and log.frame == "ENU":
        return {"x": "u_mps", "y": "v_mps"}[end]
    if end in ("surge", "sway") or tokens & {"surge", "sway"} and tokens & SPEEDS:
        return "u_mps" if "surge" in tokens else "v_mps"
    return {"u": "u_mps", "v": "v_mps"}.get(end) if len(last) == 1 else None


def _turn(end: str, tokens: frozenset[str]) -> str | None:
    """The rate of turning that a name speaks of."""
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
        or {"turn", "rate"} <= tokens
        or end == "r"
        and not tokens - {"r"} - set(WORDS)
    )
    return "r_radps" if rates else None


def side_of(tokens: frozenset[str]) -> str:
    """port, starboard or "" by the words of a name; single letters where there is no word."""
    found = next((SIDES[t] for t in sorted(tokens) if t in SIDES), "")
    return found or next((LETTERS[t] for t in sorted(tokens) if t in LETTERS), "")
