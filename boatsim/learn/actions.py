"""Actions of a learner: thrusts and angles of the drives of a vessel.

The actions follow from the channels of a vessel and the roles in which its effects use them. A
channel that only adds to a raw command gets no action. Drives that mirror each other get common and
differential actions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel

Use = Literal["manoeuvring", "underway"]
SIDES = (-1, 1)  # port, starboard
TURNS = ("turn", "inward")
STARBOARD = "the bow to starboard"


@dataclass(frozen=True)
class Lever:
    """A channel that is commanded."""

    channel: str
    role: str  # in which a law takes what it drives
    turning: bool  # an angle
    side: int  # -1 port, +1 starboard, 0 middle
    sense: float  # +1 or -1: of an angle that turns the bow to starboard while going ahead


@dataclass(frozen=True)
class Controls:
    """Actions (n, A) from -1 to 1 and the commands (n, C) that they are.

    Each channel gets the sum of its actions' shares, within -1 and 1; 0 is its neutral, 1 and -1 the ends of its range.
    """

    names: tuple[str, ...]
    words: tuple[str, ...]
    pattern: Array  # (A, C) share of each channel per action
    neutral: Array  # (C,)
    up: Array  # (C,) to the upper end
    down: Array  # (C,) to the lower one
    ahead: Array  # (A,) the action of full thrust straight ahead

    def commands(self, actions: Array) -> Array:
        """(n, C), in the order of the vessel's commands."""
        share = np.minimum(np.maximum(actions @ self.pattern, -1.0), 1.0)
        ahead = np.maximum(share, 0.0)
        return np.asarray(self.neutral + ahead * self.up + (share - ahead) * self.down, dtype=float)


def controls(vessel: Vessel, use: Use) -> Controls:
    """The actions of a vessel, "manoeuvring" at low speed or "underway". Raises BadInput for one without drives.

    A mirrored pair of drives: `thrust` of both and, when manoeuvring or where nothing else turns the boat, `turn`, port
    against starboard. A mirrored pair of angles: `inward`, the thrusts towards the middle line, when manoeuvring, and
    `helm`, both alike, underway. What has no mirror image is an action of its own.
    """
    found = levers(vessel)
    if not found:
        raise BadInput(f"{vessel.name} has no drive that a command moves")
    pairs = list(_pairs(found))
    single = [lever for lever in found if not any(lever in pair for pair in pairs)]
    steered = any(lever.turning for lever in found)
    rows: list[tuple[str, str, dict[str, float]]] = []
    for port, starboard in pairs:
        rows += _of_pair(port, starboard, use, steered)
    for lever in single:
        share = {lever.channel: lever.sense}
        rows.append(("helm" if lever.turning else lever.role, _said(lever), share))
    names = [name for name, _, _ in rows]
    for i, (_, words, share) in enumerate(rows):
        if names.count(names[i]) > 1:
            rows[i] = (next(iter(share)), words, share)
    return _made(vessel, rows)


def levers(vessel: Vessel) -> list[Lever]:
    """What is commanded: each actuator, or the raw command that feeds it."""
    found: list[Lever] = []
    for actuator in vessel.actuators:
        fed = [
            source
            for e in vessel.effects
            if (source := vessel.feeding_command(e, actuator)) is not None
        ]
        channel = fed[0] if fed else actuator
        turning = vessel.unit(actuator) == "rad" and "angle" in vessel.roles[actuator]
        sense = _sense(vessel, actuator) if turning else 1.0
        found.append(Lever(channel, vessel.roles[actuator], turning, vessel.side(actuator), sense))
    return found


def _sense(vessel: Vessel, actuator: str) -> float:
    """Whether a positive angle turns the bow to starboard (1) or to port (-1)."""
    if turns := vessel.commands[actuator].turns:
        return 1.0 if turns == "starboard" else -1.0
    places = [
        float(getattr(e, "x", 1.0))
        for e in vessel.effects
        if actuator in vessel.specified_bindings(e).values()
    ]
    return -1.0 if places and places[0] < 0.0 else 1.0


def _pairs(found: Sequence[Lever]) -> Iterator[tuple[Lever, Lever]]:
    """Port and starboard drives of the same role, where there is one of each."""
    for role in dict.fromkeys(lever.role for lever in found):
        sides = {
            side: [one for one in found if one.role == role and one.side == side] for side in SIDES
        }
        if all(len(there) == 1 for there in sides.values()):
            yield sides[-1][0], sides[1][0]


def _of_pair(
    port: Lever, starboard: Lever, use: Use, steered: bool
) -> Iterator[tuple[str, str, dict[str, float]]]:
    if port.turning and use == "manoeuvring":
        yield (
            "inward",
            "both drives push towards the middle line",
            {port.channel: 1.0, starboard.channel: -1.0},
        )
    elif port.turning:
        yield (
            "helm",
            f"both drives turn {STARBOARD}",
            dict.fromkeys(_channels(port, starboard), port.sense),
        )
    else:
        yield port.role, "both drives ahead", dict.fromkeys(_channels(port, starboard), 1.0)
        if use == "manoeuvring" or not steered:
            yield (
                "turn",
                "port ahead, starboard astern",
                {port.channel: 1.0, starboard.channel: -1.0},
            )


def _channels(port: Lever, starboard: Lever) -> tuple[str, str]:
    return port.channel, starboard.channel


def _said(lever: Lever) -> str:
    return f"{lever.channel}, turning {STARBOARD}" if lever.turning else lever.channel


def _made(vessel: Vessel, rows: Sequence[tuple[str, str, dict[str, float]]]) -> Controls:
    channels = list(vessel.commands)
    pattern = np.array([[share.get(c, 0.0) for c in channels] for _, _, share in rows])
    low, neutral, high = np.array(
        [(c.low, c.neutral, c.high) for c in vessel.commands.values()], dtype=float
    ).T
    names, words, _ = zip(*rows, strict=True)
    ahead = np.array(
        [float(name not in TURNS and not words.endswith(STARBOARD)) for name, words, _ in rows]
    )
    return Controls(names, words, pattern, neutral, high - neutral, neutral - low, ahead)
