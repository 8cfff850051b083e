"""The same laws without MuJoCo: the same joint coordinates, the same Runge-Kutta method, in compiled code.

For fits, replays and large batches; must agree with `boatsim.simulate.engine` to rounding.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.commands import taken
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel


def body_rates(y: Array) -> Array:
    """States (..., 2 NQ) of kernels, earth-axes velocities x', y' replaced by u, v; roll alone as it is."""
    out, nq = np.array(y, dtype=float), y.shape[-1] // 2
    if nq > 1:
        c, s = np.cos(y[..., 2]), np.sin(y[..., 2])
        out[..., nq] = c * y[..., nq] + s * y[..., nq + 1]
        out[..., nq + 1] = c * y[..., nq + 1] - s * y[..., nq]
    return out


def earth_rates(y: Array) -> Array:
    """The inverse of `body_rates`."""
    out, nq = np.array(y, dtype=float), y.shape[-1] // 2
    if nq > 1:
        c, s = np.cos(y[..., 2]), np.sin(y[..., 2])
        out[..., nq] = c * y[..., nq] - s * y[..., nq + 1]
        out[..., nq + 1] = s * y[..., nq] + c * y[..., nq + 1]
    return out


class Twin:
    """One vessel without walls.

    States, SNAME [m, rad, m/s, rad/s], are (x, y, psi, u, v, r), with roll (x, y, psi, phi, u, v, r, p), or (phi, p)
    for roll alone.
    """

    def __init__(self, vessel: Vessel, step: float = 0.02) -> None:
        """`step` is the integration step in s."""
        self.vessel, self.step = vessel, step
        self.program = Program(vessel)
        self.code = self.program.module
        self._values, self._on = self.program.values(), self.program.switches()
        self._none = np.zeros(4)

    def rollout(
        self, start: Sequence[float], commands: Array, interval: float, values: Array | None = None, t0: float = 0.0
    ) -> Array:
        """Free run: row i of commands (N, C), in the vessel's order, is held for `interval` s; states (N + 1, 2 NQ).

        Commands act within their channels' ranges; actuators start settled at the first row. Raises BadInput unless
        the step divides the interval.
        """
        substeps = round(interval / self.step)
        if substeps < 1 or abs(substeps * self.step - interval) > 1e-9 * interval:
            raise BadInput(f"step {self.step:g} s does not divide the interval {interval:g} s")
        p = self._values if values is None else values
        memory, act = np.zeros(self.program.memory_size), np.zeros(self.code.HELD)
        commands = np.ascontiguousarray(taken(self.vessel, np.asarray(commands, dtype=float)))
        self.code.settle(commands[0], memory, p, self._on, act)
        y = earth_rates(np.array(start, dtype=float))
        out = np.empty((len(commands) + 1, len(y)))
        self.code.rollout(
            t0, y, commands, memory, self.step, substeps, self.program.body, p, self._on,
            self._none, out,
        )  # fmt: skip
        return body_rates(out)

    def coast(self, start: Sequence[float], commands: Mapping[str, float], steps: int) -> Array:
        """State after many steps with constant commands and settled actuators: what benchmarks measure."""
        act, k = np.zeros(self.code.HELD), np.zeros(self.code.K)
        memory = np.zeros(self.program.memory_size)
        self.code.settle(self.program.command_array(commands), memory, self._values, self._on, act)
        self.code.constants(self.program.body, self._values, self._on, k)
        y = earth_rates(np.array(start, dtype=float))
        self.code.steps(0.0, y, self.step, steps, act, self._values, self._on, k)
        return body_rates(y)
