"""Names of signals of the drives: commands, measured states, sticks, forces that were asked for."""

from collections.abc import Sequence

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_words import (
    LETTERS,
    ORDERED,
    SENSED,
    SIDES,
    SPEEDS,
    WORDS,
    side_from_tokens,
    tokenize_name,
)

OUTPUTS = set(
    "rcou output outputs actuator actuators servo cmd command commanded thrust thruster "
    "thrusters throttle rudder "
    "steer steering motor motors pwm nozzle azimuth azi prop "
    "propeller rpm rps shaft esc helm delta jet wheel tiller".split()
)
# words of angles that are no directions of a drive
NO_DRIVE = set(
    "heading hdg psi course compass bearing track cog wind wave current camera gimbal pan tilt "
    "roll pitch yaw phi theta heel trim north east".split()
)
THRUSTS = set("throttle thrust rpm rps power".split())
STICKS = set("rcin joy stick joystick manual pilot".split())
PULSE = (800.0, 2200.0)  # [us] range of the pulses of all servos and motor controllers
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
# Words of the forces and moments that a controller asks for
EFFORTS = set("tau force forces moment torque wrench effort".split())
# Last word of such a name -> kind of the signal
EFFORT_AXES = {
    **dict.fromkeys(("x", "u", "surge"), "effort_x"),
    **dict.fromkeys(("y", "v", "sway"), "effort_y"),
    **dict.fromkeys(("n", "r", "yaw", "psi"), "effort_n"),
}
MOMENT_WORDS = {"moment", "torque"}
# Kind of a force or moment without an axis -> its unit, and words one of which its name has
EFFORTS_BY_UNIT = {
    "effort_x": ("N", {"force", "thrust"}),
    "effort_n": ("Nm", MOMENT_WORDS),
}
NEWTON_METRES = {"N m", "N*m", "N·m", "N.m", "Nm"}
# Words of the force or moment of a part of the vessel
OF_A_PART = set("shaft motor propeller prop engine rudder x y z roll pitch sway surge".split())


def drive_kind(signal: Signal, tokens: frozenset[str]) -> str | None:
    """Return "stick", "command" or "actual" for a signal of the drives, None for another.

    Args:
        signal: The signal.
        tokens: Words of its name.
    """
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


def is_direction_order(name: str, tokens: frozenset[str], log: Log) -> bool:
    """Return whether a signal orders an angle next to a thrust, in a stream of a drive.

    Args:
        name: Name of the signal.
        tokens: Words of its name.
        log: The log.
    """
    if "angle" not in tokens or not tokens & ORDERED or tokens & (OTHER | NO_DRIVE):
        return False
    stream = name.rpartition(".")[0]
    for other in log.signals:
        if stream and other != name and other.rpartition(".")[0] == stream:
            if frozenset(tokenize_name(other)) & THRUSTS:
                return True
    return False


def names_channel(name: str, channels: Sequence[str]) -> bool:
    """Whether a name is that of a command of the vessel without its unit, such as `fan_a1`.

    Args:
        name: Name of a signal.
        channels: Names of the vessel's commands, which end in a unit.
    """
    return any(channel.rpartition("_")[0] == name for channel in channels)


def effort_of_name(name: str) -> str:
    """Return the kind of a force or moment that was asked for, by its name; "" for another signal.

    Args:
        name: Name of the signal, such as "tau_N".

    Returns:
        "effort_x", "effort_y" or "effort_n".
    """
    words = tokenize_name(name)
    return effort_of_words(words, frozenset(words)) or ""


def effort_of_words(words: Sequence[str], tokens: frozenset[str]) -> str | None:
    """Return the kind of a force or moment that was asked for; None for another signal.

    Args:
        words: Words of the name, in their order.
        tokens: The same words.
    """
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


def effort_by_unit(signal: Signal, tokens: frozenset[str], log: Log) -> str | None:
    """Return the kind of a force or moment without an axis in its name; None for another signal.

    The words and the units show it: the log has one order in N and one in Nm.

    Args:
        signal: The signal.
        tokens: Words of its name.
        log: The log.

    Returns:
        "effort_x" or "effort_n".
    """
    kind = _effort_with_unit(signal, tokens)
    if not kind:
        return None
    found = []
    for name, other in log.signals.items():
        found.append(_effort_with_unit(other, frozenset(tokenize_name(name))))
    are_a_pair = all(found.count(one) == 1 for one in EFFORTS_BY_UNIT)
    return kind if are_a_pair else None


def _effort_with_unit(signal: Signal, tokens: frozenset[str]) -> str:
    """The kind of an order by its unit and a word for a force or moment; "" for another signal."""
    unit = signal.unit.strip()
    if unit in NEWTON_METRES:
        unit = "Nm"
    if not tokens & ORDERED or tokens & (SENSED | OF_A_PART) or side_from_tokens(tokens):
        return ""
    for kind, (own, words) in EFFORTS_BY_UNIT.items():
        if unit == own and tokens & words:
            return kind
    return ""


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
