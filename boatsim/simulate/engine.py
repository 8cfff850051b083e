"""Steps a vessel on MuJoCo: added mass and all forces enter through the passive-force callback.

Files, controllers and effects are SNAME (z down); MuJoCo's model is z up. The translation is here for people and files,
and in `add_to_mujoco` of the equations for the compiled step; nowhere else.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypedDict, Unpack

import mujoco
import numpy as np

from boatsim.errors import BadPhysics
from boatsim.physics.compiled_program import CompiledProgram
from boatsim.physics.debugging import DEBUG
from boatsim.physics.kernel.equations import COORDINATES, SIGN
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import native_callback, world
from boatsim.simulate.stepper import State, Stepper
from boatsim.simulate.world import Tank

SAME = 1e-12  # relative: native and Python callback must agree to this at start-up


class Look(TypedDict, total=False):
    """What `world.build` may be told of the model beside its vessel and tank."""

    show: bool
    wall_solref: tuple[float, float] | None
    friction: float


class Engine(Stepper):
    """One vessel in one tank."""

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

        `callback` is "native" (which falls back to "python", with a warning, where the two differ) or "python".
        """
        super().__init__(vessel, step)
        self.tank = tank or world.open_water(vessel)
        self._k = np.zeros(self.code.K)
        self.code.constants(self.program.body, self._values, self._on, self._k)
        size = len(self._values) + self.code.K + self.program.held_size + 2
        with no_callback():
            self.model = world.build(vessel, self.tank, step, size, **look)
            self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(i).name for i in range(self.model.njnt)]
        coordinates = [COORDINATES[i] for i in self.code.FREE]
        self._place = np.array(
            [joints.index(n) for n in coordinates]
        )  # of each coordinate among MuJoCo's joints
        self._sign = np.array(
            [float(SIGN[n]) for n in coordinates]
        )  # SNAME = sign * z-up, coordinate and rate alike
        self._held = self.data.userdata[-self.program.held_size - 2 :]
        self.callback = self._choose(callback, size)
        self.reset()

    @property
    def t(self) -> float:
        """Time [s]."""
        return float(self.data.time)

    def _put(self, t: float, state: Array) -> None:
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = t
        self.data.qpos[self._place] = self._sign * state[: self.code.NQ]
        self.data.qvel[self._place] = self._sign * state[self.code.NQ :]

    def settle(self) -> None:
        """Let the actuators reach their commands at once."""
        super().settle()
        self._write_userdata()

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Steps of `length` s (default: `step`) with the commands held. Raises BadPhysics if the motion diverges."""
        with installed(self.callback):
            super().advance(steps, length)
        self.model.opt.timestep = self.step  # a step may have been cut

    def _step(self, dt: float) -> None:
        self.model.opt.timestep = dt
        self._held[:-2] = self._act
        self._held[-2:] = self.data.time, 1.0 / dt
        mujoco.mj_step(self.model, self.data)

    def coast(self, steps: int) -> None:
        """Many steps inside MuJoCo's own loop with the actuators as they are: what benchmarks measure."""
        with installed(self.callback):
            mujoco.mj_step(self.model, self.data, nstep=steps)

    def _joint_state(self) -> Array:
        q, qd = self.data.qpos[self._place], self.data.qvel[self._place]
        return np.concatenate([self._sign * q, self._sign * qd])

    @property
    def contacts(self) -> int:
        """How many contacts the hull has now."""
        return int(self.data.ncon)

    def acceleration(self) -> tuple[float, float]:
        """Acceleration of the origin over ground along body x and y [m/s^2], as an accelerometer there feels it."""
        J = self.program.jacobian(self._joint_state().tolist())
        moving = [k for k, i in enumerate(self.code.FREE) if i < 3]
        ahead, aside, _ = J[:3, moving] @ (self._sign * self.data.qacc[self._place])[moving]
        return float(ahead), float(aside)

    def _write_userdata(self) -> None:
        self.data.userdata[:] = np.concatenate(
            [self._values, self._k, self._act, [self.data.time, 1.0 / self.step]]
        )

    def _choose(self, wanted: str, size: int) -> object:
        """The native callback if it gives the same numbers as the one in Python, which always works."""
        plain = python_callback(self.code, size)
        if wanted == "python" or DEBUG:
            return plain
        try:
            fast = native_callback.compile_native(self.code, size)
        except BadPhysics as error:
            native_callback.warn_of_slow_callback(str(error))
            return plain
        if not self._agree(fast, plain):
            native_callback.warn_of_slow_callback("its accelerations differ from those in Python")
            return plain
        return fast

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


def python_callback(
    code: CompiledProgram, size: int
) -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """The callback in Python: the same compiled laws, called through the interpreter."""

    def passive(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model.nuserdata == size:
            code.passive_in_place(
                data.time, data.qpos, data.qvel, data.userdata, data.qfrc_passive, data.M
            )
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


__all__ = ["Engine", "State", "installed", "no_callback", "python_callback"]
