"""A batch's motion on mujoco_warp: forces and the mass of the water enter through its passive callback.

mujoco_warp steps all its worlds together, by MuJoCo's Runge-Kutta method. Each boat has a step length of its own there,
so that each may end a step where a signal of its actuators jumps or bends, and go on from there while others are ahead.
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
from boatsim.warp.device_state import Boats

STAGES = (
    (0.0, 0),
    (0.5, 1),
    (0.5, 1),
    (1.0, 2),
)  # of a step: its share, and the actuators at begin, middle or end
BODY = (
    "body_mass",
    "body_subtreemass",
    "body_inertia",
    "body_ipos",
    "jnt_pos",
)  # what loads differ in
IDLE = (
    mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_GRAVITY
)


class OnMujoco:
    """All boats as the worlds of one model in open water."""

    def __init__(self, boats: Boats, vessels: Sequence[Vessel]) -> None:
        """`vessels` are those that boats may be of. Raises BadInput where mujoco_warp is missing."""
        try:
            import mujoco_warp
        except ImportError:
            raise BadInput(
                'a batch on MuJoCo needs mujoco_warp: pip install "boatsim[warp]"'
            ) from None
        self.boats, self._mjw = boats, mujoco_warp
        self._models = [world.build(v, step=boats.step, show=False) for v in vessels]
        model = self._models[0]
        model.opt.disableflags = IDLE  # nothing touches anything; its forces are ours
        joints = [model.joint(i).name for i in range(model.njnt)]
        coordinates = [COORDINATES[i] for i in boats.code.FREE]
        self._place = np.array(
            [joints.index(c) for c in coordinates]
        )  # of each coordinate among MuJoCo's joints
        self._sign = np.array([float(SIGN[c]) for c in coordinates])
        with boats.wp.ScopedDevice(boats.device):
            self.model = mujoco_warp.put_model(model)
            self.data = mujoco_warp.put_data(
                model, mujoco.MjData(model), nworld=boats.n, nconmax=0, njmax=0
            )
        self._part, self._left, self._least, self._before = (boats.zeros() for _ in range(4))
        self._ahead = boats.filled(np.zeros(boats.n), int)
        self._unfinished = boats.filled(np.zeros(1), int)
        self.model.opt.timestep = self._part
        self.model.opt.run_collision_detection = False
        self.model.callback.passive = self._passive
        self._stage = 0
        self._graph: Any = None
        self._recorded = -1

    def take(self, numbers: NDArray[np.int64]) -> None:
        """Boats become of the vessels of these numbers (n,): each world has its hull's mass, inertia and joints."""
        b = self.boats
        for name in BODY if len(self._models) > 1 else ():
            found, there = (
                np.stack([getattr(m, name) for m in self._models])[numbers],
                getattr(self.model, name),
            )
            if len(there) == b.n:
                there.assign(found)
            else:
                setattr(self.model, name, b.filled(found, there.dtype))
                b.moves += 1

    def put(self, y: Array) -> None:
        """States (n, 2 NQ), joint coordinates and rates."""
        half = y.shape[1] // 2
        for where, what in ((self.data.qpos, y[:, :half]), (self.data.qvel, y[:, half:])):
            turned = np.empty(what.shape)
            turned[:, self._place] = self._sign * what
            where.assign(turned)

    def states(self) -> Array:
        """(n, 2 NQ)."""
        q, qd = self.data.qpos.numpy()[:, self._place], self.data.qvel.numpy()[:, self._place]
        return np.hstack([self._sign * q, self._sign * qd]).astype(float)

    def accelerations(self) -> Array:
        """(n, NQ) of the joint coordinates, of what is on the device now."""
        self._stage = 0
        with self.boats.wp.ScopedDevice(self.boats.device):
            self._mjw.forward(self.model, self.data)
        return np.asarray(self._sign * self.data.qacc.numpy()[:, self._place], dtype=float)

    def advance(self, steps: int) -> None:
        """Steps under the commands there are; boats that cut theirs take longer, and the last one is waited for."""
        b = self.boats
        with b.wp.ScopedDevice(b.device):
            if b.device.is_cuda and self._recorded != b.moves:  # a graph knows where parameters lay
                self._record()
            self._ahead.fill_(steps)
            for _ in range(steps):
                self._all_on()
            while b.code.HAS_PAUSE and self._any_left():
                self._all_on()
        b.launch("rest", self._part)

    def _all_on(self) -> None:
        """A part of a step of each boat."""
        if self._graph is None:
            self._part_of_all()
        else:
            self.boats.wp.capture_launch(self._graph)

    def _record(self) -> None:
        """Note down a part once as a graph of the GPU's, which is launched as a whole; all is compiled before."""
        self._part_of_all()  # nobody has steps ahead: nothing moves
        with self.boats.wp.ScopedCapture() as capture:
            self._part_of_all()
        self._graph, self._recorded = capture.graph, self.boats.moves

    def _part_of_all(self) -> None:
        """Actuators over a part of each boat's own step, then a Runge-Kutta step as long."""
        b = self.boats
        b.launch(
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

    def _passive(self, model: Any, data: Any) -> None:
        """mujoco_warp's callback, once a stage."""
        (share, place), self._stage, b = STAGES[self._stage], self._stage + 1, self.boats
        at = place * int(b.code.HELD)
        b.launch(
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

    def _any_left(self) -> bool:
        """Whether any boat is still on its way."""
        self._unfinished.zero_()
        self.boats.launch("look", self._ahead, self._left, self._unfinished)
        return bool(self._unfinished.numpy()[0])
