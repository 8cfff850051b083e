"""Steps a vessel on MuJoCo: added mass and all forces enter through the passive-force callback.

Files, controllers and effects are SNAME (z down); MuJoCo's model is z up. The translation is `to_joints` and
`from_joints` here for people and files, and `add_to_mujoco` in the kernels for the compiled step; nowhere else.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from math import cos, isfinite, sin
from typing import Any, NamedTuple

import mujoco
import numpy as np

from boatsim.errors import BadPhysics
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.simulate import native, world
from boatsim.simulate.world import Tank

SIGN = {"x": 1.0, "y": -1.0, "psi": -1.0, "phi": 1.0}  # SNAME = sign * z-up, coordinate and rate alike
SAME = 1e-12  # relative: native and Python callback must agree to this at start-up


class State(NamedTuple):
    """Where the boat is and how it moves: SNAME, pose in start axes, velocities in body axes over ground."""

    t: float  # [s]
    x: float  # [m]
    y: float  # [m]
    psi: float  # [rad]
    phi: float  # [rad]
    u: float  # [m/s]
    v: float  # [m/s]
    p: float  # [rad/s]
    r: float  # [rad/s]


def to_joints(state: State, names: list[str]) -> tuple[Array, Array]:
    """Joint positions and rates, z up, of a state."""
    c, s = np.cos(state.psi), np.sin(state.psi)
    rates = {"x": c * state.u - s * state.v, "y": s * state.u + c * state.v, "psi": state.r, "phi": state.p}
    q = np.array([SIGN[n] * getattr(state, n) for n in names])
    return q, np.array([SIGN[n] * rates[n] for n in names])


def from_joints(t: float, q: Array, qd: Array, names: list[str]) -> State:
    """State of joint positions and rates, z up."""
    pose = {n: SIGN[n] * a for n, a in zip(names, q.tolist(), strict=True)}
    rate = {n: SIGN[n] * a for n, a in zip(names, qd.tolist(), strict=True)}
    psi, xd, yd = pose.get("psi", 0.0), rate.get("x", 0.0), rate.get("y", 0.0)
    c, s = cos(psi), sin(psi)
    return State(
        t, pose.get("x", 0.0), pose.get("y", 0.0), psi, pose.get("phi", 0.0), c * xd + s * yd, c * yd - s * xd,
        rate.get("phi", 0.0), rate.get("psi", 0.0),
    )  # fmt: skip


class Engine:
    """One vessel in one tank. `command` sets what is sent to the actuators, `advance` steps."""

    def __init__(
        self, vessel: Vessel, tank: Tank | None = None, step: float = 0.02, *, callback: str = "native", **look: Any
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
        size = len(self._values) + self.code.K + self.code.HELD
        with no_callback():
            self.model = world.build(vessel, self.tank, step, size, **look)
            self.data = mujoco.MjData(self.model)
        self.joints = [self.model.joint(i).name for i in range(self.model.njnt)]
        self._commands = np.zeros(len(vessel.commands))
        self._memory = np.zeros(self.program.memory_size)
        self._act = np.zeros(self.code.HELD)
        self._held = self.data.userdata[-self.code.HELD :]
        self.callback = self._choose(callback, size)
        self.reset()

    def reset(self, state: State | None = None, commands: Mapping[str, float] | None = None) -> None:
        """Put the boat at a state (default: origin, at rest, t = 0), its actuators settled at the given commands."""
        state = state or State(*[0.0] * 9)
        mujoco.mj_resetData(self.model, self.data)
        self.data.time = state.t
        self.data.qpos[:], self.data.qvel[:] = to_joints(state, self.joints)
        self._memory[:] = 0.0
        self.command(commands or {})
        self.settle()

    def settle(self) -> None:
        """Let the actuators reach their commands at once."""
        self.code.settle(self._commands, self._memory, self._values, self._on, self._act)
        self._write_userdata()

    def command(self, commands: Mapping[str, float]) -> None:
        """What is sent to the actuators from now on; limited to its range, neutral where not named. Raises BadInput."""
        self._commands[:] = self.program.command_array(commands)

    @property
    def commands(self) -> dict[str, float]:
        """Commands in force."""
        return dict(zip(self.vessel.commands, self._commands.tolist(), strict=True))

    def advance(self, steps: int = 1, length: float | None = None) -> None:
        """Steps of `length` s (default: `step`) with the commands held. Raises BadPhysics if the motion diverges."""
        with installed(self.callback):
            for _ in range(steps):
                self._advance(self.step if length is None else length)
        self.model.opt.timestep = self.step  # a step may have been cut
        if not isfinite(sum(self.data.qpos.tolist())):
            raise BadPhysics(f"{self.vessel.name}: the motion is no longer finite at t = {self.data.time:g} s")

    def _advance(self, left: float) -> None:
        """One step of `left` s, cut where an actuator's signal jumps."""
        while left > 1e-9:
            dt = left
            if self.code.PAUSES:
                dt = min(
                    left, max(self.code.pause(self._commands, self._memory, self._values, self._on), self.code.SHORTEST)
                )
            self.model.opt.timestep = dt
            self.code.actuate_in_place(self._commands, self._memory, dt, self._values, self._on, self._act)
            self._held[:] = self._act
            mujoco.mj_step(self.model, self.data)
            left -= dt

    def coast(self, steps: int) -> None:
        """Many steps inside MuJoCo's own loop with the actuators as they are: what benchmarks measure."""
        with installed(self.callback):
            mujoco.mj_step(self.model, self.data, nstep=steps)

    @property
    def state(self) -> State:
        """The present state."""
        return from_joints(self.data.time, self.data.qpos, self.data.qvel, self.joints)

    @property
    def actuators(self) -> dict[str, float]:
        """Mean of each actuator over the last step."""
        return dict(zip(self.vessel.actuators, self._act.tolist(), strict=False))

    @property
    def contacts(self) -> int:
        """How many contacts the hull has now."""
        return int(self.data.ncon)

    def wrench(self) -> tuple[float, float, float, float]:
        """Sum of all force laws (X, Y, K, N) in body axes at the present state [N, N m]."""
        q, qd = self.data.qpos, self.data.qvel
        y = np.array([SIGN[n] * x for values in (q, qd) for n, x in zip(self.joints, values, strict=True)])
        total = [0.0] * 4
        found = self.code.forces(self.data.time, y, self._act, self._values, self._on)
        for axis, force in zip(self.code.FREEDOMS, found, strict=True):
            total[axis] = force
        return total[0], total[1], total[2], total[3]

    def acceleration(self) -> tuple[float, float]:
        """Acceleration of the CG over ground along body x and y [m/s^2], as an accelerometer there feels it."""
        qdd = dict(zip(self.joints, self.data.qacc.tolist(), strict=True))
        psi = -float(self.data.qpos[self.joints.index("psi")]) if "psi" in self.joints else 0.0
        c, s = cos(psi), sin(psi)
        xdd, ydd = qdd.get("x", 0.0), -qdd.get("y", 0.0)
        return c * xdd + s * ydd, c * ydd - s * xdd

    def _write_userdata(self) -> None:
        self.data.userdata[:] = np.concatenate([self._values, self._k, self._act])

    def _choose(self, wanted: str, size: int) -> Any:
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

    def _agree(self, fast: Any, plain: Callable[..., None]) -> bool:
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


def python_callback(code: Any, size: int) -> Callable[[Any, Any], None]:
    """The callback in Python: the same compiled laws, called through the interpreter."""

    def passive(model: Any, data: Any) -> None:
        if model.nuserdata == size:
            code.passive_in_place(data.time, data.qpos, data.qvel, data.userdata, data.qfrc_passive, data.M)
            mujoco.mj_factorM(model, data)

    return passive


class installed:  # noqa: N801  # a context manager; as a class it costs a tenth of a generator's time, at every step
    """MuJoCo's callbacks are global to the process: put ours in, and take it out again whatever happens.

    Its warnings are heard and dropped, or it would write them to a file in the working folder: a motion gone wild is an
    error of ours.
    """

    def __init__(self, callback: Any) -> None:
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
