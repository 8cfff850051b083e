"""Drive map: static curve from the raw command of a motor controller to thrust or shaft rate."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import Array, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import MAPS


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust or shaft rate of a drive: its signal plus a static curve of a raw command.

    The raw command is, for example, the duty cycle of a motor controller.

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
    off = source - q.neutral
    drive = (abs(off) - q.dead) / (q.span - q.dead)
    if drive <= 0.0:
        return x
    # a power takes longer than all the rest
    share = drive if q.exponent == 1.0 else drive**q.exponent
    given = q.at_span * share if off > 0.0 else -q.at_span * share
    return SignalSegment(x.begin + given, x.middle + given, x.end + given)


@dataclass(frozen=True)
class DriveMap(ChannelEffect):
    """Static curve of a drive that is fed by a duty cycle, a servo pulse or a shaft rate.

    y = sign(s) k ((|s| - dead) / (span - dead))^n,  s = source - neutral,  0 for |s| <= dead

    k is `at_span`, n the `exponent`. The result is added to the drive's own command.
    """

    formula: ClassVar[str] = (
        r"y = x + \operatorname{sgn}(s) \, k \left(\frac{|s| - s_0}{s_1 - s_0}\right)^n "
        r"\quad \text{for } |s| > s_0, \quad s = \mathrm{source} - \mathrm{neutral}"
    )
    symbols: ClassVar = {"at_span": "k", "span": "s_1", "dead": "s_0", "exponent": "n"}
    words: ClassVar[str] = "a curve gives the output of the drive from its raw command"
    shown_by: ClassVar[str] = "a staircase of raw commands"
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = MAPS
    transform_signal: ClassVar = transform_signal

    at_span: float = param(
        1.0,
        low=-1e6,
        high=1e6,
        unit="",
        words="k: output, in the unit of the signal, at `span` from neutral",
    )
    span: float = param(
        1.0,
        low=1e-6,
        high=1e6,
        unit="",
        words="distance of the raw command from neutral at which the output is k",
    )
    neutral: float = param(
        0.0, low=-1e6, high=1e6, unit="", words="raw command at which the drive is at rest"
    )
    dead: float = param(
        0.0,
        low=0.0,
        high=1e6,
        unit="",
        words="distance from neutral within which the output is zero",
    )
    exponent: float = param(1.0, low=0.5, high=3.0, unit="", words="exponent n of the curve")

    def __post_init__(self) -> None:
        """Check that the dead zone is smaller than the span.

        Raises:
            BadInput: The dead zone covers the whole span.
        """
        super().__post_init__()
        if self.dead >= self.span:
            raise BadInput(
                f"{self.name}.dead = {self.dead:g}; allowed is less than its span, {self.span:g}"
            )


PwmThrust = preset_effect(
    DriveMap,
    "PwmThrust",
    words="a curve gives the thrust from the duty cycle of the motor",
    shown_by="a staircase of duties",
    otherwise={"span": 255.0},
)

PulseThrust = preset_effect(
    DriveMap,
    "PulseThrust",
    words="a curve gives the thrust from the width of the servo pulse",
    shown_by="a staircase of pulse widths",
    source="hobby speed controllers: neutral 1500 us, full 400 us from it",
    otherwise={"span": 400.0, "neutral": 1500.0},  # [us]
)

ShaftRpm = preset_effect(
    DriveMap,
    "ShaftRpm",
    formula=r"n = x + k \, \frac{\mathrm{source}}{60}",
    symbols={"at_span": "k"},
    words="the shaft rate is given in revolutions per minute",
    shown_by="any manoeuvre",
    acts_on="shaft",
    fixed={
        "span": 60.0,
        "neutral": 0.0,
        "dead": 0.0,
        "exponent": 1.0,
    },  # [rpm] that are 1/s, times a gear
)
