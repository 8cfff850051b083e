"""Steering backlash: play in the linkage, so the thruster stays behind when the steering reverses."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, param
from boatsim.physics.kinds.channel import COMMANDS

LONG = 1e3  # [s] a command held for so long was given before anyone looked


@njit(inline="always")
def pushed(y: float, x: float, half: float) -> float:
    """The play operator: the angle moves only when the command pushes against an end of the play."""
    return min(max(y, x - half), x + half)


@njit(inline="always")
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Pushed along by the command's course; where it hung in its play before anyone looked is a number of its own."""
    half = 0.5 * q.width * (1.0 if dt < LONG else q.behind)
    begin = pushed(memory[at], x.begin, half)
    middle = pushed(begin, x.middle, half)
    memory[at] = pushed(middle, x.end, half)
    return Course(begin, middle, memory[at])


@dataclass(frozen=True)
class SteeringBacklash(Channel):
    """Free play between steering command and thruster angle."""

    ruled_out_by: ClassVar = {"steering_measured": (True,)}
    words: ClassVar[str] = (
        "the steering linkage has play, so an angle stays behind when the steering reverses"
    )
    shown_by: ClassVar[str] = "small steering reversals while pushing"
    source: ClassVar[str] = (
        "M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, 1996 (play operator)"
    )
    acts_on: ClassVar[str] = "angle"
    slots: ClassVar[int] = 1
    stage: ClassVar[int] = COMMANDS
    either_side: ClassVar[bool] = True
    channel: ClassVar = channel
    thresholds: ClassVar = {"width": (0.07, 0.3)}
    strength: ClassVar = ("width",)

    width: float = param(
        0.0, low=0.0, high=0.8, unit="rad", words="total play", fit=True, spread=0.2
    )
    behind: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        fit=True,
        spread=0.5,
        words="how far the first angle is behind: 0 in the middle of the play, 1 as come from straight ahead",
    )
