"""Thrust imbalance: different thrust of the port and starboard sides for the same command."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Boat, ChannelEffect, SignalSegment, param
from boatsim.physics.kinds.channel import DEEDS


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust with an imbalance f of the sides: port times 1 + f, starboard times 1 - f.

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
    share = 1.0 - side * q.fraction
    return SignalSegment(x.begin * share, x.middle * share, x.end * share)


@dataclass(frozen=True)
class ThrustImbalance(ChannelEffect):
    """Relative difference between port and starboard thrust, ahead and astern alike.

    T_port = (1 + f) T,  T_starboard = (1 - f) T,  f = `fraction`
    """

    formula: ClassVar[str] = (
        r"T_\mathrm{port} = (1 + f) \, T, \quad T_\mathrm{starboard} = (1 - f) \, T"
    )
    symbols: ClassVar = {"fraction": "f"}
    words: ClassVar[str] = "one side pushes harder than the other for the same command"
    shown_by: ClassVar[str] = "straight runs ahead and astern with equal commands"
    acts_on: ClassVar[str] = "thrust|shaft"
    stage: ClassVar[int] = DEEDS
    transform_signal: ClassVar = transform_signal

    fraction: float = param(
        0.0,
        low=-0.6,
        high=0.6,
        unit="",
        words="f: port thrust times 1 + f, starboard thrust times 1 - f",
        fit=True,
        spread=0.15,
        in_per_cent="the port side pushes {more} than commanded, the starboard side as much "
        "{opposite}",
    )

    def missing_for_test(self, vessel: Boat) -> str:
        """Return that the drives are not on both sides, if so; else "".

        Args:
            vessel: Vessel on which the effect acts.
        """
        sides = {vessel.side(name) for name in vessel.target_actuators(self)}
        return "" if {-1, 1} <= sides else "no drives on both sides"
