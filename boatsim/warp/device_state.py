"""Arrays of a batch on a device: commands, actuators, parameters and masses."""

from types import ModuleType
from typing import Any

import numpy as np

from boatsim.physics.program import Program
from boatsim.physics.signals import Array
from boatsim.warp import program as programs
from boatsim.warp.runtime import find_device, import_warp


class DeviceBoats:
    """Arrays of a batch of boats on a Warp device, with the program whose kernels use them.

    Each array has one row for each boat.
    """

    def __init__(self, program: Program, n: int, step: float, on: str, real: str) -> None:
        """Allocate the arrays.

        Args:
            program: The vessel's program.
            n: Number of boats.
            step: Integration step [s].
            on: Name of the device, "cpu" or "cuda:0".
            real: Kind of floats, "float32" or "float64".
        """
        self.program, self.n, self.step = program, n, step
        self.wp, self.device = import_warp(), find_device(on)
        self.code = program.module
        self.kernels: ModuleType = programs.import_program(program, real)
        self.real = getattr(self.wp, real)
        self.commands = self.zeros_per_boat(len(program.vessel.inputs))
        self.memory, self.act = (
            self.zeros_per_boat(program.memory_size),
            self.zeros_per_boat(program.actuator_signal_size),
        )
        self.t = self.copy_to_device(np.zeros(n), self.wp.float64)  # [s]
        self.reallocations = 0  # of arrays; a recorded graph of the GPU holds their addresses
        self.p = self.k = self.copy_to_device(np.zeros((0, 0)))

    def copy_parameters(self, p: Array, k: Array) -> None:
        """Copy model parameters and masses of all boats to the device.

        Only one row of each is copied if all boats are equal.

        Args:
            p: (n, P) parameters.
            k: (n, K) masses.
        """
        alike = (p == p[:1]).all() and (k == k[:1]).all()
        p, k = (p[:1], k[:1]) if alike else (p, k)
        if self.p.shape == p.shape:
            self.p.assign(p)
            self.k.assign(k)
        else:
            self.p, self.k = self.copy_to_device(p), self.copy_to_device(k)
            self.record_reallocation()

    def record_reallocation(self) -> None:
        """Record that an array has a new address, so that graphs of the GPU are recorded again."""
        self.reallocations += 1

    def zeros_per_boat(self, *shape: int) -> Any:
        """Return an array (n, ...) of zeros on the device, with a row for each boat."""
        return self.copy_to_device(np.zeros((self.n, *shape)))

    def copy_to_device(self, values: Array, kind: Any = None) -> Any:
        """Return a copy of a numpy array in the memory of the device.

        Args:
            values: The numbers.
            kind: Type of the entries; the program's floats if None.
        """
        return self.wp.array(values, dtype=kind or self.real, device=self.device)

    def launch_kernel(self, kernel: str, *inputs: Any) -> None:
        """Run a kernel of the program on the device, with one thread for each boat.

        Args:
            kernel: Name of the kernel.
            inputs: Its arguments.
        """
        self.wp.launch(getattr(self.kernels, kernel), dim=self.n, inputs=inputs, device=self.device)
