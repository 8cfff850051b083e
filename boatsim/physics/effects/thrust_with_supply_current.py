"""Thrust with supply current: thrust that decreases with the measured electric current."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Boat, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import DEEDS
from boatsim.physics.param import UNSET
from boatsim.physics.supply_readings import nominal_reading, scaled_signal


@njit(inline="always")
def current_factor(current: float, q: Any) -> float:
    """Return the thrust over that without any current.

    Args:
        current: Measured current drawn from the supply [A].
        q: Parameters with `loss` and `nominal` [A].
    """
    if q.loss == 0.0 or not q.nominal > 0.0:
        return 1.0
    drawn = max(current, 0.0)  # a supply that is charged loses nothing
    return float(max(1.0 - q.loss * drawn / q.nominal, 0.0))


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust of a drive at the measured current, at each of the three instants.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Measured current [A] that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    return scaled_signal(x, current_factor(source, q))


@dataclass(frozen=True)
class ThrustWithSupplyCurrent(ChannelEffect):
    """Thrust that decreases linearly with the measured current I drawn from the supply.

    y = (1 - k I / I_n) x,  with I >= 0 and y / x >= 0

    The voltage of a battery falls with the current, by its inner resistance and that of the leads.
    I is a measured quantity of the vessel, positive where the supply gives power, and `fed_by`
    names it once for each channel in `on`. The nominal current I_n, at which the share k of the
    thrust is lost, is the `neutral` value of this quantity. A controller of the revolutions makes
    the loss 0.
    """

    formula: ClassVar[str] = r"y = \max\left(1 - k \, \frac{\max(I, 0)}{I_n}, 0\right) x"
    symbols: ClassVar = {"loss": "k", "nominal": "I_n"}
    words: ClassVar[str] = "the thrust decreases with the current drawn from the supply"
    shown_by: ClassVar[str] = "the same commands with and without other consumers"
    source: ClassVar[str] = (
        "O. Tremblay and L.-A. Dessaint, Experimental Validation of a Battery Dynamic Model for EV "
        "Applications, World Electric Vehicle Journal 3, 2009: the voltage of a battery falls by "
        "the product of current and inner resistance; the thrust in proportion to it is an "
        "empirical form"
    )
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = DEEDS
    measured_unit: ClassVar[str] = "A"
    transform_signal: ClassVar = transform_signal

    loss: float = param(
        0.0,
        low=0.0,
        high=1.0,
        unit="",
        words="k: share of the thrust that is lost at the nominal current",
        fit=True,
        spread=0.2,
        in_per_cent="at the nominal current the drives lose {share} of their thrust",
    )
    nominal: float = param(
        UNSET,
        low=0.0,
        high=1e5,
        unit="A",
        words="I_n: current at which the share k of the thrust is lost",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the nominal current [A]: the neutral value of the measured currents.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The neutral values are not above 0, or are not the same.
        """
        return {"nominal": nominal_reading(self, vessel, "current")}


ShaftWithSupplyCurrent = preset_effect(
    ThrustWithSupplyCurrent,
    "ShaftWithSupplyCurrent",
    words="the shaft rate decreases with the current drawn from the supply",
    shown_by="the same shaft commands with and without other consumers",
    acts_on="shaft",
    frees={
        "loss": {
            "words": "k: share of the shaft rate that is lost at the nominal current",
            "in_per_cent": "at the nominal current the drives lose {share} of their shaft rate",
        },
    },
)
