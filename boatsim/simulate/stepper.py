"""What steps a boat, on whatever: commands to actuators, steps cut where an actuator's signal jumps or bends.

`engine` steps it on MuJoCo, among walls, `open_water` in compiled code alone, the faster.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import isfinite
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics.commands import clip, command_row, saturated_channels
from boatsim.physics.program import Program
from boatsim.physics.signals import Array, Wrench
from boatsim.physics.vessel import Vessel


class State(NamedTuple):
    """Where the boat is and how it moves: SNAME, pose in start axes, velocities in body axes over ground."""

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
    """One vessel. `command` sets what is sent to the actuators, `advance` steps."""

    def __init__(self, vessel: Vessel, step: float) -> None:
        """`step` is the integration step in s."""
        self.vessel, self.step = vessel, step
        self.program = Program(vessel)
        self.code = self.program.module
        self._values = self.program.values()
        self._on = self.program.switches()
        self._commands = np.zeros(len(vessel.inputs))
        self._memory = np.zeros(self.program.memory_size)
        self._act = np.zeros(self.program.held_size)
        self._actuators = vessel.actuators
        self._mean = np.zeros(len(self._actuators))  # of each actuator over the last step
        self._places = {name: i for i, name in enumerate(vessel.commands)}
        self._neutral = command_row(vessel, {}).tolist()
        self._limits = list(vessel.limits().values())
        self.sent = list(
            self._neutral
        )  # in the order of the vessel's inputs; what acts of it is `commands`

    @property
    @abstractmethod
    def t(self) -> float:
        """Time [s]."""

    @abstractmethod
    def _put(self, t: float, state: Array) -> None:
        """Put the boat at joint coordinates and rates (2 NQ,)."""

    @abstractmethod
    def _joint_state(self) -> Array:
        """(2 NQ,) joint coordinates and rates, SNAME."""

    @abstractmethod
    def _step(self, dt: float) -> None:
        """One step of dt [s] under the actuators as they are."""

    @abstractmethod
    def acceleration(self) -> tuple[float, float]:
        """Acceleration of the origin over ground along body x and y [m/s^2], as an accelerometer there feels it."""

    @property
    def contacts(self) -> int:
        """How many contacts the hull has now."""
        return 0

    def reset(
        self, state: State | None = None, commands: Mapping[str, float] | None = None
    ) -> None:
        """Put the boat at a state (default: origin, at rest, t = 0), its actuators settled at the given commands."""
        state = state or State()
        self._put(state.t, self.program.joint_rates(np.array(state[1:])[list(self.code.SHOWS)]))
        self._memory[:] = 0.0
        self.command(commands or {})
        self.settle()

    def settle(self) -> None:
        """Let the actuators reach their commands at once."""
        self.code.settle(self._commands, self._memory, self._values, self._on, self._act)
        self._mean[:] = self._mean_of_part()

    def command(self, commands: Mapping[str, float]) -> None:
        """What is sent to the actuators from now on; limited to its range, neutral where not named. Raises BadInput."""
        sent = list(self._neutral)
        for name, value in commands.items():
            if name not in self._places:
                raise BadInput(self.vessel.unknown_command(name))
            sent[self._places[name]] = float(value)
        if not isfinite(sum(sent)):
            clip(self.vessel, np.array(sent))  # says which
        self.sent = sent
        self._commands[:] = [
            min(max(x, low), high) for x, (low, high) in zip(sent, self._limits, strict=True)
        ]

    @property
    def beyond(self) -> list[str]:
        """Channels of which more was sent than their range holds."""
        acts = self._commands.tolist()
        return [] if acts == self.sent else saturated_channels(self.vessel, np.array(self.sent))

    @property
    def commands(self) -> dict[str, float]:
        """Commands in force."""
        return dict(
            zip(self.vessel.commands, self._commands.tolist(), strict=False)
        )  # what is measured comes behind

    def in_force(self) -> list[float]:
        """The same, without the names: in the order of the vessel's inputs."""
        return self._commands.tolist()

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Steps of `length` s (default: `step`) with the commands held. Raises BadPhysics if the motion diverges."""
        for _ in range(steps):
            self._advance(self.step if length is None else length)
        if not isfinite(sum(self._joint_state().tolist())):
            raise BadPhysics(
                f"{self.vessel.name}: the motion is no longer finite at t = {self.t:g} s"
            )

    def _advance(self, left: float) -> None:
        """One step of `left` s, cut where an actuator's signal jumps or bends."""
        least, before, whole = self.code.SHORTEST, 0.0, left
        self._mean[:] = 0.0
        while left > 1e-9:
            dt = left
            if self.code.HAS_PAUSE:
                dt = self.code.until_bend(
                    self._commands, self._memory, left, least, self._values, self._on
                )
                least, before = self.code.least_after(dt, before, least), dt
            self.code.actuate_in_place(
                self._commands, self._memory, dt, self._values, self._on, self._act
            )
            self._step(dt)
            self._mean += self._mean_of_part() * (dt / whole)
            left -= dt

    def _mean_of_part(self) -> Array:
        """(A,) mean of each actuator over what was stepped last."""
        n, held = len(self._mean), self.code.HELD
        act = self._act
        return np.asarray(
            (act[:n] + 4.0 * act[held : held + n] + act[2 * held : 2 * held + n]) / 6.0
        )

    @property
    def state(self) -> State:
        """The present state."""
        return State(self.t, *self.program.shown(self._joint_state().tolist()))

    @property
    def actuators(self) -> dict[str, float]:
        """Mean of each actuator over the last step."""
        return dict(zip(self._actuators, self._mean.tolist(), strict=True))

    def wrench(self) -> Wrench:
        """Sum of all force laws in body axes at the present state [N, N m]; zero along freedoms that are held."""
        last = np.int64(2 * self.code.HELD)  # the actuators at the end of the last step
        found = self.code.forces(
            self.t, self._joint_state(), self._act, last, self._values, self._on
        )
        return Wrench(**dict(zip((Wrench._fields[i] for i in self.code.FREE), found, strict=True)))
