"""Drive map: what an actuator gives for the signal that its drive is sent."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param, preset


@njit(inline="always")
def channel(x: float, side: float, signal: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Command plus k ((d - dead) / (span - dead))^n, d the signal's distance from neutral, with the sign of that."""
    off = signal - q.neutral
    drive = (abs(off) - q.dead) / (q.span - q.dead)
    if drive <= 0.0:
        return x
    given = q.at_span * drive**q.exponent
    return x + given if off > 0.0 else x - given


@dataclass(frozen=True)
class PwmThrust(Channel):
    """Thrust of a motor and propeller from its signed PWM; a thrust command on the same side adds to it."""

    words: ClassVar[str] = "thrust follows the motor's PWM by a curve"
    shown_by: ClassVar[str] = "a staircase of PWM levels"
    source: ClassVar[str] = "checked thesis specification, section 4 [A]: p0 = 0, n = 1"
    acts_on: ClassVar[str] = "thrust"
    source_family: ClassVar[str] = "pwm"
    channel: ClassVar = channel

    at_span: float = param(0.5, low=0.0, high=1e6, unit="N", words="thrust where the signal is `span` off neutral, k_T")
    dead: float = param(0.0, low=0.0, high=149.0, unit="", words="signal beside neutral below which nothing turns, p0")
    exponent: float = param(1.0, low=0.5, high=3.0, unit="", words="n of the curve")
    span: float = param(150.0, low=1.0, high=1e4, unit="", words="counts of 255: the thesis' operating point")
    neutral: float = param(0.0, low=-1e4, high=1e4, unit="", words="signal that gives none")


PulseThrust = preset(
    PwmThrust,
    "PulseThrust",
    words="thrust follows the servo pulse in proportion",
    shown_by="a staircase of pulse widths",
    source="an assumption: the simplest map there is; 400 us from neutral to full, as hobby speed controllers have it",
    source_family="pulse",
    otherwise={"span": 400.0, "neutral": 1500.0},  # [us]
)

ShaftRpm = preset(
    PwmThrust,
    "ShaftRpm",
    words="the propeller's rate is given per minute",
    shown_by="any manoeuvre",
    source="sixty seconds a minute",
    acts_on="shaft",
    source_family="rpm",
    otherwise={"at_span": 1.0},  # [1/s] propeller per commanded revolution, where a gear is between them
    fixed={"span": 60.0, "neutral": 0.0, "dead": 0.0, "exponent": 1.0},
)
