"""Thrust exponent: thrust that grows with a power of the command, full thrust being unchanged."""

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


@njit(inline="always")
def apply_exponent(x: float, q: Any) -> float:
    """Return full thrust times a power of the share of it that is commanded.

    Args:
        x: Thrust command [N].
        q: Parameters with `exponent`, and with the full thrusts `full_ahead` and `full_astern` [N];
            a command in a direction without a full thrust is returned unchanged.
    """
    full = q.full_ahead if x > 0.0 else q.full_astern
    if x == 0.0 or q.exponent == 1.0 or not full > 0.0:
        return x
    share = (abs(x) / full) ** q.exponent
    return full * share if x > 0.0 else -full * share


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust that a nonlinear curve gives for a command, at each of the three instants.

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
    begin = apply_exponent(x.begin, q)
    if x.middle == x.begin and x.end == x.begin:  # a power takes longer than all the rest
        return SignalSegment(begin, begin, begin)
    return SignalSegment(begin, apply_exponent(x.middle, q), apply_exponent(x.end, q))


@dataclass(frozen=True)
class ThrustExponent(ChannelEffect):
    """Thrust that grows with a power n of the command; full thrust, ahead and astern, is unchanged.

    y = sign(x) T (|x| / T)^n, with the largest command T of the drives ahead or astern

    With a throttle that sets the revolutions n is about 2, with one that sets the power about 2/3.
    """

    formula: ClassVar[str] = (
        r"y = \operatorname{sgn}(x) \, T \left(\frac{|x|}{T}\right)^n, \quad "
        r"T = \begin{cases} T_+ & x > 0 \\ T_- & x < 0 \end{cases}"
    )
    symbols: ClassVar = {"exponent": "n", "full_ahead": "T_+", "full_astern": "T_-"}
    words: ClassVar[str] = "thrust is not proportional to the command"
    words_above: ClassVar[str] = (
        "thrust is not proportional to the command: half a command gives less than half the thrust"
    )
    shown_by: ClassVar[str] = "runs at several thrust levels between slow and full"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: thrust "
        "grows with the square of the revolutions"
    )
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = COMMANDS
    transform_signal: ClassVar = transform_signal

    exponent: float = param(
        1.0,
        low=0.4,
        high=3.0,
        unit="",
        words="exponent n of the curve",
        fit=True,
        spread=0.4,
        inactive_value=1.0,
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


DriveExponent = preset_effect(
    ThrustExponent,
    "DriveExponent",
    words="the thrust of one drive is not proportional to its command",
    words_above=(
        "the thrust of one drive is not proportional to its command: half a command gives less "
        "than half the thrust"
    ),
    shown_by="runs of this drive at several thrust levels between slow and full",
    once_per="actuator",
    of_all=("thrust_exponent",),
    frees={
        "exponent": {
            "words": "exponent n of the curve of this drive, beyond that of the vessel's file",
            "spread": 0.4,
        },
    },
)
