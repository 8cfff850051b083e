"""Actions of a learner: thrusts and angles of the drives of a vessel.

The actions follow from the channels of a vessel and the roles in which its effects use them. A
channel that only adds to a raw command gets no action. Drives that mirror each other get common and
differential actions.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, starmap
from typing import Literal, NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel

Use = Literal["manoeuvring", "underway"]
SIDES = (-1, 1)  # port, starboard
DIFFERENTIAL = ("turn", "inward")
STARBOARD = "the bow to starboard"


@dataclass(frozen=True)
class DriveChannel:
    """Command channel of a vessel that sets the thrust or the angle of one drive."""

    channel: str
    role: str  # in which an effect uses the actuator
    turning: bool  # whether it is an angle
    side: int  # -1 port, +1 starboard, 0 on the centre line
    sense: float  # 1 if a positive angle turns the bow to starboard when going ahead, else -1


class Action(NamedTuple):
    """One action of a reinforcement learning environment, as a combination of drive commands.

    Its `shares` are the weights with which it acts on the command channels.
    """

    name: str
    words: str
    shares: dict[str, float]


@dataclass(frozen=True)
class Controls:
    """Actions of a learning environment, from -1 to 1, and their conversion to vessel commands.

    The value of a command channel is the weighted sum of the actions (n, A), limited to -1 and 1; 0
    is its neutral position, 1 and -1 are the ends of its range.
    """

    names: tuple[str, ...]
    words: tuple[str, ...]
    pattern: Array  # (A, C) share of each channel per action
    neutral: Array  # (C,)
    up: Array  # (C,) from neutral to the upper end
    down: Array  # (C,) from the lower end to neutral
    ahead: Array  # (A,) the action of full thrust straight ahead

    def commands(self, actions: Array) -> Array:
        """Convert a learner's actions to commands (n, C), in the order of the vessel's channels.

        Args:
            actions: Actions (n, A) from -1 to 1.
        """
        share = np.minimum(np.maximum(actions @ self.pattern, -1.0), 1.0)
        ahead = np.maximum(share, 0.0)
        return np.asarray(self.neutral + ahead * self.up + (share - ahead) * self.down, dtype=float)


def make_controls(vessel: Vessel, use: Use) -> Controls:
    """Define the actions by which a learner drives a vessel through its thrusters and rudders.

    A mirrored pair of thrusters has an action `thrust` for both. It also has `turn`, port against
    starboard, if the use is manoeuvring or if nothing else turns the vessel. A mirrored pair of
    angles has `inward`, thrusts towards the centre line, when manoeuvring, and `helm`, equal
    angles, underway. A drive without a mirror image has its own action.

    Args:
        vessel: The vessel.
        use: "manoeuvring" at low speed, or "underway".

    Raises:
        BadInput: The vessel has no drive.
    """
    channels = drive_channels(vessel)
    if not channels:
        raise BadInput(f"{vessel.name} has no drive that a command moves")
    pairs = list(_mirrored_pairs(channels))
    paired = set(chain(*pairs))
    steered = any(drive.turning for drive in channels)
    actions: list[Action] = []
    for port, starboard in pairs:
        actions += _pair_actions(port, starboard, use, steered)
    for drive in channels:
        if drive not in paired:
            actions.append(_single_action(drive))
    names = [action.name for action in actions]
    for index, action in enumerate(actions):
        if names.count(action.name) > 1:
            actions[index] = action._replace(name=next(iter(action.shares)))
    return _controls_of_actions(vessel, actions)


def drive_channels(vessel: Vessel) -> list[DriveChannel]:
    """Return the command channels of a vessel's drives: thrusts and angles.

    The channel of an actuator is the actuator's own command, or the raw command that feeds it.

    Args:
        vessel: The vessel.
    """
    channels: list[DriveChannel] = []
    for actuator in vessel.actuators:
        channel = actuator
        for effect in vessel.effects:
            source = vessel.command_for_actuator(effect, actuator)
            if source is not None:
                channel = source
                break
        role = vessel.roles[actuator]
        turning = vessel.unit(actuator) == "rad" and "angle" in role
        sense = 1.0
        if turning:
            sense = _turning_sense(vessel, actuator)
        channels.append(DriveChannel(channel, role, turning, vessel.side(actuator), sense))
    return channels


def _turning_sense(vessel: Vessel, actuator: str) -> float:
    """1 if a positive angle turns the bow to starboard, -1 if it turns it to port."""
    turns = vessel.commands[actuator].turns
    if turns:
        return 1.0 if turns == "starboard" else -1.0
    for effect in vessel.effects:
        if actuator in vessel.specified_inputs(effect).values():
            astern_of_origin = float(getattr(effect, "x", 1.0)) < 0.0
            return -1.0 if astern_of_origin else 1.0
    return 1.0


def _mirrored_pairs(
    channels: Sequence[DriveChannel],
) -> Iterator[tuple[DriveChannel, DriveChannel]]:
    """Port and starboard drive of each role that has exactly one on each side."""
    per_side: dict[str, dict[int, list[DriveChannel]]] = {}
    for drive in channels:
        sides = per_side.setdefault(drive.role, {})
        sides.setdefault(drive.side, []).append(drive)
    for sides in per_side.values():
        port, starboard = (sides.get(side, []) for side in SIDES)
        if len(port) == 1 and len(starboard) == 1:
            yield port[0], starboard[0]


def _pair_actions(
    port: DriveChannel, starboard: DriveChannel, use: Use, steered: bool
) -> Iterator[Action]:
    both = (port.channel, starboard.channel)
    opposite = {port.channel: 1.0, starboard.channel: -1.0}
    if port.turning and use == "manoeuvring":
        yield Action("inward", "both drives push towards the middle line", opposite)
    elif port.turning:
        yield Action("helm", f"both drives turn {STARBOARD}", dict.fromkeys(both, port.sense))
    else:
        yield Action(port.role, "both drives ahead", dict.fromkeys(both, 1.0))
        if use == "manoeuvring" or not steered:
            yield Action("turn", "port ahead, starboard astern", opposite)


def _single_action(drive: DriveChannel) -> Action:
    shares = {drive.channel: drive.sense}
    if drive.turning:
        return Action("helm", f"{drive.channel}, turning {STARBOARD}", shares)
    return Action(drive.role, drive.channel, shares)


def _drives_ahead(name: str, words: str, shares: dict[str, float]) -> bool:
    """Whether an action is part of full thrust straight ahead."""
    return name not in DIFFERENTIAL and not words.endswith(STARBOARD)


def _controls_of_actions(vessel: Vessel, actions: Sequence[Action]) -> Controls:
    channels = list(vessel.commands)
    pattern = np.zeros((len(actions), len(channels)))
    for row, action in zip(pattern, actions, strict=True):
        for channel, share in action.shares.items():
            row[channels.index(channel)] = share
    ranges = [(c.low, c.neutral, c.high) for c in vessel.commands.values()]
    low, neutral, high = np.array(ranges, dtype=float).T
    names, words, _ = zip(*actions, strict=True)
    ahead = np.array(list(starmap(_drives_ahead, actions)), dtype=float)
    return Controls(names, words, pattern, neutral, high - neutral, neutral - low, ahead)
