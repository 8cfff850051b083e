"""Maps sticks to the goals of a controller, or to command channels that it passes on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi, sqrt
from typing import NamedTuple

from boatsim.control.base import Controller, clip, wrap
from boatsim.drive.driver_input import Sticks
from boatsim.errors import BadInput
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import STATE, measured_column_for_goal
from boatsim.physics.vessel import ManoeuvringTable, Vessel
from boatsim.simulate.manoeuvre import (
    approach_speed,
    complete_manoeuvring_table,
    transverse_thrusters,
)

# Defaults for a vessel whose files and controller specify no largest goals.
FROUDE = 0.15  # Froude number of the largest speed: well below hull speed
SWAY_SHARE = 0.2  # largest sway speed as a share of the surge speed
RADIUS = 2.0  # [L] radius of the turn at full speed
LARGEST_YAW_RATE = 0.25 * pi  # [rad/s]
DIGITS = 6  # decimals of a goal, so that a scenario file of many goals stays small
HEADING = "psi_rad"


class StickMapping(NamedTuple):
    """Effect of one stick on one goal of the controller or one command channel.

    Attributes:
        key: Goal or channel.
        stick: Field of `Sticks`.
        low: Value added to the neutral value with the stick at -1.
        high: Value added to the neutral value with the stick at 1.
    """

    key: str
    stick: str
    low: float
    high: float

    def contribution(self, sticks: Sticks) -> float:
        """Return what a stick's deflection adds to the neutral value of its goal or channel.

        Args:
            sticks: Stick deflections.
        """
        deflection: float = getattr(sticks, self.stick)
        if deflection > 0.0:
            return deflection * self.high
        return -deflection * self.low


@dataclass
class StickMappings:
    """Mapping from a driver's sticks to all goals and command channels that they set.

    The dial of a heading sets its rate of change [rad/s].

    Attributes:
        dials: Effects of the sticks.
        neutral: Neutral value of every goal and channel.
        limits: Range of every channel.
    """

    dials: tuple[StickMapping, ...]
    neutral: Mapping[str, float]
    limits: Mapping[str, tuple[float, float]]
    _heading: float | None = field(default=None, init=False)  # [rad] present heading goal

    @property
    def keys(self) -> list[str]:
        """Names of the goals and command channels that the sticks set."""
        return list(self.neutral)

    def goal_from_sticks(self, sticks: Sticks, dt: float, heading: float) -> dict[str, float]:
        """Return the goals and commands that a driver sets by stick deflections.

        Args:
            sticks: Stick deflections.
            dt: Time since the previous goals [s].
            heading: Present heading of the vessel [rad].
        """
        found = dict(self.neutral)
        for dial in self.dials:
            found[dial.key] += dial.contribution(sticks)
        if HEADING in found:
            if self._heading is None:
                self._heading = heading
            self._heading = found[HEADING] = wrap(self._heading + dt * found[HEADING])
        for key, value in found.items():
            low, high = self.limits.get(key, (value, value))
            found[key] = round(clip(value, low, high), DIGITS)
        return found

    def reset_heading(self) -> None:
        """Forget the heading goal, so that the next one starts from the vessel's heading."""
        self._heading = None


def stick_mappings_for(vessel: Vessel, controller: Controller, name: str) -> StickMappings:
    """Return the mapping from sticks to goals and commands for a vessel under a controller.

    Args:
        vessel: The vessel.
        controller: The controller.
        name: Name of the controller, for messages.

    Raises:
        BadInput: The sticks cannot steer the controller.
    """
    goals = type(controller).goals
    if not goals and not type(controller).passes_on:
        raise BadInput(f"controller {name} takes no goals; the sticks cannot steer it")
    if not vessel.commands:
        raise BadInput(f"{vessel.name} has no command channels; it cannot be driven")
    if not goals:
        return _add_channel_ranges(
            vessel, _channel_mappings(vessel, complete_manoeuvring_table(vessel))
        )
    table = _manoeuvring_table(vessel)
    held = [d for d in _channel_mappings(vessel, table) if d.key in goals]
    found = [*_motion_mappings(vessel, table, controller.largest_goals(), goals), *held]
    if not found:
        raise BadInput(
            f"controller {name} takes the goals {', '.join(goals)}; the sticks set speeds, turning "
            "heading or commands"
        )
    return _add_channel_ranges(vessel, found)


