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
        """Present states (n, 2 NQ) in SI units."""

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Advance by integration steps with constant commands.

        Args:
            commands: Commands (n, C).
            steps: Number of integration steps.
        """

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Set the states of boats.

        Args:
            states: States (k, 2 NQ) in SI units.
            commands: Commands (k, C); None for neutral.
            boats: Numbers (k,) of the boats; None for all.
        """

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Assign vessels to boats.

        Args:
            vessel: Numbers (k,) of the vessels.
            boats: Numbers (k,) of the boats; None for all.
        """

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Set a parameter of boats.

        Args:
            parameter: "effect.parameter".
            values: Values (k,) in the unit of the parameter.
            boats: Numbers (k,) of the boats; None for all.
        """

    def get(self, parameter: str) -> Array:
        """Return the values (n,) of a parameter.

        Args:
            parameter: "effect.parameter".
        """
