"""Dynamic positioning: keeps a position and heading, or follows a path at low speed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.control.dynamic_positioning import GOALS, DynamicPositioning


@dataclass
class Dp(DynamicPositioning):
    """Station keeping and low-speed tracking for any set of thrusters.

    The position at the start is held without a goal; a reference moves to each new goal `x_m`,
    `y_m`, `psi_rad` with limited speed, so that a list of goals is a path.
    """

    words: ClassVar[str] = (
        "dynamic positioning: holds position and heading or follows a path, with any thrusters"
    )
    goals: ClassVar[tuple[str, ...]] = (*GOALS, "speed_mps")

    def advance_reference(self, goal: Mapping[str, float]) -> None:
        """Move the reference towards the goal.

        Args:
            goal: `x_m`, `y_m` and `psi_rad`, by default those at the start, and `speed_mps`, the
                largest speed to them.
        """
        assert self._model is not None
        wanted = [goal.get(name, old) for name, old in zip(GOALS, self._start, strict=True)]
        speed = max(abs(goal.get("speed_mps", self._speed)), 1e-6)
        turn_rate = 2.0 * speed / self._model.length
        self._reference.step(np.array(wanted), speed, turn_rate, self.period)
