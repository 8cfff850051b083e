"""Interface of the simulators of a task: many boats in a compiled batch, or one on MuJoCo."""

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.physics.signals import Array

Boats = NDArray[np.int64]  # numbers of boats


class World(Protocol):
    """Simulator of n boats; `boatsim.simulate.batch.Batch` is one."""

    @property
    def states(self) -> Array:
        """Present states (n, 2 NQ)."""

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Advance by integration steps with constant commands (n, C)."""

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Set the states of boats."""

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Assign vessels to boats by their numbers."""

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Set the values of "effect.parameter" of boats."""

    def get(self, parameter: str) -> Array:
        """Return the values (n,) of "effect.parameter"."""
