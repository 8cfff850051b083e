"""Steps a vessel on MuJoCo: added mass and all forces enter through the passive-force callback.

Files, controllers and effects are SNAME (z down); MuJoCo's model is z up. The translation is here for people and files,
and in `add_to_mujoco` of the equations for the compiled step; nowhere else.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from math import isfinite
from types import ModuleType
from typing import NamedTuple, TypedDict, Unpack

import mujoco
import numpy as np

from boatsim.errors import BadPhysics
from boatsim.physics.kernel.equations import COORDINATES, SIGN
from boatsim.physics.program import Program
from boatsim.physics.signals import Array, Wrench
from boatsim.physics.vessel import Vessel
from boatsim.simulate import native, world
from boatsim.simulate.world import Tank

SAME = 1e-12  # relative: native and Python callback must agree to this at start-up


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


class Look(TypedDict, total=False):
    """What `world.build` may be told of the model beside its vessel and tank."""

    show: bool
    wall_solref: tuple[float, float] | None
    friction: float


class Engine:
    """One vessel in one tank. `command` sets what is sent to the actuators, `advance` steps."""

    def __init__(
        self,
        vessel: Vessel,
        tank: Tank | None = None,
        step: float = 0.02,
        *,
        callback: str = "native",
        **look: Unpack[Look],
    ) -> None:
        """Build the model; `look` goes to `world.build`. Raises BadPhysics for a model that can not be stepped.

        `callback` is "native" (and falls back to "python" on any difference between the two) or "python".
        """
        self.vessel, self.step = vessel, step
        self.tank = tank or Tank(10.0 * vessel.length, 10.0 * vessel.length, vessel.length, walls=False)  # open water
        self.program = Program(vessel)
        self.code = self.program.module
        self._values = self.program.values()
        self._on = self.program.switches()
        self._k = np.zeros(self.code.K)
        self.code.constants(self.program.body, self._values, self._on, self._k)
        size = len(self._values) + self.code.K + self.program.held_size + 2
        with no_callback():
            self.model = world.build(vessel, self.tank, step, size, **look)
            self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(i).name for i in range(self.model.njnt)]
        coordinates = [COORDINATES[i] for i in self.code.FREE]
        self._place = np.array([joints.index(n) for n in coordinates])  # of each coordinate among MuJoCo's joints
        self._sign = np.array([float(SIGN[n]) for n in coordinates])  # SNAME = sign * z-up, coordinate and rate alike
        self._commands = np.zeros(len(vessel.inputs))
        self._memory = np.zeros(self.program.memory_size)
        self._act = np.zeros(self.program.held_size)
        self._mean = np.zeros(len(vessel.actuators))  # of each actuator over the last step
        self._held = self.data.userdata[-self.program.held_size - 2 :]
        self.callback = self._choose(callback, size)
        self.reset()

    def reset(self, state: State | None = None, commands: Mapping[str, float] | None = None) -> None:
        """Put the boat at a state (default: origin, at rest, t = 0), its actuators settled at the given commands."""
        state = state or State()
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = state.t
        y = self.program.joint_rates(np.array(state[1:])[list(self.code.SHOWS)])
        self.data.qpos[self._place] = self._sign * y[: self.code.NQ]
        self.data.qvel[self._place] = self._sign * y[self.code.NQ :]
        self._memory[:] = 0.0
        self.command(commands or {})
        self.settle()

    def settle(self) -> None:
        """Let the actuators reach their commands at once."""
        self.code.settle(self._commands, self._memory, self._values, self._on, self._act)
        self._mean[:] = self._mean_of_part()
        self._write_userdata()

    def command(self, commands: Mapping[str, float]) -> None:
        """What is sent to the actuators from now on; limited to its range, neutral where not named. Raises BadInput."""
        self._commands[:] = self.program.command_array(commands)

    @property
    def commands(self) -> dict[str, float]:
        """Commands in force."""
        return dict(zip(self.vessel.commands, self._commands.tolist(), strict=False))  # what is measured comes behind

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Steps of `length` s (default: `step`) with the commands held. Raises BadPhysics if the motion diverges."""
        with installed(self.callback):
            for _ in range(steps):
                self._advance(self.step if length is None else length)
        self.model.opt.timestep = self.step  # a step may have been cut
        if not isfinite(sum(self.data.qpos.tolist())):
            raise BadPhysics(f"{self.vessel.name}: the motion is no longer finite at t = {self.data.time:g} s")

    def _advance(self, left: float) -> None:
        """One step of `left` s, cut where an actuator's signal jumps or bends."""
        least, before, whole = self.code.SHORTEST, 0.0, left
        self._mean[:] = 0.0
        while left > 1e-9:
            dt = left
            if self.code.HAS_PAUSE:
                dt = self.code.until_bend(self._commands, self._memory, left, least, self._values, self._on)
                least, before = self.code.least_after(dt, before, least), dt
            self.model.opt.timestep = dt
            self.code.actuate_in_place(self._commands, self._memory, dt, self._values, self._on, self._act)
            self._held[:-2] = self._act
            self._held[-2:] = self.data.time, 1.0 / dt
            mujoco.mj_step(self.model, self.data)
            self._mean += self._mean_of_part() * (dt / whole)
            left -= dt

    def _mean_of_part(self) -> Array:
        """(A,) mean of each actuator over what was stepped last."""
        begin, middle, end = self._act.reshape(3, -1)[:, : len(self._mean)]
        return np.asarray((begin + 4.0 * middle + end) / 6.0)

    def coast(self, steps: int) -> None:
        """Many steps inside MuJoCo's own loop with the actuators as they are: what benchmarks measure."""
        with installed(self.callback):
            mujoco.mj_step(self.model, self.data, nstep=steps)

    @property
    def state(self) -> State:
        """The present state."""
        return State(self.data.time, *self.code.moved.py_func(self._joint_state().tolist()))

    def _joint_state(self) -> Array:
        """(2 NQ,) joint coordinates and rates, SNAME."""
        q, qd = self.data.qpos[self._place], self.data.qvel[self._place]
        return np.concatenate([self._sign * q, self._sign * qd])

    @property
    def actuators(self) -> dict[str, float]:
        """Mean of each actuator over the last step."""
        return dict(zip(self.vessel.actuators, self._mean.tolist(), strict=True))

    @property
    def contacts(self) -> int:
        """How many contacts the hull has now."""
        return int(self.data.ncon)

    def wrench(self) -> Wrench:
        """Sum of all force laws in body axes at the present state [N, N m]; zero along freedoms that are held."""
        last = np.int64(2 * self.code.HELD)  # the actuators at the end of the last step
        found = self.code.forces(self.data.time, self._joint_state(), self._act, last, self._values, self._on)
        return Wrench(**dict(zip((Wrench._fields[i] for i in self.code.FREE), found, strict=True)))

    def acceleration(self) -> tuple[float, float]:
        """Acceleration of the origin over ground along body x and y [m/s^2], as an accelerometer there feels it."""
        J = np.zeros((6, self.code.NQ))
        self.code.jacobian.py_func(self._joint_state(), J)
        moving = [k for k, i in enumerate(self.code.FREE) if i < 3]
        ahead, aside, _ = J[:3, moving] @ (self._sign * self.data.qacc[self._place])[moving]
        return float(ahead), float(aside)

    def _write_userdata(self) -> None:
        self.data.userdata[:] = np.concatenate([self._values, self._k, self._act, [self.data.time, 1.0 / self.step]])

    def _choose(self, wanted: str, size: int) -> object:
        """The native callback if it gives the numbers of the Python one, which is in any case there."""
        plain = python_callback(self.code, size)
        if wanted == "python":
            return plain
        try:
            native.make_symbols_known()
            fast = self.code.make_native(native.layout(), size)
        except (BadPhysics, OSError, IndexError):
            return plain
        return fast.ctypes if self._agree(fast.ctypes, plain) else plain

    def _agree(self, fast: object, plain: object) -> bool:
        """Whether both callbacks give the same acceleration at a state in which every term counts."""
        self._act[:] = np.linspace(0.3, 0.7, len(self._act))
        self._write_userdata()
        found = []
        for callback in (fast, plain):
            self.data.qpos[:], self.data.qvel[:] = 0.3, np.linspace(0.2, 0.4, self.model.nv)
            with installed(callback):
                mujoco.mj_forward(self.model, self.data)
            found.append(self.data.qacc.copy())
        return bool(np.allclose(found[0], found[1], rtol=SAME, atol=SAME * np.abs(found[1]).max()))


