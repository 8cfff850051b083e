"""From sticks to what they set: a controller's goals, or where it passes commands on, the channels themselves."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi, sqrt
from typing import NamedTuple

from boatsim.control.base import Controller, clip, wrap
from boatsim.drive.driver_input import Sticks
from boatsim.errors import BadInput
from boatsim.physics.signals import STATE, follower
from boatsim.physics.vessel import ManoeuvringTable, Vessel
from boatsim.simulate.manoeuvre import approach, athwart, handled

FROUDE = 0.15  # of a hull that is still slow, where nothing tells its speed
ASIDE = 0.2  # sway over surge speed, of a vessel whose controller says nothing of it
RADIUS = 2.0  # [lengths] of the turn at full speed, the same
DIGITS = 6  # of a goal: a file of many stays small
HEADING = "psi_rad"


class Dial(NamedTuple):
    """What one stick does to one goal or channel."""

    key: str
    stick: str  # of `Sticks`
    low: float  # added to its neutral value with the stick at -1
    high: float  # the same at 1

    def at(self, sticks: Sticks) -> float:
        """What it adds."""
        way: float = getattr(sticks, self.stick)
        return way * self.high if way > 0.0 else -way * self.low


@dataclass
class Dials:
    """All that the sticks set. A heading is turned: its dial says how fast [rad/s]."""

    dials: tuple[Dial, ...]
    neutral: Mapping[str, float]  # of every key
    limits: Mapping[str, tuple[float, float]]  # of those that are channels
    _heading: float | None = field(default=None, init=False)  # [rad] asked for

    @property
    def keys(self) -> list[str]:
        """Goals and channels that they set."""
        return list(self.neutral)

    def goal(self, sticks: Sticks, dt: float, heading: float) -> dict[str, float]:
        """Goals under these sticks, `dt` [s] after the last ones, of a boat on this heading [rad]."""
        found = dict(self.neutral)
        for dial in self.dials:
            found[dial.key] += dial.at(sticks)
        if HEADING in found:
            before = heading if self._heading is None else self._heading
            self._heading = found[HEADING] = wrap(before + dt * found[HEADING])
        within = {
            key: clip(value, *self.limits.get(key, (value, value))) for key, value in found.items()
        }
        return {key: round(value, DIGITS) for key, value in within.items()}

    def let_go(self) -> None:
        """The next goals begin from the heading the boat is then on."""
        self._heading = None


def dials_of(vessel: Vessel, controller: Controller, name: str) -> Dials:
    """The dials of a vessel under a controller of this name. Raises BadInput for one that no stick can steer."""
    goals = type(controller).goals
    if not goals and not type(controller).passes_on:
        raise BadInput(f"controller {name} steers by itself; it leaves nothing to the sticks")
    if not vessel.commands:
        raise BadInput(f"{vessel.name} takes no commands; there is nothing to drive")
    if not goals:
        return _of_channels(vessel, _mixed(vessel, handled(vessel)))
    table = _handled(vessel)
    held = [d for d in _mixed(vessel, table) if d.key in goals]
    found = [*_of_motion(vessel, table, controller.largest_goals(), goals), *held]
    if not found:
        raise BadInput(
            f"controller {name} is steered by {', '.join(goals)}; sticks give speeds, turning, heading or commands"
        )
    return _of_channels(vessel, found)


def _of_channels(vessel: Vessel, dials: Sequence[Dial]) -> Dials:
    """With the neutral value and the range of those that are channels."""
    taken = vessel.commands
    keys = dict.fromkeys(d.key for d in dials)
    neutral = {key: taken[key].neutral if key in taken else 0.0 for key in keys}
    return Dials(
        tuple(dials),
        neutral,
        {key: (taken[key].low, taken[key].high) for key in keys if key in taken},
    )


def _handled(vessel: Vessel) -> ManoeuvringTable:
    """How it is driven and steered, as far as that can be told."""
    try:
        return handled(vessel)
    except BadInput:
        return vessel.manoeuvring


def _of_motion(
    vessel: Vessel, table: ManoeuvringTable, stated: Mapping[str, float], goals: Sequence[str]
) -> list[Dial]:
    """Dials of the goals that are speeds, turning rates or a heading."""
    axes = {
        s.column: s.axis
        for s in STATE
        if s.axis in Sticks._fields and (s.rate or s.column == HEADING)
    }
    found = []
    for key in goals:
        axis = axes.get(follower(key) or "")
        if axis is None or axis not in vessel.dof:
            continue
        full = stated[key] if key in stated else _full(replace(vessel, manoeuvring=table))[axis]
        forward_only = axis == "surge" and not table.astern and key not in stated
        found.append(Dial(key, axis, 0.0 if forward_only else -full, full))
    return found


def _full(vessel: Vessel) -> dict[str, float]:
    """Largest goals [m/s, rad/s] of a vessel whose controller states none: by the speed that it reaches."""
    try:
        speed = approach(vessel)
    except BadInput:
        speed = FROUDE * sqrt(9.81 * vessel.length)
    return {
        "surge": speed,
        "sway": ASIDE * speed,
        "yaw": min(speed / (RADIUS * vessel.length), 0.25 * pi),
    }


def _mixed(vessel: Vessel, table: ManoeuvringTable) -> list[Dial]:
    """Channels by hand, each stick to the end of their range: what drives it ahead, what pushes aside, what steers."""
    taken = vessel.commands
    found: list[Dial] = []
    for name, ahead in table.ahead.items():
        room, back = _room(vessel, name, ahead), table.astern.get(name, taken[name].neutral)
        found.append(Dial(name, "surge", _room(vessel, name, back), room))
    for name, per_rad in table.steer.items():
        ends = [_room(vessel, name, taken[name].neutral + side * per_rad) for side in (-1.0, 1.0)]
        found.append(Dial(name, "yaw", *ends))
    for name, share in athwart(vessel).items():
        if name in taken and name not in table.steer:
            ends = [_room(vessel, name, taken[name].neutral + side * share) for side in (-1.0, 1.0)]
            found.append(Dial(name, "sway", *ends))
    return found


def _room(vessel: Vessel, channel: str, towards: float) -> float:
    """How far a channel can be moved from its neutral value towards another one; 0 where they are the same."""
    c = vessel.commands[channel]
    return 0.0 if towards == c.neutral else (c.high if towards > c.neutral else c.low) - c.neutral
