"""Where boats move: many at once on the compiled batch, or one on MuJoCo in its tank."""

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.physics.signals import Array

Boats = NDArray[np.int64]  # numbers of boats


class World(Protocol):
    """What a task needs of a simulator; `boatsim.simulate.batch.Batch` is one."""

    @property
    def states(self) -> Array:
        """(n, 2 NQ) present states."""

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Steps with commands (n, C) held."""

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Put boats at states."""

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Make boats the vessel of that number."""

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Give boats other values of "effect.parameter"."""

    def get(self, parameter: str) -> Array:
        """(n,) values of "effect.parameter"."""
