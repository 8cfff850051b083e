"""Many boats at once on mujoco_warp: forces and the mass of the water enter through its passive callback."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from boatsim.errors import BadInput, unknown_name
from boatsim.physics.cache import cache_folder
from boatsim.physics.commands import taken
from boatsim.physics.kernel.equations import COORDINATES, SIGN
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import world
from boatsim.warp import program as programs

SHARES, PLACES = (0.0, 0.5, 0.5, 1.0), (0, 1, 1, 2)  # of a stage in its step, and of the actuators there
IDLE = mujoco.mjtDisableBit.mjDSBL_CONSTRAINT | mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_GRAVITY


def warp() -> tuple[Any, Any]:
    """Warp and mujoco_warp, their compiled kernels kept in boatsim's folder. Raises BadInput where they are missing."""
    try:
        import mujoco_warp
        import warp as wp
    except ImportError:
        raise BadInput('a fleet on Warp needs mujoco_warp: pip install "boatsim[warp]"') from None
    if wp.config.kernel_cache_dir is None:
        wp.config.kernel_cache_dir = str(cache_folder() / "warp")
        wp.config.log_level = wp.LOG_ERROR
    return wp, mujoco_warp


class Fleet:
    """Boats of one vessel in open water, each with its own state, commands and parameters.

    States, SNAME [m, rad, m/s, rad/s], are (n, 2 NQ) as those of `boatsim.simulate.twin.Twin`; commands (n, C) in the
    vessel's order. Numbers are single precision. The motion of a boat that diverges is no longer finite; the others
    do not mind.
    """

    def __init__(self, vessel: Vessel, n: int, step: float = 0.02, device: str = "cpu") -> None:
        """`step` is the integration step in s, `device` one of Warp's. Raises BadInput for what has no form there."""
        wp, mjw = warp()
        self.vessel, self.n, self.step = vessel, n, step
        self._wp, self._mjw = wp, mjw
        self.program = Program(vessel)
        self.code = programs.module(self.program)
        try:
            self.device = wp.get_device(device)
        except (ValueError, RuntimeError):
            raise BadInput(f"device = {device!r}; allowed are {', '.join(str(d) for d in wp.get_devices())}") from None
        own = self.program.module
        model = world.build(vessel, step=step, show=False)
        joints = [model.joint(i).name for i in range(model.njnt)]
        coordinates = [COORDINATES[i] for i in own.FREE]
        self._place = np.array([joints.index(c) for c in coordinates])  # of each coordinate among MuJoCo's joints
        self._sign = np.array([float(SIGN[c]) for c in coordinates])
        model.opt.disableflags = IDLE  # open water: nothing touches anything
        with wp.ScopedDevice(self.device):
            self.model = mjw.put_model(model)
            self.data = mjw.put_data(model, mujoco.MjData(model), nworld=n, nconmax=0, njmax=0)
            self._commands = self._zeros(len(vessel.inputs))
            self._memory, self._act = self._zeros(self.program.memory_size), self._zeros(self.program.held_size)
            self._left, self._least, self._before, self._part = (self._zeros() for _ in range(4))
            self._ahead = wp.zeros(n, dtype=int)
            self._t = wp.zeros(n, dtype=wp.float64)
            self._unfinished = wp.zeros(1, dtype=int)
        self.model.opt.timestep = self._part
        self.model.opt.run_collision_detection = False
        self.model.callback.passive = self._passive
        self._stage = 0
        self._graph: Any = None
        self._values = self.program.values()[None]
        self._put_values()
        self.reset()

    def _zeros(self, width: int | None = None) -> Any:
        """(n,) or (n, width) of the device."""
        return self._wp.zeros(self.n if width is None else (self.n, width), dtype=float)

    # What a user calls ------------------------------------------------------------------------------------------------

    def reset(
        self, states: Array | Sequence[float] | None = None, commands: Array | None = None,
        boats: Sequence[int] | None = None,
    ) -> None:  # fmt: skip
        """Put boats (default: all) at t = 0 and at states (default: the origin, at rest), actuators settled at commands.

        One row of states or commands is for all of them; without commands the actuators are neutral.
        """
        code, rows = self.program.module, np.arange(self.n) if boats is None else np.asarray(boats, dtype=int)
        start = np.zeros(2 * code.NQ) if states is None else np.asarray(states, dtype=float)
        given = self._taken(self.program.command_array({}) if commands is None else commands, len(rows))
        if start.ndim == 1:
            y = np.tile(self.program.joint_rates(start), (len(rows), 1))
        else:
            y = np.array([self.program.joint_rates(s) for s in start])
        memory, act = np.zeros((len(rows), self.program.memory_size)), np.zeros((len(rows), self.program.held_size))
        for i, row in enumerate(rows):
            code.settle(given[i], memory[i], self._values[row % len(self._values)], self.program.switches(), act[i])
        q, qd = np.empty((len(rows), code.NQ)), np.empty((len(rows), code.NQ))
        q[:, self._place], qd[:, self._place] = self._sign * y[:, : code.NQ], self._sign * y[:, code.NQ :]
        for where, what in (
            (self.data.qpos, q), (self.data.qvel, qd), (self._memory, memory), (self._act, act), (self._commands, given),
            (self._t, 0.0), (self._part, 0.0), (self._left, 0.0),
        ):  # fmt: skip
            self._put(where, rows, what)

    def advance(self, commands: Array | None = None, steps: int = 1) -> None:
        """Steps under commands (n, C), one row for all, or those there are; limited to their ranges. Raises BadInput."""
        wp = self._wp
        if commands is not None:
            self._commands.assign(self._taken(commands, self.n))
        self._ahead.fill_(steps)
        for _ in range(steps):
            self._part_of_all()
        while self.program.module.HAS_PAUSE and self._left_over():
            self._part_of_all()
        with wp.ScopedDevice(self.device):
            wp.launch(self.code.finish_part, dim=self.n, inputs=[self._t, self._part])

    def set(self, parameter: str, values: Array | float) -> None:
        """A parameter of an effect, "fan_wind.speed", of each boat (n,) or of all. Raises BadInput."""
        effect, _, key = parameter.partition(".")
        known = [f"{e.name}.{k}" for e in self.program.effects for k in type(e).params()]
        if parameter not in known:
            raise BadInput(unknown_name(f"{self.vessel.name}: parameter", parameter, known))
        column, given = self.program.index(effect, key), np.asarray(values, dtype=float)
        if given.ndim and len(self._values) == 1:
            self._values = np.repeat(self._values, self.n, axis=0)
        self._values[:, column] = given
        self._put_values()

    @property
    def states(self) -> Array:
        """(n, 2 NQ) where the boats are and how they move."""
        q, qd = self.data.qpos.numpy()[:, self._place], self.data.qvel.numpy()[:, self._place]
        return self.program.body_rates(np.hstack([self._sign * q, self._sign * qd]).astype(float))

    @property
    def t(self) -> Array:
        """(n,) time of each boat since its last reset [s]."""
        found: Array = self._t.numpy()
        return found

    # On the device ----------------------------------------------------------------------------------------------------

    def _part_of_all(self) -> None:
        """A part of a step of each boat; on a GPU recorded once, and played from then on."""
        wp = self._wp
        with wp.ScopedDevice(self.device):
            if self._graph is None and self.device.is_cuda:
                wp.load_module(self.code.__name__)
                with wp.ScopedCapture() as capture:
                    self._launch()
                self._graph = capture.graph
            if self._graph is None:
                self._launch()
            else:
                wp.capture_launch(self._graph)

    def _launch(self) -> None:
        """Actuators of a part, then a Runge-Kutta step over it."""
        self._wp.launch(
            self.code.begin_part, dim=self.n,
            inputs=[
                self._commands, self.step, self._p, self._t, self._part, self._ahead, self._left, self._least,
                self._before, self._memory, self._act,
            ],
        )  # fmt: skip
        self._stage = 0
        self._mjw.step(self.model, self.data)

    def _passive(self, model: Any, data: Any) -> None:
        """mujoco_warp's callback, once for each of the four stages of a step."""
        stage, self._stage = self._stage, self._stage + 1
        self._wp.launch(
            self.code.add_forces, dim=self.n,
            inputs=[
                self._t, self._part, SHARES[stage], PLACES[stage] * int(self.program.module.HELD), data.qpos, data.qvel,
                self._act, self._p, self._k, data.qfrc_passive, data.M,
            ],
        )  # fmt: skip

    def _left_over(self) -> bool:
        """Whether any boat is still on its way, its steps having been cut."""
        self._unfinished.zero_()
        with self._wp.ScopedDevice(self.device):
            self._wp.launch(self.code.look, dim=self.n, inputs=[self._ahead, self._left, self._unfinished])
        return bool(self._unfinished.numpy()[0])

    def _put(self, where: Any, rows: Array, what: Any) -> None:
        """Rows of an array of the device."""
        found = where.numpy()
        found[rows] = what
        where.assign(found)

    def _put_values(self) -> None:
        """Parameters, and the masses that follow from them; a graph that was recorded has the old ones."""
        code = self.program.module
        k = np.zeros((len(self._values), code.K))
        for i, values in enumerate(self._values):
            code.constants(self.program.body, values, self.program.switches(), k[i])
        single = self._values.astype(np.float32)
        lost = (self._values == np.round(self._values)) & (single != self._values)
        if lost.any():
            raise BadInput(f"{self.vessel.name}: {self._values[lost][0]:.0f} is a whole number that single precision lacks")
        with self._wp.ScopedDevice(self.device):
            self._p, self._k = self._wp.array(single, dtype=float), self._wp.array(k, dtype=float)
        self._graph = None

    def _taken(self, commands: Array, n: int) -> Array:
        """(n, C) commands within their ranges."""
        rows = np.atleast_2d(np.asarray(commands, dtype=float))
        if rows.shape not in ((n, len(self.vessel.inputs)), (1, len(self.vessel.inputs))):
            raise BadInput(f"commands are {rows.shape}; allowed is ({n}, {len(self.vessel.inputs)})")
        return np.ascontiguousarray(np.broadcast_to(taken(self.vessel, rows), (n, rows.shape[1])))