def _add_channel_ranges(vessel: Vessel, dials: Sequence[StickMapping]) -> StickMappings:
    """Dials with the neutral values and the ranges of channels."""
    neutral = {}
    limits = {}
    for dial in dials:
        channel = vessel.commands.get(dial.key)
        neutral[dial.key] = 0.0
        if channel:
            neutral[dial.key] = channel.neutral
            limits[dial.key] = (channel.low, channel.high)
    return StickMappings(tuple(dials), neutral, limits)


def _manoeuvring_table(vessel: Vessel) -> ManoeuvringTable:
    """Channels that drive and steer the vessel; incomplete if not all are known."""
    try:
        return complete_manoeuvring_table(vessel)
    except BadInput:
        return vessel.manoeuvring


def _motion_mappings(
    vessel: Vessel, table: ManoeuvringTable, specified: Mapping[str, float], goals: Sequence[str]
) -> list[StickMapping]:
    """Dials of goals that are speeds, turning rates or a heading."""
    axes = {
        s.column: s.axis
        for s in STATE
        if s.axis in Sticks._fields and (s.rate or s.column == HEADING)
    }
    found: list[StickMapping] = []
    for key in goals:
        axis = axes.get(measured_column_for_goal(key) or "")
        if axis is None or axis not in vessel.dof:
            continue
        if key in specified:
            full = specified[key]
            low = -full
        else:
            full = _default_goals(replace(vessel, manoeuvring=table))[axis]
            forward_only = axis == "surge" and not table.astern
            low = 0.0 if forward_only else -full
        found.append(StickMapping(key, axis, low, full))
    return found


def _default_goals(vessel: Vessel) -> dict[str, float]:
    """Largest goals [m/s, rad/s] from the top speed, for a controller that specifies none."""
    try:
        speed = approach_speed(vessel)
    except BadInput:
        speed = FROUDE * sqrt(GRAVITY * vessel.length)
    return {
        "surge": speed,
        "sway": SWAY_SHARE * speed,
        "yaw": min(speed / (RADIUS * vessel.length), LARGEST_YAW_RATE),
    }


def _channel_mappings(vessel: Vessel, table: ManoeuvringTable) -> list[StickMapping]:
    """Dials of the channels for surge, yaw and sway; a full stick gives the end of a range."""
    channels = vessel.commands
    found: list[StickMapping] = []
    for name, ahead in table.ahead.items():
        room, back = (
            _range_towards(vessel, name, ahead),
            table.astern.get(name, channels[name].neutral),
        )
        found.append(StickMapping(name, "surge", _range_towards(vessel, name, back), room))
    for name, per_rad in table.steer.items():
        found.append(StickMapping(name, "yaw", *_ranges_to_both_sides(vessel, name, per_rad)))
    for name, share in transverse_thrusters(vessel).items():
        if name in channels and name not in table.steer:
            found.append(StickMapping(name, "sway", *_ranges_to_both_sides(vessel, name, share)))
    return found


def _ranges_to_both_sides(vessel: Vessel, channel: str, share: float) -> tuple[float, float]:
    """Distances from neutral to the ends of a channel for a full stick to port and to starboard."""
    neutral = vessel.commands[channel].neutral
    return _range_towards(vessel, channel, neutral - share), _range_towards(
        vessel, channel, neutral + share
    )


def _range_towards(vessel: Vessel, channel: str, towards: float) -> float:
    """Distance from the neutral value of a channel to its end in the direction of another value."""
    c = vessel.commands[channel]
    if towards == c.neutral:
        return 0.0
    end = c.high if towards > c.neutral else c.low
    return end - c.neutral
