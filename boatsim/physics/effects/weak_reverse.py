"""Weak reverse: a propeller designed for going ahead gives less thrust astern."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def scale_astern_thrust(x: float, q: Any) -> float:
    """Return a thrust unchanged if it acts ahead, times a factor if it acts astern.

    Args:
        x: Thrust or shaft rate.
        q: Parameters with `astern_factor`.
    """
    return x * q.astern_factor if x < 0.0 else x


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust command, multiplied by a factor when it is astern.

    The factor is applied at each of the three instants of the step.

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
        scale_astern_thrust(x.begin, q),
        scale_astern_thrust(x.middle, q),
        scale_astern_thrust(x.end, q),
    )


@dataclass(frozen=True)
class WeakReverse(ChannelEffect):
    """Thrust astern as a fraction of the commanded thrust.

    T = astern_factor T_command  for T_command < 0
    """

    formula: ClassVar[str] = r"y = \begin{cases} x & x \ge 0 \\ k \, x & x < 0 \end{cases}"
    symbols: ClassVar = {"astern_factor": "k"}
    words: ClassVar[str] = "the propellers push less astern than commanded"
    words_above: ClassVar[str] = "the propellers push more astern than commanded"
    shown_by: ClassVar[str] = "turning on the spot or swaying with one motor astern"
    source: ClassVar[str] = "J. A. Bayless 2017, Appendix H (motor calibration 0.70)"
    acts_on: ClassVar[str] = "thrust|shaft"
    stage: ClassVar[int] = DEEDS
    either_side: ClassVar[bool] = True
    acts_astern: ClassVar[bool] = True
    transform_signal: ClassVar = transform_signal

    astern_factor: float = param(
        1.0,
        low=0.05,
        high=1.5,
        unit="",
        words="astern thrust over the thrust that the command gives in the model",
        fit=True,
        spread=0.3,
        inactive_value=1.0,
        in_per_cent="astern thrust is {share} of the commanded thrust",
    )


DriveWeakReverse = preset_effect(
    WeakReverse,
    "DriveWeakReverse",
    words="one drive pushes less astern than commanded",
    words_above="one drive pushes more astern than commanded",
    shown_by="this drive alone ahead and astern",
    once_per="actuator",
    tried_last=True,
    of_all=("weak_reverse",),
    # before a lag of its drive only, so that the candidates of several drives stay few
    either_side=False,
    frees={
        "astern_factor": {
            "words": "astern thrust of this drive over the thrust that the command gives in the "
            "model",
        },
    },
)
