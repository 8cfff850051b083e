"""What a device holds of a fleet beside its motion: commands, actuators, parameters and masses."""

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.warp import program as programs
from boatsim.warp.library import device, warp

Places = NDArray[np.int64]  # of boats in a fleet


class Boats:
    """Arrays of a device, a row a boat, and the program that works on them."""

    def __init__(self, program: Program, n: int, step: float, on: str, real: str) -> None:
        """`on` is the device, `real` the kind of floats there."""
        self.program, self.n, self.step = program, n, step
        self.wp, self.device = warp(), device(on)
        self.code: ModuleType = program.module
        self.kernels: ModuleType = programs.module(program, real)
        self.real = getattr(self.wp, real)
        self.commands = self.zeros(len(program.vessel.inputs))
        self.memory, self.act = self.zeros(program.memory_size), self.zeros(program.held_size)
        self.t = self.filled(np.zeros(n), self.wp.float64)  # [s]
        self.take(program.values()[None])

    def take(self, values: Array) -> None:
        """Parameters (n, P), or (1, P) for all boats alike."""
        self.values = values
        k, on = np.zeros((len(values), self.code.K)), self.program.switches()
        for row, masses in zip(values, k, strict=True):
            self.code.constants(self.program.body, row, on, masses)
        self.p, self.k = self.filled(values), self.filled(k)

    def zeros(self, *shape: int) -> Any:
        """(n, ...) of zeros."""
        return self.filled(np.zeros((self.n, *shape)))

    def filled(self, values: Array, kind: Any = None) -> Any:
        """These numbers on the device."""
        return self.wp.array(values, dtype=kind or self.real, device=self.device)

    def put(self, where: Any, rows: Places, what: Any) -> None:
        """Rows of an array of the device."""
        found = where.numpy()
        found[rows] = what
        where.assign(found)

    def launch(self, kernel: str, *inputs: Any) -> None:
        """One of the program's kernels, a thread a boat."""
        self.wp.launch(getattr(self.kernels, kernel), dim=self.n, inputs=inputs, device=self.device)
