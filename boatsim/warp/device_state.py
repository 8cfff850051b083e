"""What a device holds of a batch beside its motion: commands, actuators, parameters and masses."""

from types import ModuleType
from typing import Any

import numpy as np

from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.warp import program as programs
from boatsim.warp.runtime import device, warp


class Boats:
    """Arrays of a device, a row a boat, and the program that works on them."""

    def __init__(self, program: Program, n: int, step: float, on: str, real: str) -> None:
        """`on` is the device, `real` the kind of floats there."""
        self.program, self.n, self.step = program, n, step
        self.wp, self.device = warp(), device(on)
        self.code = program.module
        self.kernels: ModuleType = programs.module(program, real)
        self.real = getattr(self.wp, real)
        self.commands = self.zeros(len(program.vessel.inputs))
        self.memory, self.act = self.zeros(program.memory_size), self.zeros(program.held_size)
        self.t = self.filled(np.zeros(n), self.wp.float64)  # [s]
        self.moves = 0  # how often parameters came to lie elsewhere
        self.p = self.k = self.filled(np.zeros((0, 0)))

    def take(self, p: Array, k: Array) -> None:
        """Parameters (n, P) and masses (n, K); a single row of each where all boats are alike."""
        alike = (p == p[:1]).all() and (k == k[:1]).all()
        p, k = (p[:1], k[:1]) if alike else (p, k)
        if self.p.shape == p.shape:
            self.p.assign(p)
            self.k.assign(k)
        else:
            self.p, self.k = self.filled(p), self.filled(k)
            self.moves += 1

    def zeros(self, *shape: int) -> Any:
        """(n, ...) of zeros."""
        return self.filled(np.zeros((self.n, *shape)))

    def filled(self, values: Array, kind: Any = None) -> Any:
        """These numbers on the device."""
        return self.wp.array(values, dtype=kind or self.real, device=self.device)

    def launch(self, kernel: str, *inputs: Any) -> None:
        """One of the program's kernels, a thread a boat."""
        self.wp.launch(getattr(self.kernels, kernel), dim=self.n, inputs=inputs, device=self.device)
