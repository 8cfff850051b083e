"""Steering backlash: play in the steering linkage."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import COMMANDS

LONG = 1e3  # [s] a command held longer than this is the initial condition of a run


@njit(inline="always")
def play_operator(y: float, x: float, half: float) -> float:
    """Return the output of a mechanical play (backlash) with a given input.

    The output moves only when the input reaches an end of the play.

    Args:
        y: Output angle so far [rad].
        x: Input, the commanded angle [rad].
        half: Half width of the play [rad].
    """
    return min(max(y, x - half), x + half)


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the steering angle that follows its command through the play of the linkage.

    At the start of a run a parameter gives the position within the play.

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
    half = 0.5 * q.width * (1.0 if dt < LONG else q.behind)
    begin = play_operator(memory[at], x.begin, half)
    middle = play_operator(begin, x.middle, half)
    memory[at] = play_operator(middle, x.end, half)
    return SignalSegment(begin, middle, memory[at])


@dataclass(frozen=True)
class SteeringBacklash(ChannelEffect):
    """Play operator between the steering command and the angle of the thruster or rudder.

    y(t) = min(max(y(t-), x(t) - width / 2), x(t) + width / 2)

    `behind` sets the first angle: 0 in the middle of the play, 1 as reached from straight ahead.
    """

    formula: ClassVar[str] = (
        r"y(t) = \min\left(\max\left(y(t^-), x(t) - \tfrac{1}{2} b\right), x(t) + "
        r"\tfrac{1}{2} b\right)"
    )
    symbols: ClassVar = {"width": "b"}
    ruled_out_by: ClassVar = {"steering_measured": (True,)}
    words: ClassVar[str] = (
        "the steering linkage has play, so the angle lags when the steering reverses"
    )
    shown_by: ClassVar[str] = "small steering reversals under thrust"
    source: ClassVar[str] = (
        "M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, 1996 (play operator)"
    )
    acts_on: ClassVar[str] = "angle"
    slots: ClassVar[int] = 1
    stage: ClassVar[int] = COMMANDS
    either_side: ClassVar[bool] = True
    has_derivative: ClassVar[bool] = False
    transform_signal: ClassVar = transform_signal
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
        words="position of the first angle in the play: 0 middle, 1 as reached from straight ahead",
    )


AzimuthBacklash = preset_effect(
    SteeringBacklash,
    "AzimuthBacklash",
    words="the steering of one drive has play, so its direction lags when the steering reverses",
    shown_by="small steering reversals of this drive under thrust",
    once_per="actuator",
    of_all=("steering_backlash",),
    # before a lag of its drive only, so that the candidates of several drives stay few
    either_side=False,
    frees={
        "width": {"words": "total play of the steering of this drive", "spread": 0.2},
        "behind": {"spread": 0.5},
    },
)
