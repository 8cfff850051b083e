"""Clock offset: poses and commands are stamped by two clocks that differ by a constant."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Measurement, param


@njit(inline="always")
def motion_latency(q: Any) -> float:
    """Return by how much the recorded motion lags the recorded commands, due to two clocks.

    The pose in row t is that of the time t - pose_late.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Latency of the recorded motion behind the recorded commands [s].
    """
    return float(q.pose_late)


@dataclass(frozen=True)
class ClockOffset(Measurement):
    """Latency of the recorded motion behind the recorded commands.

    The vessel itself responds as modelled. A negative `pose_late` [s] means that the poses are
    stamped too early.
    """

    formula: ClassVar[str] = r"\eta_\mathrm{recorded}(t) = \eta(t - \tau)"
    symbols: ClassVar = {"pose_late": r"\tau"}
    words: ClassVar[str] = (
        "the clock of the poses differs from the clock of the commands (not physics)"
    )
    shown_by: ClassVar[str] = "fast steps of thrust and steering in open loop"
    motion_latency: ClassVar = motion_latency
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
