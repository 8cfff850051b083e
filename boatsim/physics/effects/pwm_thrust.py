"""PWM thrust curve: what a motor gives for the duty it is sent."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, param

NOMINAL_PWM = 150.0  # Arduino counts of 255, operating point of Bayless 2017, appendix H


@njit(inline="always")
def channel(x: float, side: float, pwm: float, memory: Array, at: int, dt: float, q: Any) -> float:
    """Thrust command plus k_T ((|pwm| - p0)/(150 - p0))^n with the sign of the PWM."""
    drive = (abs(pwm) - q.dead) / (NOMINAL_PWM - q.dead)
    if drive <= 0.0:
        return x
    thrust = q.at_150 * drive**q.exponent
    return x + thrust if pwm > 0.0 else x - thrust


@dataclass(frozen=True)
class PwmThrust(Channel):
    """Thrust of a motor and propeller from its signed PWM; a thrust command on the same side adds to it."""

    words: ClassVar[str] = "thrust follows the motor's PWM by a curve"
    shown_by: ClassVar[str] = "a staircase of PWM levels"
    source: ClassVar[str] = "checked specification of Bayless 2017, section 4 [A]: p0 = 0, n = 1"
    acts_on: ClassVar[str] = "thrust"
    source_family: ClassVar[str] = "pwm"
    channel: ClassVar = channel

    at_150: float = param(0.5, low=0.0, high=100.0, unit="N", words="thrust at PWM 150, k_T")
    dead: float = param(0.0, low=0.0, high=149.0, unit="", words="PWM below which nothing turns, p0")
    exponent: float = param(1.0, low=0.5, high=3.0, unit="", words="n of the curve")
