"""Base class of engines that step one vessel: commands, actuators, and steps cut where they jump.

`engine` steps a vessel on MuJoCo, with walls; `open_water` on the compiled engine, which is faster.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import cached_property
from math import isfinite
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.commands import clip_to_channel_ranges, input_vector, saturated_channels
from boatsim.physics.debugging import python_function
from boatsim.physics.native.calls import partial_call
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, Array, Wrench
from boatsim.physics.vessel import Vessel


class State(NamedTuple):
    """State of a vessel, SNAME: time, pose in start axes, velocities over ground in body axes."""

    t: float = 0.0  # [s]
    x: float = 0.0  # [m]
    y: float = 0.0  # [m]
    z: float = 0.0  # [m]
    phi: float = 0.0  # [rad]
    theta: float = 0.0  # [rad]
    psi: float = 0.0  # [rad]
    u: float = 0.0  # [m/s]
    v: float = 0.0  # [m/s]
    w: float = 0.0  # [m/s]
    p: float = 0.0  # [rad/s]
    q: float = 0.0  # [rad/s]
    r: float = 0.0  # [rad/s]


class Stepper(ABC):
    """Base class of engines that simulate one vessel.

    `command` sends commands to the actuators, `advance` integrates the motion.

    Attributes:
        vessel: The vessel.
        step: Integration step [s].
        program: The vessel's compiled program.
        code: Its compiled functions.
        sent: Commands as they were sent, in the order of the vessel's inputs; `commands` are those
            in force.
    """

    def __init__(self, vessel: Vessel, step: float) -> None:
        """Compile the vessel's program.

        Args:
            vessel: The vessel.
            step: Integration step [s].
        """
        self.vessel, self.step = vessel, step
        self.program = Program(vessel)
        self.code = self.program.simulation_functions
        self._values = self.program.values()
        self._on = self.program.effect_switches()
        self._commands = np.zeros(len(vessel.inputs))
        self._memory = np.zeros(self.program.memory_size)
        self._act = np.zeros(self.program.actuator_signal_size)
        self._state_of_force = np.zeros(2 * self.code.NQ)
        self._actuators = vessel.actuators
        # mean of each actuator over the last step
        self._mean = np.zeros(len(self._actuators))
        self._places = {name: i for i, name in enumerate(vessel.commands)}
        self._neutral = input_vector(vessel, {}).tolist()
        self._limits = list(vessel.limits().values())
        self.sent = list(self._neutral)

    @property
    @abstractmethod
    def t(self) -> float:
        """Simulated time [s]."""

    @abstractmethod
    def _set_joint_state(self, t: float, state: Array) -> None:
        """Set time [s] and joint coordinates and rates (2 NQ,)."""

    @abstractmethod
    def _joint_state(self) -> Array:
        """Return joint coordinates and rates (2 NQ,), SNAME."""

    @abstractmethod
    def _step(self, dt: float) -> None:
        """Take one step of dt [s] with fixed actuators."""

    @abstractmethod
    def acceleration(self) -> tuple[float, float]:
        """Return the acceleration over ground of the vessel's origin along body x, y [m/s^2]."""

    @property
    def contacts(self) -> int:
        """Number of contacts of the hull with walls; 0 in open water."""
        return 0

    def reset(
        self, state: State | None = None, commands: Mapping[str, float] | None = None
    ) -> None:
        """Set the state of the vessel, with actuators settled at commands.

        Args:
            state: The state; default: at the origin, at rest, t = 0.
            commands: Commands by channel; others are neutral.

        Raises:
            BadInput: If a channel does not exist or a value is not finite.
        """
        state = state or State()
        self._set_joint_state(
            state.t, self.program.to_joint_rates(np.array(state[1:])[list(self.code.SHOWS)])
        )
        self._memory[:] = 0.0
        self.command(commands or {})
        self.settle_actuators()

    def settle_actuators(self) -> None:
        """Set the actuators of the vessel to the steady state of their commands."""
        self.code.settle_actuators(self._commands, self._memory, self._values, self._on, self._act)
        self._mean[:] = self._mean_actuators()

    def command(self, commands: Mapping[str, float]) -> None:
        """Send commands to the vessel's actuators, which stay in force until the next ones.

        Commands are limited to the ranges of their channels.

        Args:
            commands: Commands by channel; others are neutral.

        Raises:
            BadInput: If a channel does not exist or a value is not finite.
        """
        sent = list(self._neutral)
        for name, value in commands.items():
            if name not in self._places:
                raise BadInput(self.vessel.unknown_command_message(name))
            sent[self._places[name]] = float(value)
        if not isfinite(sum(sent)):
            clip_to_channel_ranges(
                self.vessel, np.array(sent)
            )  # raises an error that names the channel
        self.sent = sent
        self._commands[:] = [
            min(max(x, low), high) for x, (low, high) in zip(sent, self._limits, strict=True)
        ]

    @property
    def channels_beyond_range(self) -> list[str]:
        """Names of the command channels whose last command exceeded its range."""
        if self._commands.tolist() == self.sent:
            return []
        return saturated_channels(self.vessel, np.array(self.sent))

    @property
    def commands(self) -> dict[str, float]:
        """Commands in force after limitation to their ranges: channel -> value."""
        # measured inputs come after the commands
        return dict(zip(self.vessel.commands, self._commands.tolist(), strict=False))

    def commands_in_force(self) -> list[float]:
        """Return the vessel's commands in force, in the order of its inputs."""
        return self._commands.tolist()

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Integrate the motion of the vessel over some steps with constant commands.

        Args:
            steps: Number of steps.
            length: Length of each step [s]; default: `step`.

        Raises:
            BadPhysics: If the motion diverges.
        """
        for _ in range(steps):
            self._advance(self.step if length is None else length)
        if not isfinite(sum(self._joint_state().tolist())):
            raise BadPhysics(
                f"{self.vessel.name}: the motion is no longer finite at t = {self.t:g} s"
            )

    @cached_property
    def _substep_length(self) -> Callable[[float, float], float]:
        """`substep_length` of this vessel, a function of the remainder and the lower limit."""
        arrays = self._commands, self._memory
        return partial_call(self.code, "substep_length", *arrays, ..., ..., self._values, self._on)

    @cached_property
    def _minimum_substep(self) -> Callable[..., float]:
        """`minimum_substep`, which needs no compilation for single numbers."""
        return python_function(self.code.minimum_substep)

    @cached_property
    def _advance_actuators(self) -> Callable[[float], None]:
        """`advance_actuators` of this vessel, a function of the length of the step."""
        arrays = self._commands, self._memory
        return partial_call(
            self.code, "advance_actuators", *arrays, ..., self._values, self._on, self._act
        )

    @cached_property
    def _advance_memory_of_motion(self) -> Callable[[float, float], None]:
        """`advance_memory_of_motion` in `_state_of_force`, a function of time and step."""
        rest = self._memory, self._act, self._values, self._on
        return partial_call(
            self.code, "advance_memory_of_motion", ..., self._state_of_force, ..., *rest
        )

    def _advance(self, left: float) -> None:
        """One step of `left` s, cut where the signal of an actuator has a jump or a kink."""
        least, before, whole = self.code.SHORTEST, 0.0, left
        self._mean[:] = 0.0
        while left > 1e-9:
            dt = left
            if self.code.HAS_TIME_TO_DISCONTINUITY:
                dt = self._substep_length(left, least)
                least, before = self._minimum_substep(dt, before, least), dt
            self._advance_actuators(dt)
            if self.code.HAS_ADVANCE_MOTION_MEMORY:
                self._state_of_force[:] = self._joint_state()
                self._advance_memory_of_motion(self.t, dt)
            self._step(dt)
            self._mean += self._mean_actuators() * (dt / whole)
            left -= dt

    def _mean_actuators(self) -> Array:
        """Mean (A,) of each actuator over the last part of a step."""
        n, held = len(self._mean), self.code.HELD
        act = self._act
        return np.asarray(
            (act[:n] + 4.0 * act[held : held + n] + act[2 * held : 2 * held + n]) / 6.0
        )

    @property
    def state(self) -> State:
        """Present state of the vessel: time, pose and velocities."""
        return State(self.t, *self.program.pose_and_velocities(self._joint_state().tolist()))

    def velocity_over_ground(self) -> tuple[float, float, float]:
        """Return the velocity of the vessel's origin over ground: north, east and down [m/s]."""
        rates = [0.0] * len(AXES)
        for place, rate in zip(self.code.FREE, self._joint_state()[self.code.NQ :], strict=True):
            rates[place] = float(rate)
        return rates[0], rates[1], rates[2]

    @property
    def actuators(self) -> dict[str, float]:
        """Mean position of each actuator over the last step: actuator -> value."""
        return dict(zip(self._actuators, self._mean.tolist(), strict=True))

    def wrench(self) -> Wrench:
        """Return the sum of the forces of all effects on the vessel, in body axes [N, N m].

        Degrees of freedom that the vessel lacks have 0.
        """
        self._state_of_force[:] = self._joint_state()
        return Wrench(**dict(zip(self._axes_of_force, self._body_force(self.t), strict=True)))

    def water_velocity(self) -> tuple[float, float]:
        """Return the velocity of the water over the ground at the vessel's origin [m/s].

        It is that to north and to east.
        """
        state = self.state
        north, east = self._water_velocity(state.t, state.x, state.y)
        return float(north), float(east)

    @cached_property
    def _water_velocity(self) -> Callable[[float, float, float], tuple[float, float]]:
        """`water_velocity` of this vessel, a function of time and place."""
        return partial_call(self.code, "water_velocity", ..., ..., ..., self._values, self._on)

    @cached_property
    def _axes_of_force(self) -> list[str]:
        """Names of the force components that the vessel's degrees of freedom have."""
        return [Wrench._fields[i] for i in self.code.FREE]

    @cached_property
    def _body_force(self) -> Callable[[float], tuple[float, ...]]:
        """`total_body_force` of this vessel in the state `_state_of_force`, a function of time."""
        last = np.int64(2 * self.code.HELD)  # the actuators at the end of the last step
        given = self._state_of_force, self._act, last, self._values, self._on
        return partial_call(self.code, "total_body_force", ..., *given)
