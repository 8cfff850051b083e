"""Steering asymmetry: the craft steers harder to one side than to the other."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param


@njit(inline="always")
def channel(x: float, side: float, source: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Angle x + gain |x|: more of every angle to starboard, less of every angle to port."""
    return x + q.gain * abs(x)


@dataclass(frozen=True)
class SteeringAsymmetry(Channel):
    """Effective steering angle per commanded one that differs between the two sides."""

    words: ClassVar[str] = "the same angle steers harder to one side than to the other"
    shown_by: ClassVar[str] = "turns with the same angle to both sides"
    source: ClassVar[str] = "C. Svendsen et al., IFAC MCMC 2012: yaw rates of right turns stand out of the model"
    acts_on: ClassVar[str] = "steer"
    channel: ClassVar = channel

    gain: float = param(
        0.0, low=-0.9, high=0.9, unit="", words="share more to starboard, less to port", fit=True, spread=0.1
    )
