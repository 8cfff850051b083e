"""Servo: a steering machine with a range, a rate limit and a lag."""

from dataclasses import dataclass
from math import exp, pi
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """First-order approach to the limited command, no faster than the rate; the mean of the step's two ends.

    Without a lag it is a ramp that ends within the step: its mean is exact.
    """
    goal = min(max(x, -q.range), q.range)
    share = 1.0 if q.lag < 1e-4 else 1.0 - exp(-dt / q.lag)
    turn = min(max((goal - memory[at]) * share, -q.rate * dt), q.rate * dt)
    memory[at] += turn
    ramp = abs(turn) / (q.rate * dt) if q.lag < 1e-4 else 1.0  # share of the step
    return memory[at] - 0.5 * turn * ramp


@dataclass(frozen=True)
class Servo(Channel):
    """Steering angle follows its command through a first-order lag inside a range and a rate limit."""

    words: ClassVar[str] = "the steering follows with a limited rate and range"
    shown_by: ClassVar[str] = "quick steering reversals"
    source: ClassVar[str] = "checked specification of Bayless 2017, section 4: 0.06 s, 400 deg/s [A], 0 to 45 deg (T9)"
    acts_on: ClassVar[str] = "steer"
    slots: ClassVar[int] = 1
    channel: ClassVar = channel

    range: float = param(pi / 4, low=0.0, high=pi, unit="rad", words="largest angle either way")
    rate: float = param(400.0 * pi / 180.0, low=0.001, high=1e3, unit="rad/s", words="fastest turning")
    lag: float = param(0.06, low=0.0, high=60.0, unit="s", words="time constant")
