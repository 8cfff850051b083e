"""Consecutive steps of a run as arrays, for the rows of the log and the camera frames."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BoatsimError
from boatsim.physics.kernel.records import StepRecord
from boatsim.physics.signals import Array


@dataclass(frozen=True)
class BlockPlan:
    """Steps of a block, and what happens at their ends.

    Attributes:
        times: Times (N,) at the ends of the steps [s].
        stops: Number of steps until each control step, in ascending order.
        due: Time at which the first control period after the block begins [s].
        logged: Whether a row is logged at the end of each step (N,).
        may_end_early: Whether the run may end before the last step, where the last row is logged.
    """

    times: Array
    stops: list[int]
    due: float
    logged: NDArray[np.bool_]
    may_end_early: bool

    @property
    def period_ends(self) -> list[int]:
        """Number of steps until the end of each period with constant commands."""
        if self.stops and self.stops[-1] == len(self.times):
            return self.stops
        return [*self.stops, len(self.times)]

    def needs_values(self) -> NDArray[np.bool_]:
        """Return whether a row shows the values of the control step before the block, and of each.

        Returns:
            Truth values (1 + number of control steps,).
        """
        needed = np.zeros(len(self.stops) + 1, dtype=bool)
        if self.may_end_early:
            needed[:] = True
        needed[control_numbers(self.stops, len(self.times))[self.logged]] = True
        return needed


class ControlValues(NamedTuple):
    """Readings, commands and estimates of a controller at several control steps, one row each.

    The first row belongs to the last control step before the block.

    Attributes:
        commands: Commands in force (P, C) afterwards, in the order of the loop's channels.
        sent: Commands (P, C) as the controller sent them.
        sensed: Sensor readings (P, S) in the order of the log.
        estimated: Estimates (P, E) of the controller in the order of the log; nan where no row of
            the log needs them.
    """

    commands: Array
    sent: Array
    sensed: Array
    estimated: Array


@dataclass(frozen=True)
class StepBlock:
    """Consecutive steps of a run.

    Attributes:
        record: Record of the steps; rows from `count` on do not belong to the run.
        count: Number of steps N.
        step: Length of a step [s].
        logged: Whether a row is logged at the end of each step (N,).
        control: Values at the control steps.
        control_after: Row (N,) of `control` that holds after each step.
        control_before: Row (N,) of `control` that holds during each step.
        error: Why the run ends with an error after these steps.
    """

    record: StepRecord
    count: int
    step: float
    logged: NDArray[np.bool_]
    control: ControlValues
    control_after: NDArray[np.int64]
    control_before: NDArray[np.int64]
    error: BoatsimError | None = None

    @property
    def states(self) -> Array:
        """States (N, 13) at the ends of the steps: the fields of `State`."""
        return self.record.states[: self.count]

    @property
    def commands(self) -> Array:
        """Commands in force (N, C) during each step."""
        return self.control.commands[self.control_before]


def joined_values(parts: Sequence[ControlValues]) -> ControlValues:
    """Return the rows of several parts, one after another."""
    return ControlValues(*map(np.concatenate, zip(*parts, strict=True)))


def control_numbers(stops: list[int], steps: int) -> NDArray[np.int64]:
    """Return how many control steps there were until the end of each step of a block (steps,).

    Args:
        stops: Number of steps until each control step.
        steps: Number of steps.
    """
    found = np.zeros(steps, dtype=np.int64)
    found[np.array(stops, dtype=np.int64) - 1] = 1
    return np.cumsum(found)
