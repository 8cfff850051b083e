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
    "deg": "deg", "degree": "deg", "degrees": "deg", "°": "deg", "rad": "", "radian": "", "radians": "", "m": "",
    "metre": "", "meter": "", "metres": "", "meters": "", "mm": "mm", "cm": "cm", "km": "km", "ft": "ft",
    "deg/s": "degps", "degps": "degps", "°/s": "degps", "dps": "degps", "deg/min": "degpmin", "rad/s": "", "radps": "",
    "m/s": "", "mps": "", "kn": "kn", "kt": "kn", "kts": "kn", "knots": "kn", "km/h": "kmh", "kmh": "kmh",
    "kph": "kmh", "%": "percent", "percent": "percent", "pct": "percent", "rpm": "rpm", "1/min": "rpm", "r/min": "rpm",
    "n": "", "kn_force": "kN", "us": "us", "µs": "us",
}  # fmt: skip
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
HELM = set("rudder steer steering nozzle azimuth helm delta jet angle".split())
SIDES = {
    "port": "port", "left": "port", "ps": "port", "portside": "port", "starboard": "starboard", "stbd": "starboard",
    "right": "starboard", "sb": "starboard",
}  # fmt: skip
PULSE = (800.0, 2200.0)  # [us] between which the pulses of all servos and motor controllers lie
TURNS = {"r_radps": "z", "q_radps": "y", "p_radps": "x"}  # about which axis
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
    """Words of a signal's name, lower case: ATT.DesYaw -> att, des, yaw."""
    parted = re.sub(r"([a-z])([A-Z])", r"\1 \2", name)
    return [t for t in re.split(r"[^A-Za-z0-9%°/]+|(?<=[A-Za-z])/(?=[A-Za-z]{3,})|^/", parted.lower()) if t]


def guesses(log: Log, channels: Sequence[str] = ()) -> list[Guess]:
    """What every signal is that is anything, likeliest first; `channels` are names of the vessel's commands."""
    found = [g for name, s in log.signals.items() if (g := guess(name, s, log, channels)) is not None]
    return sorted(found, key=lambda g: -g.score)


def guess(name: str, signal: Signal, log: Log, channels: Sequence[str] = ()) -> Guess | None:
    """What a signal is, if its name, unit and range say so."""
    values = signal.values[np.isfinite(signal.values)]
    if len(values) < FEWEST:
        return None
    words = [w for token in tokens_of(name) for w in token.split("/") if w]
    tokens = frozenset(words)
    last = [w for w in words if w not in WORDS or w == "n"] or words
    moves = 10.0 if float(np.ptp(values)) > 0.0 else 0.0
    rate = min(rate_of(signal.t), 50.0) / 100.0  # of two alike the quicker
    for place, match in (("latitude", ("lat", "latitude")), ("longitude", ("lon", "lng", "long", "longitude"))):
        if last[-1] in match and not tokens & NOT_MEASURED and moves:
            return _degrees(name, signal, place, tokens, moves + rate + 10.0 * bool(tokens & SATELLITES))
    if kind := "command" if name in channels or is_command(name) else _drives(signal, tokens):
        return Guess(name, signal, kind, _word(name, signal), moves + rate, "", tokens)
    of_ours = name if name in COLUMNS else _motion(last, tokens, log)
    if of_ours is None or tokens & NOT_MEASURED:
        return None
    column, word, why = of_ours, _word(name, signal), ""
    if column.endswith(("_rad", "_radps")) and not (signal.unit or word or tokens & {"rad", "radps"}):
        widest = 2.0 * pi + 0.3 if column.endswith("_rad") else pi
        if float(np.max(np.abs(values))) > widest:
            word, why = ("deg" if column.endswith("_rad") else "degps"), "degrees by its range"
        else:
            why = "radians by its range"
    own = 100.0 * (column == name) + 3.0 * (words[0] == "att") + 2.0 * bool(tokens & {"attitude", "imu", "odom"})
    return Guess(name, signal, column, word, moves + rate + own, why, tokens)


def _word(name: str, signal: Signal) -> str:
    """The unit as a word of expressions, by the format or else by the end of the name."""
    if signal.unit:
        return WORDS.get(signal.unit.lower() if signal.unit != "N" else "n", "")
    last = (tokens_of(name) or [""])[-1]
    return WORDS.get(last, "") if last != "n" else ""


def _degrees(name: str, signal: Signal, column: str, tokens: frozenset[str], score: float) -> Guess | None:
    """Latitudes and longitudes are degrees, or whole numbers of 1e-7 degrees, or radians, by unit and range."""
    largest = float(np.nanmax(np.abs(signal.values)))
    if signal.unit == "rad" or "rad" in tokens:
        return Guess(name, signal, column, "", score, "", tokens)
    if largest <= (90.0 if column == "latitude" else 360.0):
        return Guess(name, signal, column, "deg", score, "", tokens)
    if largest <= (0.9e9 if column == "latitude" else 3.6e9):
        return Guess(name, signal, column, "deg * 1e-7", score, "in 1e-7 degrees by its range", tokens)
    return None


def _drives(signal: Signal, tokens: frozenset[str]) -> str | None:
    """Whether a signal is the pilot's stick, what is sent to a drive, or what a drive is measured to do."""
    said = frozenset(tokens_of(signal.about))
    if tokens & STICKS or {"input", "rc"} <= tokens or "stick" in said:
        return "stick"
    if not (tokens & OUTPUTS or said) or tokens & {
        "alt",
        "roll",
        "pitch",
        "yaw",
        "lat",
        "lon",
        "error",
        "err",
        "curr",
        "volt",
        "temp",
    }:
        return None
    return "actual" if tokens & SENSED and not tokens & {"cmd", "command", "commanded"} else "command"


def _motion(last: list[str], tokens: frozenset[str], log: Log) -> str | None:
    """The pose or rate that a name speaks of."""
    end = last[-1]
    if end in ("yaw", "heading", "hdg", "psi") and not tokens & {"rate", "speed", "velocity"}:
        return "psi_rad"
    if end in ("roll", "phi", "heel", "pitch", "theta", "trim") and not tokens & {"rate", "speed", "velocity"}:
        return "phi_rad" if end in ("roll", "phi", "heel") else "theta_rad"
    for column, axis in TURNS.items():
        turns = {"gyr", "gyro", "angular"} & tokens
        if turns and end in (axis, str("xyz".index(axis))) and (end == axis or "xyz" in tokens):
            return column
        spelt = {"x": "roll", "y": "pitch", "z": "yaw"}[axis]
        if (
            spelt in tokens
            and tokens & {"rate", "speed", "yawspeed", "velocity"}
            or (axis == "z" and end in ("yawspeed", "rot"))
        ):
            return column
    if end in ("north", "northing", "pn"):
        return "x_m"
    if end in ("east", "easting", "pe"):
        return "y_m"
    if end in ("x", "y") and not tokens & MOTIONS and (tokens & PLACES or len(last) == 1):
        return {"x": "x_m", "y": "y_m"}[end]
    if end in ("x", "y") and {"twist", "linear"} <= tokens and log.frame == "ENU":
        return {"x": "u_mps", "y": "v_mps"}[end]
    return "u_mps" if end in ("surge", "u") else "v_mps" if end in ("sway", "v") and "u" not in tokens else None


def side_of(tokens: frozenset[str]) -> str:
    """port, starboard or "" by the words of a name."""
    return next((SIDES[t] for t in sorted(tokens) if t in SIDES), "")
