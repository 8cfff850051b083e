"""Thrust limit: thrust that does not exceed a share of the largest command."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    Boat,
    ChannelEffect,
    SignalSegment,
    param,
    preset_effect,
)
from boatsim.physics.kinds.channel import COMMANDS
from boatsim.physics.param import name_code_parameter

# Half width of the rounded corner, as a share of the largest command. It is of the size of the
# usual speed droop of governors; with a sharp corner the likelihood of a limit would have a kink
# at each commanded level. Near a share of 1 it shrinks with the distance to it, so that the effect
# vanishes there.
ROUNDED = 0.03
EARLIEST = 0.1  # smallest share: below it a drive is not limited but broken


@njit(inline="always")
def limit_thrust(x: float, q: Any) -> float:
    """Return a thrust command that is limited to a share of the largest command.

    The corner between both is a parabola, so that the slope is continuous.

    Args:
        x: Thrust command [N].
        q: Parameters with the `share`, and with the largest commands `full_ahead` and
            `full_astern` [N]; a command in a direction without a largest command is returned
            unchanged.
    """
    full = q.full_ahead if x > 0.0 else q.full_astern
    half = min(ROUNDED, 1.0 - q.share) * full
    most = q.share * full
    beyond = abs(x) - (most - half)  # beyond the begin of the corner
    if beyond <= 0.0 or half <= 0.0:
        return x
    size = abs(x) - beyond * beyond / (4.0 * half) if beyond < 2.0 * half else most
    return size if x > 0.0 else -size


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the limited thrust of a drive, at each of the three instants of the step.

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
        limit_thrust(x.begin, q), limit_thrust(x.middle, q), limit_thrust(x.end, q)
    )


@dataclass(frozen=True)
class ThrustLimit(ChannelEffect):
    """Limit of the thrust, ahead and astern the same share of the largest command.

    y = sign(x) min(|x|, k T), with the largest command T of the drives ahead or astern, and with a
    corner that is rounded over 0.03 T on either side of the limit. A share of 1 is no limit. With a
    share for each direction, recordings could often not distinguish a limit astern from propellers
    that push less astern (`weak_reverse`).

    Where the recorded commands are always at full thrust or at rest, a limit is the same as a
    smaller gain of the thrust.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} y &= \operatorname{sgn}(x) \begin{cases} |x| & |x| \le k T - h \\ "
        r"|x| - \frac{(|x| - k T + h)^2}{4 h} & \text{otherwise} \\ k T & |x| \ge k T + h "
        r"\end{cases} \\ h &= \min(0.03, 1 - k) \, T, \quad T = \begin{cases} T_+ & x > 0 \\ "
        r"T_- & x < 0 \end{cases} \end{aligned}"
    )
    symbols: ClassVar = {"share": "k", "full_ahead": "T_+", "full_astern": "T_-"}
    words: ClassVar[str] = "the thrust is limited: large commands give no more than a part of it"
    shown_by: ClassVar[str] = "runs at several thrust levels between half and full"
    source: ClassVar[str] = (
        "torque and power limits of the drives: O. N. Smogeli, Control of Marine Propellers, PhD, "
        "NTNU Trondheim 2006; the rounded corner is an empirical form"
    )
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = COMMANDS
    transform_signal: ClassVar = transform_signal
    # a limit has no slope at commands below it, so that a fit must start beneath the large ones
    starts: ClassVar = ({"share": 0.85}, {"share": 0.6}, {"share": 0.35})

    share: float = param(
        1.0,
        low=EARLIEST,
        high=1.0,
        unit="",
        words="limit of the thrust, as a share of the largest command; 1: no limit",
        fit=True,
        spread=0.25,  # a limit below half of the range that the file allows is rare
        inactive_value=1.0,
        in_per_cent="the thrust reaches at most {share} of the largest command",
    )
    full_ahead: float = name_code_parameter("largest command ahead")
    full_astern: float = name_code_parameter("largest command astern")

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the largest commands [N] ahead and astern of the drives on which it acts.

        Args:
            vessel: Vessel on which the effect acts.
        """
        ahead, astern = self.largest_commands(vessel)
        return {"full_ahead": ahead, "full_astern": astern}


DriveLimit = preset_effect(
    ThrustLimit,
    "DriveLimit",
    words="the thrust of one drive is limited: large commands give no more than a part of it",
    shown_by="runs of this drive at several thrust levels between half and full",
    once_per="actuator",
    of_all=("thrust_limit", "shaft_limit"),
    frees={
        "share": {
            "words": "limit of the thrust, as a share of the largest command of this drive",
        },
    },
)


ShaftLimit = preset_effect(
    ThrustLimit,
    "ShaftLimit",
    words="the shaft rate is limited: large commands turn the shaft no faster than a part of it",
    shown_by="runs at several shaft rates between half and full",
    acts_on="shaft",
    frees={
        "share": {
            "words": "limit of the shaft rate, as a share of the largest command; 1: no limit",
            "in_per_cent": "the shaft turns at most at {share} of the largest command",
        },
    },
)
