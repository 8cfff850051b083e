"""The same laws without MuJoCo: the same joint coordinates, the same Runge-Kutta method, in compiled code.

For fits, replays and large batches; must agree with `boatsim.simulate.engine` to rounding.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.commands import clip
from boatsim.physics.kernel.records import Model
from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel


class Twin:
    """One vessel without walls.

    States, SNAME [m, rad, m/s, rad/s], are the coordinates (x, y, z, phi, theta, psi) and the body rates (u, v, w, p,
    q, r) of the freedoms that the vessel has: (x, y, psi, u, v, r) in the plane.
    """

    def __init__(self, vessel: Vessel, step: float = 0.02) -> None:
        """`step` is the integration step in s."""
        self.vessel, self.step = vessel, step
        self.program = Program(vessel)
        self.code = self.program.module
        self._values, self._on = self.program.values(), self.program.switches()

    def rollout(
        self,
        start: Sequence[float],
        commands: Array,
        interval: float,
        values: Array | None = None,
        t0: float = 0.0,
    ) -> Array:
        """Free run: row i of commands (N, C), in the vessel's order, is held for `interval` s; states (N + 1, 2 NQ).

        Commands act within their channels' ranges; actuators start settled at the first row. Raises BadInput unless
        the step divides the interval.
        """
        substeps = round(interval / self.step)
        if substeps < 1 or abs(substeps * self.step - interval) > 1e-9 * interval:
            raise BadInput(f"step {self.step:g} s does not divide the interval {interval:g} s")
        p = self._values if values is None else values
        commands = np.ascontiguousarray(clip(self.vessel, np.asarray(commands, dtype=float)))
        model = Model(self.program.body, p, self._on)
        plant = self.program.plant(self.program.joint_rates(np.array(start, dtype=float)))
        self.code.settle(commands[0], plant.memory, p, self._on, plant.act)
        out = np.empty((len(commands) + 1, len(plant.y)))
        self.code.rollout(model, plant, commands, t0, self.step, substeps, out)
        return self.program.body_rates(out)

    def coast(self, start: Sequence[float], commands: Mapping[str, float], steps: int) -> Array:
        """State after many steps with constant commands and settled actuators: what benchmarks measure."""
        act, k = np.zeros(self.program.held_size), np.zeros(self.code.K)
        memory = np.zeros(self.program.memory_size)
        self.code.settle(self.program.command_array(commands), memory, self._values, self._on, act)
        self.code.constants(self.program.body, self._values, self._on, k)
        y = self.program.joint_rates(np.array(start, dtype=float))
        self.code.steps(0.0, y, self.step, steps, act, self._values, self._on, k)
        state: Array = self.program.body_rates(y[None])[0]
        return state
