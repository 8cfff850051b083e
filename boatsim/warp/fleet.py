"""Many boats of one vessel at once, each with its own state, commands and parameters."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.commands import taken
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.warp.alone import Alone
from boatsim.warp.boats import Boats, Places
from boatsim.warp.on_mujoco import OnMujoco

MOST = 2**24  # whole numbers up to here are what they are in single precision


class Fleet:
    """Boats in open water on one of Warp's devices.

    States, SNAME [m, rad, m/s, rad/s], are (n, 2 NQ) as those of `boatsim.simulate.twin.Twin`; commands (n, C) in the
    vessel's order. The motion of a boat that diverges is no longer finite; the others do not mind.
    """

    def __init__(
        self, vessel: Vessel, n: int, step: float = 0.02, device: str = "cpu", *, mujoco: bool = True,
        double: bool = False,
    ) -> None:  # fmt: skip
        """`step` is the integration step in s, `device` a name of Warp's.

        On mujoco_warp, in single precision, or without it, then in double precision too. Raises BadInput for an effect
        that has no form there.
        """
        if mujoco and double:
            raise BadInput("double = true; mujoco_warp knows single precision alone (allowed with mujoco = false)")
        self.vessel, self.n, self.step = vessel, n, step
        self.program = Program(vessel)
        self._boats = Boats(self.program, n, step, device, "float64" if double else "float32")
        self._whole = () if double else self._courses()
        self._check_courses(self._boats.values)
        self.motion: OnMujoco | Alone = OnMujoco(self._boats) if mujoco else Alone(self._boats)
        self.reset()

    def reset(self, states: Any = None, commands: Any = None, boats: Sequence[int] | Places | None = None) -> None:
        """Put boats (default: all) to t = 0 and to states, default the origin at rest, actuators settled at commands.

        A single row of states or commands is for all of them; without commands the actuators are neutral.
        """
        code, on = self.program.module, self.program.switches()
        rows = np.arange(self.n) if boats is None else np.asarray(boats, dtype=np.int64)
        start = np.zeros(2 * code.NQ) if states is None else np.asarray(states, dtype=float)
        if start.shape not in ((2 * code.NQ,), (len(rows), 2 * code.NQ)):
            raise BadInput(f"states are {start.shape}; allowed is ({len(rows)}, {2 * code.NQ}), or one row")
        y = np.array([self.program.joint_rates(row) for row in np.atleast_2d(start)])
        sent = self._taken(self.program.command_array({}) if commands is None else commands, len(rows))
        memory, act = np.zeros((len(rows), self.program.memory_size)), np.zeros((len(rows), self.program.held_size))
        values = self._boats.values
        alike = len(values) == 1 and (sent == sent[:1]).all()
        for i, row in enumerate(rows[:1].tolist() if alike else rows.tolist()):
            code.settle(sent[i], memory[i], values[row % len(values)], on, act[i])
        if alike:
            memory[:], act[:] = memory[:1], act[:1]
        self.motion.put(rows, np.broadcast_to(y, (len(rows), 2 * code.NQ)))
        for where, what in zip(("commands", "memory", "act", "t"), (sent, memory, act, 0.0), strict=True):
            self._boats.put(getattr(self._boats, where), rows, what)

    def advance(self, commands: Any = None, steps: int = 1) -> None:
        """Steps under commands (n, C), one row for all, or those there are; within their ranges. Raises BadInput."""
        if commands is not None:
            self._boats.commands.assign(self._taken(commands, self.n))
        self.motion.advance(steps)

    def set(self, parameter: str, values: Any) -> None:
        """A parameter of an effect, "fan_wind.speed", of each boat (n,) or of all. Raises BadInput."""
        known = [f"{e.name}.{key}" for e in self.program.effects for key in type(e).params()]
        if parameter not in known:
            raise BadInput(unknown_name(f"{self.vessel.name}: parameter", parameter, known))
        given, own = np.asarray(values, dtype=float), self._boats.values
        if given.shape not in ((), (self.n,)):
            raise BadInput(f"{parameter} is {given.shape}; allowed is ({self.n},), or one number")
        if given.ndim and len(own) != self.n:
            own = np.repeat(own, self.n, axis=0)
        effect, _, key = parameter.rpartition(".")
        own = own.copy()
        own[:, self.program.index(effect, key)] = given
        self._check_courses(own)
        self._boats.take(own)
        self.motion.renew()

    @property
    def states(self) -> Array:
        """(n, 2 NQ) where the boats are and how they move."""
        return self.program.body_rates(self.motion.states())

    @property
    def t(self) -> Array:
        """(n,) time since each boat's last reset [s]."""
        found: Array = self._boats.t.numpy()
        return found

    def _taken(self, commands: Any, n: int) -> Array:
        """(n, C) commands within their ranges."""
        rows, width = np.atleast_2d(np.asarray(commands, dtype=float)), len(self.vessel.inputs)
        if rows.shape not in ((n, width), (1, width)):
            raise BadInput(f"commands are {rows.shape}; allowed is ({n}, {width}), or one row")
        return np.ascontiguousarray(np.broadcast_to(taken(self.vessel, rows), (n, width)))

    def _courses(self) -> tuple[int, ...]:
        """Places of the parameters that number a random course: those that a seed changes."""
        found = list[int]()
        for effect, first in zip(self.program.effects, self.program.offsets, strict=True):
            pairs = zip(effect.values(), effect.seeded(1).values(), strict=True)
            found += [first + i for i, (value, other) in enumerate(pairs) if value != other]
        return tuple(found)

    def _check_courses(self, values: Array) -> None:
        """Raises BadInput for a random course by a number that single precision lacks: it would be another one."""
        worst = values[:, self._whole].max(initial=0.0)
        if worst > MOST:
            raise BadInput(f"{self.vessel.name}: realisation = {worst:.0f}; in single precision allowed to {MOST}")
