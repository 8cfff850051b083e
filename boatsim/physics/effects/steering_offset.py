"""Steering offset: constant error of the steering angles."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def angle_with_offset(x: float, side: float, q: Any) -> float:
    """Return a steering angle with constant error: the offset of its side, and gain |x|, are added.

    Args:
        x: Steering angle [rad].
        side: -1 port, +1 starboard, 0 on the centreline.
        q: Parameters of the effect.
    """
    return x + q.gain * abs(x) + (q.starboard if side > 0.0 else q.port if side < 0.0 else q.middle)


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the steering angle with a constant error added at each of the three instants.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Raw command that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    return SignalSegment(
        angle_with_offset(x.begin, side, q),
        angle_with_offset(x.middle, side, q),
        angle_with_offset(x.end, side, q),
    )


@dataclass(frozen=True)
class SteeringOffset(ChannelEffect):
    """Constant error of each steering angle, with an optional asymmetry.

    y = x + offset(side) + gain |x|
    """

    formula: ClassVar[str] = r"y = x + b_\mathrm{side} + \epsilon |x|"
    symbols: ClassVar = {
        "port": r"b_\mathrm{port}",
        "starboard": r"b_\mathrm{starboard}",
        "middle": r"b_\mathrm{middle}",
        "gain": r"\epsilon",
    }
    words: ClassVar[str] = "the thrusters or rudders have a constant angle error"
    shown_by: ClassVar[str] = "straight runs ahead and astern"
    acts_on: ClassVar[str] = "angle"
    stage: ClassVar[int] = DEEDS
    transform_signal: ClassVar = transform_signal

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
        0.0,
        low=-0.9,
        high=0.9,
        unit="",
        words="relative increase of angles to starboard and decrease to port",
    )


SteeringAsymmetry = preset_effect(
    SteeringOffset,
    "SteeringAsymmetry",
    formula=r"y = x + \epsilon |x|",
    symbols={"gain": r"\epsilon"},
    words="the same angle steers more strongly to one side than to the other",
    shown_by="turns with the same angle to both sides",
    source="C. Svendsen et al., IFAC MCMC 2012: yaw rates of right turns deviate from the model",
    frees={
        "gain": {
            "words": "relative increase of angles to starboard and decrease to port",
            "spread": 0.1,
            "in_per_cent": "the same angle steers {more} to starboard, and as much {opposite} to "
            "port",
        }
    },
    fixed={"port": 0.0, "starboard": 0.0, "middle": 0.0},
)
