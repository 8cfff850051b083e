"""Command delay: what is commanded now reaches the thrusters later."""

from dataclasses import dataclass
from math import inf
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Channel, Course, mean_of, param
from boatsim.physics.kinds.channel import DELAYS

SAME = 1e-9  # [s] instants this close are one
HISTORY = 80  # commands remembered of each actuator: one every 20 ms for a delay of 1.6 s


@njit(inline="always")
def remember(x: float, memory: Array, at: int, dt: float, delay: float) -> int:
    """Add a command held for dt to the ring of (command, duration) pairs behind memory[at]; index of the newest.

    Commands that change too often for the ring to reach back as far as the delay are remembered by their mean.
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
def channel(
    x: Course, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> Course:
    """Mean command of the time window that is `delay` old: exact, for no step reaches beyond a change."""
    given = mean_of(x)
    i = remember(given, memory, at, dt, q.delay)
    if q.delay <= 0.0:
        return x
    left, age, total, held = (
        dt,
        0.0,
        0.0,
        given,
    )  # age [s] at the end of the step, walking back in time
    for _ in range(HISTORY):
        held = memory[at + 1 + 2 * i]
        older = age + memory[at + 2 + 2 * i]
        part = min(older, q.delay + dt) - max(age, q.delay)
        if part >= dt - SAME:  # one command all the while: passed on to the last bit
            return Course(held, held, held)
        if part > 0.0:
            total += part * held
            left -= part
        age = older
        if age >= q.delay + dt:
            return Course(total / dt, total / dt, total / dt)
        i = i - 1 if i > 0 else HISTORY - 1
    mean = (total + left * held) / dt
    return Course(mean, mean, mean)


@njit
def passes(x: float, memory: Array, at: int, q: Any) -> float:
    """The command that arrives now."""
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
def pause(x: float, memory: Array, at: int, q: Any) -> float:
    """Time until the next command that is on its way arrives; one given now needs the whole delay."""
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
class CommandDelay(Channel):
    """Dead time between every command and its actuator."""

    words: ClassVar[str] = "commands take effect after a dead time"
    shown_by: ClassVar[str] = "quick steps of thrust and steering"
    acts_on: ClassVar[str] = ""  # every actuator
    slots: ClassVar[int] = 1 + 2 * HISTORY
    stage: ClassVar[int] = DELAYS
    channel: ClassVar = channel
    pause: ClassVar = pause
    passes: ClassVar = passes
    starts: ClassVar = ({"delay": 0.1},)

    delay: float = param(
        0.0,
        low=0.0,
        high=60.0,
        unit="s",
        words="command to effect",
        fit=True,
        spread=0.5,
        within=(0.0, 1.6),
    )
