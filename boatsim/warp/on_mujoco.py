"""The motion of a batch on mujoco_warp: forces and added mass enter through its passive callback.

mujoco_warp integrates all worlds together by MuJoCo's Runge-Kutta method. Each boat has its own
step length, so that it can end a step where a signal of its actuators jumps or bends and continue
from there while other boats are ahead.
"""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.physics.kernel.equations import COORDINATES, SIGN
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import world
from boatsim.warp.device_state import DeviceBoats

# Stages of a Runge-Kutta step: share of the step; actuators at its begin, middle or end
STAGES = ((0.0, 0), (0.5, 1), (0.5, 1), (1.0, 2))
# Arrays of the model that differ between vessels with different loads
BODY = ("body_mass", "body_subtreemass", "body_inertia", "body_ipos", "jnt_pos")
IDLE = (
    mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_GRAVITY
)


class MujocoMotion:
    """Motion of a batch of boats on mujoco_warp: each boat is a world of one MuJoCo model."""

    def __init__(self, boats: DeviceBoats, vessels: Sequence[Vessel]) -> None:
        """Build the models.

        Args:
            boats: Arrays on the device.
            vessels: The vessels that can be assigned to boats.

        Raises:
            BadInput: mujoco_warp is not installed.
        """
        try:
            import mujoco_warp
        except ImportError:
            raise BadInput(
                'a batch on MuJoCo needs mujoco_warp: pip install "boatsim[warp]"'
            ) from None
        self.boats, self._mjw = boats, mujoco_warp
        self._models = [world.build_model(v, step=boats.step, show=False) for v in vessels]
        model = self._models[0]
        model.opt.disableflags = IDLE  # no contacts; all forces come from the callback
        joints = [model.joint(i).name for i in range(model.njnt)]
        coordinates = [COORDINATES[i] for i in boats.code.FREE]
        # place of each coordinate among MuJoCo's joints
        self._place = np.array(list(map(joints.index, coordinates)))
        self._sign = np.array([float(SIGN[c]) for c in coordinates])
        with boats.wp.ScopedDevice(boats.device):
            self.model = mujoco_warp.put_model(model)
            self.data = mujoco_warp.put_data(
                model, mujoco.MjData(model), nworld=boats.n, nconmax=0, njmax=0
            )
        self._part, self._left, self._least, self._before = (
            boats.zeros_per_boat() for _ in range(4)
        )
        self._ahead = boats.copy_to_device(np.zeros(boats.n), int)
        self._unfinished = boats.copy_to_device(np.zeros(1), int)
        self.model.opt.timestep = self._part
        self.model.opt.run_collision_detection = False
        self.model.callback.passive = self._passive_callback
        self._stage = 0
        self._graph: Any = None
        self._recorded = -1

    def assign_vessels(self, numbers: NDArray[np.int64]) -> None:
        """Assign vessels to boats of a batch: each world gets mass, inertia and joints of its hull.

        Args:
            numbers: (n,) number of each boat's vessel.
        """
        b = self.boats
        if len(self._models) == 1:
            return
        for name in BODY:
            values = np.stack([getattr(m, name) for m in self._models])[numbers]
            array = getattr(self.model, name)
            if len(array) == b.n:
                array.assign(values)
            else:
                setattr(self.model, name, b.copy_to_device(values, array.dtype))
                b.record_reallocation()

    def set_states(self, y: Array) -> None:
        """Set joint coordinates and rates of all simulated boats.

        Args:
            y: (n, 2 NQ) joint coordinates and rates.
        """
        half = y.shape[1] // 2
        for where, what in ((self.data.qpos, y[:, :half]), (self.data.qvel, y[:, half:])):
            turned = np.empty(what.shape)
            turned[:, self._place] = self._sign * what
            where.assign(turned)

    def states(self) -> Array:
        """Return joint coordinates and rates of all boats (n, 2 NQ)."""
        q, qd = self.data.qpos.numpy()[:, self._place], self.data.qvel.numpy()[:, self._place]
        return np.hstack([self._sign * q, self._sign * qd]).astype(float)

    def accelerations(self) -> Array:
        """Return the present accelerations of the joint coordinates of all boats (n, NQ)."""
        self._stage = 0
        with self.boats.wp.ScopedDevice(self.boats.device):
            self._mjw.forward(self.model, self.data)
        return np.asarray(self._sign * self.data.qacc.numpy()[:, self._place], dtype=float)

    def advance(self, steps: int) -> None:
        """Integrate the motion of all boats under their commands until the last one has finished.

        Args:
            steps: Number of steps.
        """
        b = self.boats
        with b.wp.ScopedDevice(b.device):
            if b.device.is_cuda and self._recorded != b.reallocations:
                self._record_graph()
            self._ahead.fill_(steps)
            for _ in range(steps):
                self._advance_part()
            while b.code.HAS_TIME_TO_DISCONTINUITY and self._has_steps_left():
                self._advance_part()
        b.launch_kernel("rest", self._part)

    def _advance_part(self) -> None:
        """Integrate a part of a step of each boat."""
        if self._graph is None:
            self._step_all_boats()
        else:
            self.boats.wp.capture_launch(self._graph)

    def _record_graph(self) -> None:
        """Record a part as a graph of the GPU, after compiling everything in it."""
        self._step_all_boats()  # no boat has steps left: nothing moves
        with self.boats.wp.ScopedCapture() as capture:
            self._step_all_boats()
        self._graph, self._recorded = capture.graph, self.boats.reallocations

    def _step_all_boats(self) -> None:
        """Advance the actuators of each boat over a part of its step, then its motion."""
        b = self.boats
        b.launch_kernel(
            "begin_part",
            b.commands,
            b.step,
            b.p,
            b.t,
            self._part,
            self._ahead,
            self._left,
            self._least,
            self._before,
            b.memory,
            b.act,
        )
        self._stage = 0
        self._mjw.step(self.model, self.data)

    def _passive_callback(self, model: Any, data: Any) -> None:
        """Callback of mujoco_warp, called once for each stage."""
        (share, place), self._stage, b = STAGES[self._stage], self._stage + 1, self.boats
        at = place * int(b.code.HELD)
        b.launch_kernel(
            "add_forces",
            b.t,
            self._part,
            share,
            at,
            data.qpos,
            data.qvel,
            b.act,
            b.p,
            b.k,
            data.qfrc_passive,
            data.M,
        )

    def _has_steps_left(self) -> bool:
        """Whether any boat has steps left."""
        self._unfinished.zero_()
        self.boats.launch_kernel("find_unfinished", self._ahead, self._left, self._unfinished)
        return bool(self._unfinished.numpy()[0])
