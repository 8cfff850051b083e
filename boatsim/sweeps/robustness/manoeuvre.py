"""Manoeuvre of a robustness benchmark: each set point of the controller in turn, then none.

The error counts in the second half of each segment, when the response to the step has settled.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, radians, sqrt

import numpy as np
from numpy.typing import NDArray

from boatsim.control.base import Controller
from boatsim.drive.stick_mapping import HEADING, stick_mappings_for
from boatsim.errors import BadInput
from boatsim.physics.signals import Array, measured_column_for_goal
from boatsim.physics.vessel import Vessel

# [s] of a set point for a hull of 1 m: half of it covers several oscillations of a slow loop
SEGMENT = 30.0
SHARE = 0.5  # of the largest set point, so that the actuators keep a reserve against disturbances
HEADING_STEP = radians(20.0)  # [rad] as in the 20/20 zigzag of the IMO, without its overshoot
LONGEST_STEP = 0.02  # [s] integration step for a hull of 1 m, that of scenario files
# Share of its set point within which a signal counts as tracked: a response is usually called
# settled within 5 %; a disturbed one gets twice that
BAR = 0.1


@dataclass(frozen=True)
class TrackedSignal:
    """Motion signal for which a controller has a set point.

    Attributes:
        goal: Key of the set point.
        column: Column of the motion, with its unit.
        bar: Largest rms error of a boat that survives, in the unit of the column.
    """

    goal: str
    column: str
    bar: float


@dataclass(frozen=True)
class Manoeuvre:
    """Set points over time, and the signals that must follow them.

    Attributes:
        goals: [[goal]] tables of a scenario.
        segment: Length of each segment [s].
        signals: Signals with a set point.
    """

    goals: Sequence[Mapping[str, float]]
    segment: float
    signals: tuple[TrackedSignal, ...]

    @property
    def duration(self) -> float:
        """Length of the manoeuvre [s]."""
        return len(self.goals) * self.segment

    def scored_rows(self, t: Array) -> NDArray[np.bool_]:
        """Return which times (N,) [s] lie in the second half of their segment."""
        return np.asarray(np.mod(t, self.segment) >= 0.5 * self.segment)


def standard_manoeuvre(vessel: Vessel, controllers: Mapping[str, Controller]) -> Manoeuvre:
    """Return the manoeuvre of all compared controllers on a vessel.

    Each set point in turn has half of its largest value, that of the controller with the smallest
    one, and a heading 20 degrees; the others are zero. In the last segment all are zero. A channel
    that the controllers pass on is held at half of its range throughout.

    Args:
        vessel: The vessel.
        controllers: Controllers by name.

    Raises:
        BadInput: A controller has no set point of a velocity or heading, or the controllers have
            different ones.
    """
    names = list(controllers)
    largest = [_largest_goals(vessel, controllers[name], name) for name in names]
    for name, other in zip(names, largest, strict=True):
        if other.keys() != largest[0].keys():
            raise BadInput(
                f"controller {names[0]} takes {', '.join(largest[0])} and controller {name} "
                f"{', '.join(other)}; allowed are controllers of the same set points"
            )
    neutral: dict[str, float] = {}
    stepped: dict[str, float] = {}
    for key in largest[0]:
        value = SHARE * min(goals[key] for goals in largest)
        if measured_column_for_goal(key) is None:
            neutral[key] = value
            continue
        neutral[key] = 0.0
        stepped[key] = value
        if measured_column_for_goal(key) == HEADING:
            stepped[key] = HEADING_STEP
    if not stepped:
        raise BadInput(f"controller {names[0]} has no set point of a velocity or heading to track")
    segment = float(f"{SEGMENT * sqrt(vessel.length):.2g}")
    goals: list[Mapping[str, float]] = []
    for number, (key, value) in enumerate(stepped.items()):
        goals.append({"from": number * segment, **neutral, key: value})
    goals.append({"from": len(stepped) * segment, **neutral})
    signals = []
    for key, value in stepped.items():
        column = measured_column_for_goal(key) or key
        signals.append(TrackedSignal(key, column, BAR * abs(value)))
    return Manoeuvre(goals, segment, tuple(signals))


def integration_step(vessel: Vessel, controller: Controller) -> float:
    """Return the integration step [s] for a vessel, a whole part of the controller's period.

    Args:
        vessel: The vessel.
        controller: The controller.
    """
    longest = LONGEST_STEP * sqrt(vessel.length)
    return controller.period / ceil(controller.period / longest)


def _largest_goals(vessel: Vessel, controller: Controller, name: str) -> dict[str, float]:
    """Largest set point of each goal."""
    return {dial.key: dial.high for dial in stick_mappings_for(vessel, controller, name).dials}
