"""Steady motion (trim) of a vessel under given commands, or at a given speed."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from math import inf, sqrt

import numpy as np

from boatsim.errors import BadInput, BadPhysics, unknown_name_message
from boatsim.physics.kinds.channel import ChannelEffect
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.interval_map import IntervalMap
from boatsim.simulate.manoeuvre import complete_manoeuvring_table
from boatsim.simulate.stepper import State

# Interval over which the change of the state is taken, in units of sqrt(L / g): 0.01 s for 1 m.
# Short against all motions of a hull, long enough that rounding does not matter.
INTERVAL = 0.03
# Largest scaled rate of a steady motion: accelerations in units of g, and of g / L in rotation.
# Rounding errors are 1e-14.
STEADY = 1e-10
PERTURBATION = 1e-6  # of the scaled unknowns, for derivatives
MOST_ITERATIONS = 60  # of Newton's method; fewer than 10 suffice near a solution
SMALLEST_STEP = 1e-4  # share of a Newton step below which the search for a smaller residual ends
# Froude numbers at which the search begins: displacement speeds first, then planing, then astern
FROUDE_NUMBERS = (0.15, 0.05, 0.3, 0.6, 1.2, -0.1)
SHARES_OF_AHEAD = (0.5, 0.1, 1.0)  # of the usual commands ahead, at which the search begins
SETTLING = 400.0  # [sqrt(L / g)] of simulation where the search without one finds nothing
# Times at which the motion must still be steady, in units of sqrt(L / g), and the largest scaled
# rate there
LATER, STILL_STEADY = (1.7, 11.3), 1e-6
OTHER_HEADING = 0.02  # [rad] from the steady one, at which rates must not depend on time either
LARGEST_ANGLE = 1.5  # [rad] of roll and pitch; a vessel beyond has capsized


@dataclass(frozen=True)
class SteadyMotion:
    """Motion of a vessel whose velocities, attitude and actuators do not change.

    Attributes:
        state: Motion, heading north.
        commands: Every command by channel.
        memory: Memory of effects less that of settled actuators; empty for the same.
    """

    state: State
    commands: Mapping[str, float]
    memory: Array = field(default_factory=lambda: np.zeros(0))


def motion_scales(vessel: Vessel) -> dict[str, float]:
    """Return the usual size of each field of `State` [m, rad, m/s, rad/s].

    Args:
        vessel: The vessel.
    """
    length, speed = vessel.length, sqrt(GRAVITY * vessel.length)
    scales = dict.fromkeys(("x", "y", "z"), length)
    scales |= dict.fromkeys(("phi", "theta", "psi"), 1.0)
    scales |= dict.fromkeys(("u", "v", "w"), speed)
    return scales | dict.fromkeys(("p", "q", "r"), speed / length)


def find_steady_motion(
    vessel: Vessel,
    commands: Mapping[str, float] | None = None,
    speed: float | None = None,
) -> SteadyMotion:
    """Return the steady motion of a vessel under commands, or straight ahead at a speed.

    With a speed, the commands that are not given follow from it: those of `[manoeuvring] ahead` by
    one factor and those of `[manoeuvring] steer` by one helm angle, by default as
    `complete_manoeuvring_table` derives them. Without a speed, commands that are not given are
    neutral. The equations are solved by Newton's method, so that motions without straight-line
    stability are found too.

    Args:
        vessel: The vessel.
        commands: Commands by channel.
        speed: Speed in surge [m/s].

    Raises:
        BadInput: A command does not exist or is out of its range, or there is no steady motion.
    """
    given = _checked_commands(vessel, commands or {})
    if speed is not None and "surge" not in vessel.dof:
        raise BadInput(
            f"{vessel.name} is not free in surge; --speed is allowed for vessels that are"
        )
    varies = False
    # straight motions first: without straight-line stability the commands of a straight course have
    # a turning circle, too
    for straight in (True, False):
        balance = _Balance(vessel, given, speed, straight)
        for found in balance.solutions():
            if balance.lasts(found):
                return found
            varies = True
        if speed is not None or "yaw" not in vessel.dof:
            break
    if varies:
        raise BadInput(
            f"{vessel.name}: no steady motion, because a force depends on time or place, as that "
            "of waves, or on the heading in a turn; allowed are vessels in calm and unlimited water"
        )
    raise BadInput(_failure(vessel, given, speed))


def _checked_commands(vessel: Vessel, commands: Mapping[str, float]) -> dict[str, float]:
    for name, value in commands.items():
        if name not in vessel.commands:
            names = list(vessel.commands)
            raise BadInput(unknown_name_message(f"{vessel.name}: command", name, names))
        channel = vessel.commands[name]
        if not channel.low <= value <= channel.high:
            raise BadInput(
                f"{vessel.name}: command {name} = {value:g}; "
                f"allowed {channel.low:g} to {channel.high:g}"
            )
    return dict(commands)


def _failure(vessel: Vessel, given: Mapping[str, float], speed: float | None) -> str:
    """Message for a vessel without a steady motion."""
    words = ", ".join(f"{name} = {value:g}" for name, value in given.items())
    if speed is None:
        return f"{vessel.name}: no steady motion with {words or 'neutral commands'}"
    start = f"{vessel.name}: no steady straight course at speed = {speed:g} m/s"
    if words:
        start += f" with {words}"
    thrust, _ = _directions(vessel, given, speed)
    if not thrust:
        return f"{start}; no free command changes its thrust in that direction"
    reached = _speed_at_full_commands(vessel, given, thrust)
    if reached is None:
        return f"{start} within the ranges of the commands"
    return f"{start}; the commands at the ends of their ranges give {reached:.4g} m/s"


def _speed_at_full_commands(
    vessel: Vessel, given: Mapping[str, float], thrust: Mapping[str, float]
) -> float | None:
    """Speed with the usual commands ahead or astern, increased until one reaches its range."""
    most = inf
    for name, by in thrust.items():
        channel = vessel.commands[name]
        for end in (channel.low, channel.high):
            if (end - channel.neutral) / by > 0.0:
                most = min(most, (end - channel.neutral) / by)
    commands = dict(given)
    for name, by in thrust.items():
        commands[name] = vessel.commands[name].neutral + most * by
    for found in _Balance(vessel, commands, None, True).solutions():
        return found.state.u
    return None


def _directions(
    vessel: Vessel, given: Mapping[str, float], speed: float
) -> tuple[dict[str, float], dict[str, float]]:
    """Changes of the free commands: for thrust ahead or astern, and per rad of helm."""
    table = vessel.manoeuvring
    with suppress(BadInput, BadPhysics):  # a vessel without steering has no such table
        table = complete_manoeuvring_table(vessel)
    usual = table.ahead
    if speed < 0.0:
        usual = table.astern
    thrust: dict[str, float] = {}
    for name, value in usual.items():
        if name not in given and value != vessel.commands[name].neutral:
            thrust[name] = value - vessel.commands[name].neutral
    helm = {name: value for name, value in table.steer.items() if name not in given}
    return thrust, helm


class _Balance:
    """Rates of change of a vessel's state as a function of scaled unknowns."""

    def __init__(
        self, vessel: Vessel, given: Mapping[str, float], speed: float | None, straight: bool
    ) -> None:
        """Choose the unknowns.

        Args:
            vessel: The vessel.
            given: Commands by channel.
            speed: Speed in surge [m/s]; None where it is unknown.
            straight: Whether the yaw rate is zero.
        """
        self.vessel, self.given, self.speed, self.straight = vessel, given, speed, straight
        self.unit = sqrt(vessel.length / GRAVITY)  # [s]
        self.motion = IntervalMap(vessel, INTERVAL * self.unit)
        scales = motion_scales(vessel)
        fields = self.motion.fields
        fixed = ["psi"]
        if speed is not None:
            fixed.append("u")
        if straight:
            fixed.append("r")
        self.unknown = [name for name in fields if name not in fixed]
        self.scale = np.array([scales[name] for name in self.unknown])
        self.rows = [i for i, name in enumerate(fields) if name != "psi"]
        # rates are in units of the scale of the state over sqrt(L / g)
        self.row_scale = np.array([scales[fields[i]] for i in self.rows]) / self.unit
        self.directions: list[dict[str, float]] = []
        if speed is not None:
            both = _directions(vessel, given, speed)
            self.directions = [one for one in both if one]
        # the memory of actuators settles at their commands, that of other effects need not
        kinds = [e for e in self.motion.vessel.effects if not isinstance(e, ChannelEffect)]
        stores = any(not actuator for actuator in self.motion.memory_actuators) and kinds
        self.memory_size = 0
        if stores:
            self.memory_size = len(self.motion.memory_names)

    def solutions(self) -> Iterator[SteadyMotion]:
        """Yield the steady motions that Newton's method finds from different starts."""
        for x in self._starts():
            found = self._newton(x)
            if found is not None:
                yield self._motion_of(found)
        if self.speed is None and not self.straight:
            settled = self._settled()
            if settled is not None:
                found = self._newton(settled)
                if found is not None:
                    yield self._motion_of(found)

    def lasts(self, steady: SteadyMotion) -> bool:
        """Whether motion and derivatives stay the same at later times and other places."""
        s = steady.state
        first = self._rates(s, steady), self._rates(s._replace(psi=OTHER_HEADING), steady)
        for times in LATER:
            t = times * self.unit
            moved = s._replace(t=t, psi=s.r * t, x=s.u * t, y=s.v * t)
            turned = moved._replace(psi=moved.psi + OTHER_HEADING)
            for before, state in zip(first, (moved, turned), strict=True):
                if not np.abs(self._rates(state, steady) - before).max() < STILL_STEADY:
                    return False
        return True

    def _rates(self, state: State, steady: SteadyMotion) -> Array:
        """Scaled rates of the motion with the commands and memory of a steady motion."""
        begin = self._begin(state, steady.commands, steady.memory)
        end = self.motion.advance(state, self._offset(steady.memory), steady.commands)
        return np.asarray((end - begin)[self.rows] / self.motion.length / self.row_scale)

    def _starts(self) -> list[Array]:
        """Scaled unknowns at which the search begins."""
        starts = []
        if self.speed is not None:
            for share in SHARES_OF_AHEAD:
                x = self._zeros()
                if self.directions:
                    x[len(self.unknown) + self.memory_size] = share
                starts.append(x)
            return starts
        starts.append(self._zeros())
        if "u" not in self.unknown:
            return starts
        place = self.unknown.index("u")
        speeds = list(FROUDE_NUMBERS)  # in units of sqrt(g L)
        if self.vessel.manoeuvring.speed:
            speeds.insert(0, self.vessel.manoeuvring.speed / self.scale[place])
        for u in speeds:
            x = self._zeros()
            x[place] = u
            starts.append(x)
        # a vessel at rest without forces is steady; otherwise rest is a bad start of the search
        if not np.abs(self._residual(starts[0])).max() < STEADY:
            starts.append(starts.pop(0))
        return starts

    def _zeros(self) -> Array:
        return np.zeros(len(self.unknown) + self.memory_size + len(self.directions))

    def _newton(self, x: Array) -> Array | None:
        """Solution near x, None if the method does not converge."""
        try:
            residual = self._residual(x)
            for _ in range(MOST_ITERATIONS):
                if not np.isfinite(residual).all():
                    return None
                if np.abs(residual).max() < STEADY:
                    if self._is_upright(x):
                        return x
                    return None
                columns = []
                for i in range(len(x)):
                    step = np.zeros(len(x))
                    step[i] = PERTURBATION
                    more, less = self._residual(x + step), self._residual(x - step)
                    columns.append((more - less) / (2.0 * PERTURBATION))
                slopes = np.column_stack(columns)
                if not np.isfinite(slopes).all():
                    return None
                by = -np.linalg.lstsq(slopes, residual, rcond=1e-10)[0]
                share = 1.0
                while True:
                    further = x + share * by
                    new = self._residual(further)
                    if np.linalg.norm(new) < np.linalg.norm(residual):
                        break
                    share *= 0.5
                    if share < SMALLEST_STEP:
                        return None
                x, residual = further, new
        except BadPhysics:
            return None
        return None

    def _is_upright(self, x: Array) -> bool:
        for name, value in zip(self.unknown, x.tolist(), strict=False):
            if name in ("phi", "theta") and abs(value) > LARGEST_ANGLE:
                return False
        return True

    def _settled(self) -> Array | None:
        """Unknowns after a long simulation from rest, None if the motion diverges."""
        state, memory = State(), np.zeros(self.memory_size)
        commands = self._commands(self._zeros())
        try:
            for _ in range(round(SETTLING / INTERVAL)):
                end = self.motion.advance(state, self._offset(memory), commands)
                values = dict(zip(self.motion.fields, end.tolist(), strict=False))
                values["psi"] = 0.0
                state = State(**values)
        except BadPhysics:
            return None
        x = self._zeros()
        for i, name in enumerate(self.unknown):
            x[i] = getattr(state, name) / self.scale[i]
        return x

    def _residual(self, x: Array) -> Array:
        """Scaled rates of change of velocities, attitude and memory."""
        state, memory, commands = self._state(x), self._memory(x), self._commands(x)
        begin = self._begin(state, commands, memory)
        end = self.motion.advance(state, self._offset(memory), commands)
        rates = (end - begin) / self.motion.length
        residual = rates[self.rows] / self.row_scale
        if self.memory_size:
            residual = np.append(residual, rates[len(self.motion.fields) :] * self.unit)
        return np.asarray(residual)

    def _begin(self, state: State, commands: Mapping[str, float], memory: Array) -> Array:
        begin = self.motion.settled_state(state, commands)
        return np.asarray(begin + self._offset(memory))

    def _offset(self, memory: Array) -> Array:
        offset = np.zeros(len(self.motion))
        if len(memory):
            offset[len(self.motion.fields) :] = memory
        return offset

    def _state(self, x: Array) -> State:
        values = dict(
            zip(self.unknown, (x[: len(self.unknown)] * self.scale).tolist(), strict=True)
        )
        if self.speed is not None:
            values["u"] = self.speed
        return State(**values)

    def _memory(self, x: Array) -> Array:
        return x[len(self.unknown) :][: self.memory_size]

    def _commands(self, x: Array) -> dict[str, float]:
        """Every command by channel, within its range."""
        commands = {}
        for name, channel in self.vessel.commands.items():
            commands[name] = self.given.get(name, channel.neutral)
        amounts = x[len(self.unknown) + self.memory_size :].tolist()
        for amount, direction in zip(amounts, self.directions, strict=True):
            for name, by in direction.items():
                commands[name] += amount * by
        for name, channel in self.vessel.commands.items():
            commands[name] = min(max(commands[name], channel.low), channel.high)
        return commands

    def _motion_of(self, x: Array) -> SteadyMotion:
        return SteadyMotion(self._state(x), self._commands(x), self._memory(x).copy())
