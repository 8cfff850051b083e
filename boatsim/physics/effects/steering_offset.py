"""Steering offset: thrusters or rudders do not point where the steering says."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param, preset
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def turned(x: float, side: float, q: Any) -> float:
    """A constant added to the angle of each side, and gain |x|: more of every angle to starboard, less to port."""
    return x + q.gain * abs(x) + (q.starboard if side > 0.0 else q.port if side < 0.0 else q.middle)


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """At each instant for itself."""
    return Course(turned(x.begin, side, q), turned(x.middle, side, q), turned(x.end, side, q))


@dataclass(frozen=True)
class SteeringOffset(Channel):
    """A constant error of each steering angle."""

    words: ClassVar[str] = "the thrusters are mounted or trimmed at an angle"
    shown_by: ClassVar[str] = "straight runs ahead and astern"
    acts_on: ClassVar[str] = "angle"
    stage: ClassVar[int] = DEEDS
    channel: ClassVar = channel

    port: float = param(
        0.0, low=-0.6, high=0.6, unit="rad", words="added to the port angle", fit=True, spread=0.12
    )
    starboard: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="rad",
        words="added to the starboard angle",
        fit=True,
        spread=0.12,
    )
    middle: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="rad",
        words="added to the angle of a steering on the centreline",
        fit=True,
        spread=0.12,
    )
    gain: float = param(
        0.0, low=-0.9, high=0.9, unit="", words="share more to starboard, less to port"
    )


SteeringAsymmetry = preset(
    SteeringOffset,
    "SteeringAsymmetry",
    words="the same angle steers harder to one side than to the other",
    shown_by="turns with the same angle to both sides",
    source="C. Svendsen et al., IFAC MCMC 2012: yaw rates of right turns stand out of the model",
    frees={"gain": {"words": "share more to starboard, less to port", "spread": 0.1}},
    fixed={"port": 0.0, "starboard": 0.0, "middle": 0.0},
)
