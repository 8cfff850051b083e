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
from boatsim.physics.native.calls import partial_call
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, Array, Wrench


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

    def __init__(self, program: Program, step: float) -> None:
        """Prepare the state of a vessel.

        Args:
            program: The vessel's program.
            step: Integration step [s].
        """
        self.vessel, self.step = program.vessel, step
        self.program = program
        self.code = self.program.simulation_functions
        self._values = self.program.values()
        self._on = self.program.effect_switches()
        self._commands = np.zeros(len(self.vessel.inputs))
        self._memory = np.zeros(self.program.memory_size)
        self._act = np.zeros(self.program.actuator_signal_size)
        self._state_of_force = np.zeros(2 * self.code.NQ)
        self._actuators = self.vessel.actuators
        # mean of each actuator over the last step
        self._mean = np.zeros(len(self._actuators))
        self._places = {name: i for i, name in enumerate(self.vessel.commands)}
        self._neutral = input_vector(self.vessel, {}).tolist()
        self._limits = list(self.vessel.limits().values())
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
    def _advance(self, length: float) -> None:
        """Take one step of `length` [s] with constant commands; store the mean of the actuators."""

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

    def note_sent(self, orders: Mapping[str, float]) -> None:
        """Note commands that compiled code has sent to the vessel and limited to their ranges.

        Args:
            orders: Commands as they were sent, by channel; the others did not change.
        """
        for name, value in orders.items():
            self.sent[self._places[name]] = value

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
            raise self.diverged(self.t)

    def diverged(self, t: float) -> BadPhysics:
        """Return the error of a motion that diverges.

        Args:
            t: Time at which it is no longer finite [s].
        """
        return BadPhysics(f"{self.vessel.name}: the motion is no longer finite at t = {t:g} s")

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
        return Wrench(**dict(zip(self._axes_of_force, self.body_force(), strict=True)))

    def body_force(self) -> tuple[float, ...]:
        """Return the components of `wrench` along the vessel's degrees of freedom [N, N m]."""
        self._state_of_force[:] = self._joint_state()
        return self._total_body_force(self.t)

    def air_force(self) -> tuple[float, ...]:
        """Return the force of the air along the vessel's degrees of freedom [N, N m]."""
        self._state_of_force[:] = self._joint_state()
        return self._air_body_force(self.t)

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
        last = np.int64(2 * self.code.HELD)  # the actuators at the end of the last step
        given = self._values, self._on, self._act, last
        return partial_call(self.code, "water_velocity", ..., ..., ..., *given)

    @cached_property
    def _axes_of_force(self) -> list[str]:
        """Names of the force components that the vessel's degrees of freedom have."""
        return [Wrench._fields[i] for i in self.code.FREE]

    @cached_property
    def _total_body_force(self) -> Callable[[float], tuple[float, ...]]:
        """`total_body_force` of this vessel in the state `_state_of_force`, a function of time."""
        return self._function_of_time("total_body_force")

    @cached_property
    def _air_body_force(self) -> Callable[[float], tuple[float, ...]]:
        """`air_body_force` of this vessel in the state `_state_of_force`, a function of time."""
        return self._function_of_time("air_body_force")

    def _function_of_time(self, name: str) -> Callable[[float], tuple[float, ...]]:
        """Function of a force in the state `_state_of_force` after the last step."""
        last = np.int64(2 * self.code.HELD)  # the actuators at the end of the last step
        given = self._state_of_force, self._act, last, self._values, self._on
        return partial_call(self.code, name, ..., *given)
