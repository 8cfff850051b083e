"""The motion of a batch in one kernel without MuJoCo, with the steps of the compiled engine."""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array
from boatsim.warp.device_state import DeviceBoats


class StandaloneMotion:
    """Motion of a batch of boats, integrated in one Warp kernel without MuJoCo.

    It holds joint coordinates and rates of all boats.
    """

    def __init__(self, boats: DeviceBoats) -> None:
        self.boats = boats
        self._y = boats.zeros_per_boat(2 * boats.code.NQ)
        self._none = boats.copy_to_device(np.zeros(boats.code.NQ))

    def assign_vessels(self, numbers: NDArray[np.int64]) -> None:
        """Assign vessels to boats; does nothing, since the device already holds their masses."""

    def set_states(self, y: Array) -> None:
        """Set joint coordinates and rates of all simulated boats.

        Args:
            y: (n, 2 NQ) joint coordinates and rates.
        """
        self._y.assign(y)

    def states(self) -> Array:
        """Return joint coordinates and rates of all boats (n, 2 NQ)."""
        return np.asarray(self._y.numpy(), dtype=float)

    def advance(self, steps: int) -> None:
        """Integrate the motion of all boats under their commands.

        Args:
            steps: Number of steps.
        """
        b = self.boats
        b.launch_kernel(
            "run_on", b.commands, b.step, steps, b.p, b.k, self._none, b.t, self._y, b.memory, b.act
        )