def python_callback(code: ModuleType, size: int) -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """The callback in Python: the same compiled laws, called through the interpreter."""

    def passive(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model.nuserdata == size:
            code.passive_in_place(data.time, data.qpos, data.qvel, data.userdata, data.qfrc_passive, data.M)
            mujoco.mj_factorM(model, data)

    return passive


class installed:  # noqa: N801  # a context manager; as a class it costs a tenth of a generator's time, at every step
    """MuJoCo's callbacks are global to the process: put ours in, and take it out again whatever happens.

    Its warnings are heard and dropped, or it would write them to a file in the working folder: a motion gone wild is an
    error of ours.
    """

    def __init__(self, callback: object) -> None:
        """`callback` is a Python function or a pointer to a compiled one."""
        self.callback = callback

    def __enter__(self) -> None:
        self.heard = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(_silent)
        mujoco.set_mjcb_passive(self.callback)

    def __exit__(self, *_: object) -> None:
        mujoco.set_mjcb_passive(None)
        mujoco.set_mju_user_warning(self.heard)


def _silent(_: str) -> None:
    """Takes a warning of MuJoCo's and says nothing."""


@contextmanager
def no_callback() -> Iterator[None]:
    """Compiling any model fails while a Python callback is installed."""
    saved = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(None)
    try:
        yield
    finally:
        mujoco.set_mjcb_passive(saved)
