"""Command delay: dead time between a command and the actuator."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Array,
    Boat,
    ChannelEffect,
    SignalSegment,
    param,
    preset_effect,
    segment_mean,
)
from boatsim.physics.kinds.channel import DELAYS

SAME = 1e-9  # [s] times closer than this are the same instant
HISTORY = 80  # stored commands of each actuator: one every 20 ms for a delay of 1.6 s


@njit(inline="always")
def store_command(x: float, memory: Array, at: int, dt: float, delay: float) -> int:
    """Store a command and its duration in the ring buffer of a dead time; return the entry's index.

    The buffer holds pairs of command and duration. Commands that change too often for the buffer to
    span the delay are merged into their mean.

    Args:
        x: Command, held for the time dt.
        memory: Memory of the program; the buffer begins at `memory[at]`.
        at: Index of the buffer in `memory`.
        dt: Time for which the command is held [s].
        delay: Dead time [s].
    """
    newest = int(memory[at])
    held, lasted = memory[at + 1 + 2 * newest], memory[at + 2 + 2 * newest]
    if x != held and 0.0 < lasted < delay / HISTORY:
        memory[at + 1 + 2 * newest] = (held * lasted + x * dt) / (lasted + dt)
    elif x != held:
        newest = (newest + 1) % HISTORY
        memory[at] = newest
        memory[at + 1 + 2 * newest] = x
        memory[at + 2 + 2 * newest] = 0.0
    memory[at + 2 + 2 * newest] += dt
    return newest


@njit
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Delay a command by a dead time: return its mean over a time window `delay` before the step.

    The result is exact because no step extends beyond a change of the delayed command (see
    `time_to_discontinuity`).

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
    given = segment_mean(x)
    i = store_command(given, memory, at, dt, q.delay)
    if q.delay <= 0.0:
        return x
    # age [s] at the end of the step, walking back in time
    left = dt
    age = 0.0
    total = 0.0
    held = given
    for _ in range(HISTORY):
        held = memory[at + 1 + 2 * i]
        older = age + memory[at + 2 + 2 * i]
        part = min(older, q.delay + dt) - max(age, q.delay)
        if part >= dt - SAME:  # one command all the while: passed on to the last bit
            return SignalSegment(held, held, held)
        if part > 0.0:
            total += part * held
            left -= part
        age = older
        if age >= q.delay + dt:
            return SignalSegment(total / dt, total / dt, total / dt)
        i = i - 1 if i > 0 else HISTORY - 1
    mean = (total + left * held) / dt
    return SignalSegment(mean, mean, mean)


@njit
def present_output(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the delayed command that reaches the actuator at present.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The present signal of the actuator after the effect.
    """
    if q.delay <= 0.0:
        return x
    i, age = int(memory[at]), 0.0
    for _ in range(HISTORY):
        age += memory[at + 2 + 2 * i]
        if age >= q.delay - SAME:
            break
        i = i - 1 if i > 0 else HISTORY - 1
    return float(memory[at + 1 + 2 * i])


@njit
def time_to_discontinuity(x: float, memory: Array, at: int, q: Any) -> float:
    """Return the time until the next delayed command reaches the actuator.

    A command that is new at this instant needs the whole delay.

    Args:
        x: Present signal of the actuator before the effect, assumed constant.
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Time [s] for which three points of a `SignalSegment` describe the signal exactly; infinite
        if it is constant.
    """
    if q.delay <= 0.0:
        return inf
    i, age = int(memory[at]), 0.0
    left = q.delay if x != memory[at + 1 + 2 * i] else inf
    for _ in range(HISTORY):
        age += memory[at + 2 + 2 * i]
        if age >= q.delay - SAME:
            break
        left = q.delay - age
        i = i - 1 if i > 0 else HISTORY - 1
    return left


@dataclass(frozen=True)
class CommandDelay(ChannelEffect):
    """Dead time between every command and its actuator: y(t) = x(t - delay)."""

    formula: ClassVar[str] = r"y(t) = x(t - \tau)"
    symbols: ClassVar = {"delay": r"\tau"}
    words: ClassVar[str] = "commands take effect after a dead time"
    refines: ClassVar[str] = "lag"
    shown_by: ClassVar[str] = "fast steps of thrust and steering"
    acts_on: ClassVar[str] = ""  # every actuator
    slots: ClassVar[int] = 1 + 2 * HISTORY
    stage: ClassVar[int] = DELAYS
    transform_signal: ClassVar = transform_signal
    time_to_discontinuity: ClassVar = time_to_discontinuity
    present_output: ClassVar = present_output
    starts: ClassVar = ({"delay": 0.1},)

    delay: float = param(
        0.0,
        low=0.0,
        high=60.0,
        unit="s",
        words="dead time from command to effect",
        fit=True,
        spread=0.5,
        within=(0.0, 1.6),
    )

    def missing_for_test(self, vessel: Boat) -> str:
        """Return that the effect delays all commands as `command_delay` does, if so; else "".

        Args:
            vessel: Vessel on which the effect acts.
        """
        every = vessel.target_actuators(CommandDelay())
        if type(self).jointly and set(vessel.target_actuators(self)) == set(every):
            return "no other commands, so that command_delay describes the same"
        return ""


DriveDelay = preset_effect(
    CommandDelay,
    "DriveDelay",
    words="the commands of one drive take effect after a dead time of its own",
    shown_by="fast steps of this drive alone",
    acts_on="thrust|shaft",
    once_per="actuator",
    of_all=("command_delay", "thrust_delay"),
    frees={
        "delay": {
            "words": "dead time of this drive, beyond that of the vessel's file",
            "spread": 0.5,
        },
    },
)


AzimuthDelay = preset_effect(
    CommandDelay,
    "AzimuthDelay",
    words="the commanded direction of one drive alone takes effect after a dead time",
    shown_by="fast steps of the direction of this drive alone",
    acts_on="angle",
    once_per="actuator",
    of_all=("command_delay", "steering_delay"),
    ruled_out_by={"steering_measured": (True,)},
    frees={
        "delay": {
            "words": "dead time of the direction of this drive, beyond that of the vessel's file",
            "spread": 0.5,
        },
    },
)


SteeringDelay = preset_effect(
    CommandDelay,
    "SteeringDelay",
    words="the commanded directions of all drives take effect after the same dead time",
    shown_by="fast steps of the directions",
    acts_on="angle",
    once_per="actuator",
    jointly=True,
    imitated_by=("steering_rate_limit",),
    ruled_out_by={"steering_measured": (True,)},
    frees={
        "delay": {
            "words": "dead time of the directions, beyond that of the vessel's file",
            "spread": 0.5,
        },
    },
)


ThrustDelay = preset_effect(
    CommandDelay,
    "ThrustDelay",
    words="the commanded thrusts of all drives take effect after the same dead time",
    shown_by="fast steps of the thrusts",
    acts_on="thrust|shaft",
    once_per="actuator",
    jointly=True,
    frees={
        "delay": {
            "words": "dead time of the thrusts, beyond that of the vessel's file",
            "spread": 0.5,
        },
    },
)
