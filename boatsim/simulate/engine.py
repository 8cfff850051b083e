"""Steps a vessel on MuJoCo: added mass and all forces enter through the passive-force callback.

Files, controllers and effects use SNAME axes (z down), MuJoCo's model has z up. This module
converts states, and `add_force_and_inertia_to_mujoco` converts forces in the compiled step.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import TypedDict, Unpack

import mujoco
import numpy as np

from boatsim.errors import BadPhysics
from boatsim.physics.compiled_program import CompiledProgram
from boatsim.physics.debugging import DEBUG, python_function
from boatsim.physics.kernel.equations import COORDINATES, SIGN
from boatsim.physics.native.calls import partial_call
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import native_callback, world
from boatsim.simulate.stepper import State, Stepper
from boatsim.simulate.tank import Tank

# From version 4 on a Runge-Kutta step of MuJoCo leaves the mean acceleration over the step, before
# that of its last stage, at the end of the step
MEAN_ACCELERATION = int(mujoco.__version__.partition(".")[0]) >= 4
# relative difference allowed between the native callback and the one in Python at start-up
SAME = 1e-12


class ModelOptions(TypedDict, total=False):
    """Options for building the MuJoCo model of a vessel in a tank, see `world.build_model`."""

    show: bool
    wall_solref: tuple[float, float] | None
    friction: float


class Engine(Stepper):
    """Simulation of one vessel in one tank on MuJoCo.

    Attributes:
        tank: The tank.
        model: The model of MuJoCo.
        data: Its state.
        callback: The passive-force callback, a pointer or a function.
    """

    def __init__(
        self,
        vessel: Vessel,
        tank: Tank | None = None,
        step: float = 0.02,
        *,
        callback: str = "native",
        **options: Unpack[ModelOptions],
    ) -> None:
        """Build the model with the vessel at the origin, at rest.

        Args:
            vessel: The vessel.
            tank: The tank; default: open water.
            step: Integration step [s].
            callback: "native", which falls back to "python" with a warning where the two differ,
                or "python".
            **options: Options of `world.build_model`.

        Raises:
            BadInput: If the hull cannot be read.
            BadPhysics: If the model cannot be stepped.
        """
        super().__init__(Program(vessel), step)
        self.tank = tank or world.open_water(vessel)
        self._k = np.zeros(self.code.K)
        self.code.compute_mass_constants(self.program.body, self._values, self._on, self._k)
        size = len(self._values) + self.code.K + self.program.actuator_signal_size + 2
        with without_passive_callback():
            self.model = world.build_model(vessel, self.tank, step, size, **options)
            self.data = mujoco.MjData(self.model)
        joints = [self.model.joint(i).name for i in range(self.model.njnt)]
        coordinates = [COORDINATES[i] for i in self.code.FREE]
        # place of each coordinate among MuJoCo's joints
        self._place = np.array(list(map(joints.index, coordinates)))
        # SNAME = sign * z-up, for coordinates and rates
        self._sign = np.array([float(SIGN[name]) for name in coordinates])
        self._held = self.data.userdata[-self.program.actuator_signal_size - 2 :]
        self.callback = self._choose_callback(callback, size)
        self.reset()

    @property
    def t(self) -> float:
        """Simulated time [s]."""
        return float(self.data.time)

    def _set_joint_state(self, t: float, state: Array) -> None:
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = t
        self.data.qpos[self._place] = self._sign * state[: self.code.NQ]
        self.data.qvel[self._place] = self._sign * state[self.code.NQ :]

    def settle_actuators(self) -> None:
        """Set the actuators of the vessel to the steady state of their commands."""
        super().settle_actuators()
        self._write_userdata()

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Integrate the motion of the vessel over some steps with constant commands.

        Args:
            steps: Number of steps.
            length: Length of each step [s]; default: `step`.

        Raises:
            BadPhysics: If the motion diverges.
        """
        with installed_callback(self.callback):
            super().advance(steps, length)
        self.model.opt.timestep = self.step  # a step may have been cut

    def _advance(self, length: float) -> None:
        """One step of `length` s, cut where the signal of an actuator has a jump or a kink."""
        left, least, before = length, self.code.SHORTEST, 0.0
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
            self._mean += self._mean_actuators() * (dt / length)
            left -= dt

    def _step(self, dt: float) -> None:
        """Take one step of dt [s] with fixed actuators."""
        self.model.opt.timestep = dt
        self._held[:-2] = self._act
        self._held[-2:] = self.data.time, 1.0 / dt
        mujoco.mj_step(self.model, self.data)

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

    def advance_without_actuators(self, steps: int) -> None:
        """Take steps in MuJoCo's own loop with actuators held in place, for benchmarks."""
        with installed_callback(self.callback):
            mujoco.mj_step(self.model, self.data, nstep=steps)

    def _joint_state(self) -> Array:
        q, qd = self.data.qpos[self._place], self.data.qvel[self._place]
        return np.concatenate([self._sign * q, self._sign * qd])

    @property
    def contacts(self) -> int:
        """Number of contacts of the hull with walls, as MuJoCo detects them."""
        return int(self.data.ncon)

    def acceleration(self) -> tuple[float, float]:
        """Return the acceleration over ground of the vessel's origin along body x, y [m/s^2]."""
        if MEAN_ACCELERATION and self.data.qacc.any():  # all zero before the first step
            with installed_callback(self.callback):
                mujoco.mj_forward(self.model, self.data)
        J = self.program.jacobian(self._joint_state().tolist())
        moving = [k for k, i in enumerate(self.code.FREE) if i < 3]
        ahead, aside, _ = J[:3, moving] @ (self._sign * self.data.qacc[self._place])[moving]
        return float(ahead), float(aside)

    def _write_userdata(self) -> None:
        self.data.userdata[:] = np.concatenate(
            [self._values, self._k, self._act, [self.data.time, 1.0 / self.step]]
        )

    def _choose_callback(self, wanted: str, size: int) -> object:
        """The native callback if it agrees with the one in Python, which always works."""
        plain = python_callback(self.code, size)
        if wanted == "python" or DEBUG:
            return plain
        try:
            fast = native_callback.compile_native(self.code, size)
        except BadPhysics as error:
            native_callback.warn_of_slow_callback(str(error))
            return plain
        if not self._callbacks_agree(fast, plain):
            native_callback.warn_of_slow_callback("its accelerations differ from those in Python")
            return plain
        return fast

    def _callbacks_agree(self, fast: object, plain: object) -> bool:
        """Whether both callbacks give the same acceleration at a state in which all terms count."""
        self._act[:] = np.linspace(0.3, 0.7, len(self._act))
        self._write_userdata()
        found = []
        for callback in (fast, plain):
            self.data.qpos[:], self.data.qvel[:] = 0.3, np.linspace(0.2, 0.4, self.model.nv)
            with installed_callback(callback):
                mujoco.mj_forward(self.model, self.data)
            found.append(self.data.qacc.copy())
        return bool(np.allclose(found[0], found[1], rtol=SAME, atol=SAME * np.abs(found[1]).max()))


