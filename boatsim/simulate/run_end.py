"""Conditions of a scenario that end a run."""

from math import cos, sin

import numpy as np

from boatsim.physics.signals import Array
from boatsim.simulate.scenario import ScenarioFile
from boatsim.simulate.stepper import State

TIME_TOLERANCE = 1e-9  # [s] by which rounding may shift the time at which something is due
NORTH, EAST, PSI = (State._fields.index(name) for name in ("x", "y", "psi"))


class RunEnd:
    """Duration and `[until]` of a scenario, which end its run."""

    def __init__(self, file: ScenarioFile) -> None:
        """Prepare the conditions.

        Args:
            file: The scenario.
        """
        self.duration = file.duration
        self._until = file.until
        self._start = file.start
        self._across = -sin(file.start.psi), cos(file.start.psi)

    @property
    def depends_on_motion(self) -> bool:
        """Whether the motion of the vessel may end the run before its duration is over."""
        return self._until.turned is not None or self._until.starboard is not None

    def is_over(self, t: float) -> bool:
        """Return whether the duration of the run is over at a time [s]."""
        return t >= self.duration - TIME_TOLERANCE

    def is_reached(self, state: State) -> bool:
        """Return whether a run ends in a state."""
        if self.is_over(state.t):
            return True
        return self.depends_on_motion and self.first_reached(np.array([state])) is not None

    def first_reached(self, states: Array) -> int | None:
        """Return the number of the first of several states at which the motion ends the run.

        Args:
            states: Consecutive states (N, 13).

        Returns:
            The number; None if there is no such state.
        """
        reached = np.zeros(len(states), dtype=bool)
        if self._until.turned is not None:
            reached |= np.abs(states[:, PSI] - self._start.psi) >= self._until.turned
        if self._until.starboard is not None:
            north, east = states[:, NORTH] - self._start.x, states[:, EAST] - self._start.y
            across = self._across[0] * north + self._across[1] * east
            reached |= across >= self._until.starboard
        if not reached.any():
            return None
        return int(reached.argmax())
