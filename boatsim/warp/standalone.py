"""A batch's motion in one kernel of its own, without MuJoCo: the twin's Runge-Kutta steps, boat by boat."""

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.signals import Array
from boatsim.warp.device_state import Boats


class Alone:
    """Joint coordinates and rates of all boats, and how they go on."""

    def __init__(self, boats: Boats) -> None:
        self.boats = boats
        self._y = boats.zeros(2 * boats.code.NQ)
        self._none = boats.filled(np.zeros(boats.code.NQ))

    def take(self, numbers: NDArray[np.int64]) -> None:
        """Boats become of other vessels: what they weigh is among the masses already."""

    def put(self, y: Array) -> None:
        """States (n, 2 NQ), joint coordinates and rates."""
        self._y.assign(y)

    def states(self) -> Array:
        """(n, 2 NQ)."""
        return np.asarray(self._y.numpy(), dtype=float)

    def advance(self, steps: int) -> None:
        """Steps under the commands there are."""
        b = self.boats
        b.launch(
            "run_on", b.commands, b.step, steps, b.p, b.k, self._none, b.t, self._y, b.memory, b.act
        )
