"""Thrust with voltage: thrust that grows with a power of the measured voltage of the supply."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import Array, Boat, ChannelEffect, SignalSegment, param, preset_effect
from boatsim.physics.kinds.channel import DEEDS
from boatsim.physics.param import UNSET
from boatsim.physics.supply_readings import nominal_reading, scaled_signal

# Range of the voltage over the nominal one. A battery under load stays well within it: lithium
# cells between 3.0 and 4.2 V of nominally 3.7 V, a lead battery between 10.5 and 14.4 V of 12 V.
# Other readings are errors of the instrument. The law holds for every run, simulated or recorded. A
# diagnosis, in addition, replaces readings far from the median of a recording before it uses this
# law (`voltage_least_share`, `voltage_largest_share`): the median stands for the voltage of that
# recording, even where the vessel's file states no nominal one.
LOWEST, HIGHEST = 0.5, 1.5


@njit(inline="always")
def voltage_factor(voltage: float, q: Any) -> float:
    """Return the thrust over that at the nominal voltage.

    Args:
        voltage: Measured voltage [V].
        q: Parameters with `exponent` and `nominal` [V].
    """
    if q.exponent == 0.0 or not q.nominal > 0.0:
        return 1.0
    ratio = min(max(voltage / q.nominal, LOWEST), HIGHEST)
    return float(ratio**q.exponent)


@njit(inline="always")
def transform_signal(
    x: SignalSegment, side: float, source: float, memory: Array, at: int, dt: float, q: Any
) -> SignalSegment:
    """Return the thrust of a drive at the measured voltage, at each of the three instants.

    Args:
        x: Signal of the actuator before the effect, at begin, middle and end of the step.
        side: -1 on the port side, +1 on the starboard side, 0 on the centreline.
        source: Measured voltage [V] that feeds the channel (`fed_by`).
        memory: Memory of the compiled program.
        at: Index of the first slot of this effect in `memory`.
        dt: Length of the step [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The signal of the actuator after the effect, over the same step.
    """
    return scaled_signal(x, voltage_factor(source, q))


@dataclass(frozen=True)
class ThrustWithVoltage(ChannelEffect):
    """Thrust that grows with a power k of the measured voltage V of the supply.

    y = (V / V_n)^k x,  with V / V_n within 0.5 to 1.5

    V is a measured quantity of the vessel, and `fed_by` names it once for each channel in `on`. The
    nominal voltage V_n, at which the thrust is that of the command, is the `neutral` value of this
    quantity. The revolutions of a motor grow with the voltage and the thrust with the square of the
    revolutions, so that k is about 2; a controller of the revolutions makes it 0.
    """

    formula: ClassVar[str] = (
        r"y = \left(\frac{V}{V_n}\right)^k x, \quad 0.5 \le \frac{V}{V_n} \le 1.5"
    )
    symbols: ClassVar = {"exponent": "k", "nominal": "V_n"}
    words: ClassVar[str] = "the thrust falls when the voltage of the supply falls"
    shown_by: ClassVar[str] = "the same commands with a full and with an empty battery"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 9.3: thrust "
        "grows with the square of the revolutions; those of a DC motor are in proportion to the "
        "voltage, and the power is an empirical form between both"
    )
    acts_on: ClassVar[str] = "thrust"
    stage: ClassVar[int] = DEEDS
    measured_unit: ClassVar[str] = "V"
    transform_signal: ClassVar = transform_signal

    exponent: float = param(
        0.0,
        low=0.0,
        high=5.0,
        unit="",
        words="k: power of the voltage; 0: the thrust does not depend on it",
        fit=True,
        spread=2.0,
    )
    nominal: float = param(
        UNSET,
        low=0.0,
        high=1e4,
        unit="V",
        words="V_n: voltage at which the thrust is that of the command",
    )

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the nominal voltage [V]: the neutral value of the measured voltages.

        Args:
            vessel: Vessel on which the effect acts.

        Raises:
            BadInput: The neutral values are not above 0, or are not the same.
        """
        return {"nominal": nominal_reading(self, vessel, "voltage")}


ShaftWithVoltage = preset_effect(
    ThrustWithVoltage,
    "ShaftWithVoltage",
    words="the shaft rate falls when the voltage of the supply falls",
    shown_by="the same shaft commands with a full and with an empty battery",
    acts_on="shaft",
    frees={
        "exponent": {
            "words": "k: power of the voltage, 1 for a motor without control of its revolutions; "
            "0: the shaft rate does not depend on it",
            "spread": 1.0,
        },
    },
)


DriveLossWithVoltage = preset_effect(
    ThrustWithVoltage,
    "DriveLossWithVoltage",
    words="the thrust or shaft rate of one drive falls when the voltage of its supply falls, "
    "unlike that of the others",
    shown_by="the same commands of this drive alone with a full and with an empty battery",
    acts_on="thrust|shaft",
    once_per="actuator",
    tried_last=True,
    of_all=("thrust_with_voltage", "shaft_with_voltage"),
    frees={
        "exponent": {
            "low": -5.0,  # where all drives of the vessel's file depend more on it than this one
            "words": "k: power of the voltage, beyond that of the vessel's file; 0: this drive "
            "does not depend on it otherwise than there",
            "spread": 2.0,
        },
    },
)
