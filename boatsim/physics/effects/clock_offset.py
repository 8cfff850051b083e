"""Clock offset: poses and commands are stamped by clocks that differ."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, param


@njit(inline="always")
def late(q: Any) -> float:
    """The pose in row t is the pose of t - pose_late."""
    return float(q.pose_late)


@dataclass(frozen=True)
class ClockOffset(Measurement):
    """Recorded motion late (or early) behind the recorded commands; the boat itself is not slower."""

    words: ClassVar[str] = (
        "the clock of the poses runs apart from the clock of the commands (not physics)"
    )
    shown_by: ClassVar[str] = (
        "quick steps of thrust and steering given by hand, not by a controller"
    )
    late: ClassVar = late
    starts: ClassVar = ({"pose_late": 0.2}, {"pose_late": -0.2}, {"pose_late": -0.5})

    pose_late: float = param(
        0.0,
        low=-60.0,
        high=60.0,
        unit="s",
        words="poses late by",
        fit=True,
        spread=0.4,
        within=(-2.0, 2.0),
    )
