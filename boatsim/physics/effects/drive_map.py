"""Drive map: what an actuator gives for the raw command that its motor controller is sent."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.errors import BadInput
from boatsim.physics.base import Array, Channel, Course, param, preset
from boatsim.physics.kinds.channel import MAPS


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Command plus k ((|source - neutral| - dead) / (span - dead))^n, to the side of neutral it is on."""
    off = source - q.neutral
    drive = (abs(off) - q.dead) / (q.span - q.dead)
    if drive <= 0.0:
        return x
    share = (
        drive if q.exponent == 1.0 else drive**q.exponent
    )  # a power takes longer than all the rest
    given = q.at_span * share if off > 0.0 else -q.at_span * share
    return Course(x.begin + given, x.middle + given, x.end + given)


@dataclass(frozen=True)
class DriveMap(Channel):
    """Thrust or rate of a drive fed by a duty, a servo pulse or revolutions; its own command adds to it."""

    words: ClassVar[str] = "the drive follows its raw command by a curve"
    shown_by: ClassVar[str] = "a staircase of raw commands"
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = MAPS
    channel: ClassVar = channel

    at_span: float = param(
        1.0,
        low=-1e6,
        high=1e6,
        unit="",
        words="k: what it gives, in its own unit, `span` off neutral",
    )
    span: float = param(
        1.0, low=1e-6, high=1e6, unit="", words="raw command, from neutral, at which it gives that"
    )
    neutral: float = param(
        0.0, low=-1e6, high=1e6, unit="", words="raw command at which it stands still"
    )
    dead: float = param(
        0.0, low=0.0, high=1e6, unit="", words="from neutral, below which nothing turns"
    )
    exponent: float = param(1.0, low=0.5, high=3.0, unit="", words="n of the curve")

    def __post_init__(self) -> None:
        """Raises BadInput for a drive that is dead over all of its span."""
        super().__post_init__()
        if self.dead >= self.span:
            raise BadInput(
                f"{self.name}.dead = {self.dead:g}; allowed is less than its span, {self.span:g}"
            )


PwmThrust = preset(
    DriveMap,
    "PwmThrust",
    words="thrust follows the motor's duty by a curve",
    shown_by="a staircase of duties",
    otherwise={"span": 255.0},
)

PulseThrust = preset(
    DriveMap,
    "PulseThrust",
    words="thrust follows the servo pulse by a curve",
    shown_by="a staircase of pulse widths",
    source="hobby speed controllers: neutral 1500 us, full 400 us from it",
    otherwise={"span": 400.0, "neutral": 1500.0},  # [us]
)

ShaftRpm = preset(
    DriveMap,
    "ShaftRpm",
    words="the propeller's rate is given per minute",
    shown_by="any manoeuvre",
    acts_on="shaft",
    fixed={
        "span": 60.0,
        "neutral": 0.0,
        "dead": 0.0,
        "exponent": 1.0,
    },  # [rpm] that are 1/s, times a gear
)