def python_callback(
    code: CompiledProgram, size: int
) -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """Return a vessel's passive-force callback for MuJoCo as a Python function.

    It calls the same compiled functions as the native callback, through the interpreter.

    Args:
        code: The vessel's compiled program.
        size: Size of the model's userdata, by which the callback recognises its model.
    """

    def add_passive_forces(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if model.nuserdata == size:
            code.add_passive_forces_in_place(
                data.time, data.qpos, data.qvel, data.userdata, data.qfrc_passive, data.M
            )
            mujoco.mj_factorM(model, data)

    return add_passive_forces


class installed_callback:  # noqa: N801
    """Context manager that installs a passive-force callback of MuJoCo, for the whole process.

    MuJoCo's warnings are dropped in the block; it would write them to a file in the working folder,
    and a diverging motion is reported as an error. It is a class because that takes a tenth of the
    time of a generator, and it is used at every step.
    """

    def __init__(self, callback: object) -> None:
        """Prepare.

        Args:
            callback: A Python function or a pointer to a compiled one.
        """
        self.callback = callback

    def __enter__(self) -> None:
        self._warning = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(_ignore_warning)
        mujoco.set_mjcb_passive(self.callback)

    def __exit__(self, *_: object) -> None:
        mujoco.set_mjcb_passive(None)
        mujoco.set_mju_user_warning(self._warning)


def _ignore_warning(_: str) -> None:
    """Drop a warning of MuJoCo."""


@contextmanager
def without_passive_callback() -> Iterator[None]:
    """Remove MuJoCo's passive-force callback within a `with` block.

    A callback in Python prevents the compilation of models.
    """
    saved = mujoco.get_mjcb_passive()
    mujoco.set_mjcb_passive(None)
    try:
        yield
    finally:
        mujoco.set_mjcb_passive(saved)


__all__ = ["Engine", "State", "installed_callback", "without_passive_callback", "python_callback"]
