"""Thrust and shaft deadband: commands below a threshold have no effect."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import COMMANDS


@njit(inline="always")
def apply_deadband(x: float, q: Any) -> float:
    """Return the part of a command that exceeds a symmetric dead band; zero inside the band.

    Args:
        x: Command.
        q: Parameters with the half `width`.
    """
    return x - min(max(x, -q.width), q.width)


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust or shaft command after a dead band, at each of the three instants.

    Commands inside the dead band give zero; all others are reduced by its half width.

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
        apply_deadband(x.begin, q), apply_deadband(x.middle, q), apply_deadband(x.end, q)
    )


@dataclass(frozen=True)
class ThrustDeadband(ChannelEffect):
    """Dead band by friction of motor and shaft, symmetric ahead and astern.

    y = x - min(max(x, -width), width)
    """

    formula: ClassVar[str] = r"y = x - \min(\max(x, -b), b)"
    symbols: ClassVar = {"width": "b"}
    words: ClassVar[str] = (
        "small thrust commands have no effect and all thrust is reduced by a constant"
    )
    shown_by: ClassVar[str] = "slow runs at several small thrust levels"
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = COMMANDS
    either_side: ClassVar[bool] = True
    transform_signal: ClassVar = transform_signal
    thresholds: ClassVar = {"width": (0.02, 0.1, 0.3)}

    width: float = param(
        0.0, low=0.0, high=1e7, unit="N", words="half width of the dead band", fit=True, spread=0.1
    )


ShaftDeadband = preset_effect(
    ThrustDeadband,
    "ShaftDeadband",
    words="small commands do not turn the shaft and all shaft rates are reduced by a constant",
    acts_on="shaft",
    frees={
        "width": {
            "high": 1e4,
            "unit": "1/s",
            "words": "half width of the dead band, in the unit of the command",
            "spread": 0.1,
        }
    },
)


DriveDeadband = preset_effect(
    ThrustDeadband,
    "DriveDeadband",
    words="small commands of one drive have no effect and all its others lose a constant",
    shown_by="slow runs at several small thrust levels of this drive alone",
    acts_on="thrust|shaft",
    once_per="actuator",
    of_all=("thrust_deadband", "shaft_deadband"),
    # before a lag of its drive only, so that the candidates of several drives stay few
    either_side=False,
    frees={
        "width": {
            "unit": "",
            "words": "half width of the dead band of this drive, in the unit of its channel",
            "spread": 0.1,
        }
    },
)
