"""Interface of the simulators of a task: many boats in a compiled batch, or one on MuJoCo."""

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from boatsim.physics.signals import Array

Boats = NDArray[np.int64]  # numbers of boats


class World(Protocol):
    """Interface of a simulator of n boats in a learning environment.

    `boatsim.simulate.batch.Batch` is one.
    """

    @property
    def states(self) -> Array:
        """Present states (n, 2 NQ) of all simulated boats, in SI units."""

    def advance(self, commands: ArrayLike, steps: int = 1) -> None:
        """Simulate all boats over a number of integration steps with constant commands.

        Args:
            commands: Commands (n, C).
            steps: Number of integration steps.
        """

    def reset(
        self, states: ArrayLike, commands: ArrayLike | None = None, boats: ArrayLike | None = None
    ) -> None:
        """Set the states of some or all simulated boats.

        Args:
            states: States (k, 2 NQ) in SI units.
            commands: Commands (k, C); None for neutral.
            boats: Numbers (k,) of the boats; None for all.
        """

    def assign(self, vessel: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Assign vessels (hulls or load conditions) to simulated boats.

        Args:
            vessel: Numbers (k,) of the vessels.
            boats: Numbers (k,) of the boats; None for all.
        """

    def set(self, parameter: str, values: ArrayLike, boats: ArrayLike | None = None) -> None:
        """Set a parameter of an effect, such as a wind speed, of some or all simulated boats.

        Args:
            parameter: "effect.parameter".
            values: Values (k,) in the unit of the parameter.
            boats: Numbers (k,) of the boats; None for all.
        """

    def get(self, parameter: str) -> Array:
        """Return the values (n,) of an effect's parameter, one for each simulated boat.

        Args:
            parameter: "effect.parameter".
        """
