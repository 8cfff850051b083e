"""Sensor error: gain, offset, delay and drift of one recorded channel."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import njit

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Boat, MeasuredMotion, Measurement, param, preset_effect
from boatsim.physics.param import name_code_parameter
from boatsim.physics.presets import ParameterChanges
from boatsim.physics.recorded_channels import (
    CHANNELS,
    HEADING,
    HEAVE,
    HEAVE_VELOCITY,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    SURGE_VELOCITY,
    SWAY_VELOCITY,
    YAW_RATE,
    InstrumentChannel,
    delayed_channel,
    with_channel,
)
from boatsim.physics.signals import RATES


@njit(inline="always")
def apply_measurement_error(m: MeasuredMotion, t: float, q: Any) -> MeasuredMotion:
    """Return the motion as recorded with an instrument error of one channel.

    The error consists of gain, offset, delay and drift.

    Args:
        m: True motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        t: Time since the first row of the recording [s].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        The recorded motion.
    """
    channel = np.int64(q.place)
    value = (1.0 + q.gain_fraction) * delayed_channel(m, channel, q.delay)
    return with_channel(m, channel, value + q.offset + q.drift * t)


@dataclass(frozen=True)
class SensorError(Measurement):
    """Error of the instrument that records one channel; other channels are unaffected.

    recorded(t) = (1 + gain_fraction) value(t - delay) + offset + drift t

    t is the time since the first row of the recording. The delay is of first order: value(t -
    delay) = value - delay rate, where the rate follows from the velocities. A velocity channel has
    no delay here, because its rate is an acceleration, which a recording does not contain; the
    check `velocity_late` of the log finds such a delay.

    `channel` is the column, such as "r_radps". A diagnosis tests the special cases of this effect
    that have a name: those of the channels that were recorded.
    """

    formula: ClassVar[str] = r"y_\mathrm{recorded}(t) = (1 + \epsilon) \, y(t - \tau) + b + c \, t"
    symbols: ClassVar = {
        "gain_fraction": r"\epsilon",
        "offset": "b",
        "delay": r"\tau",
        "drift": "c",
    }

    column: ClassVar[str] = "r_radps"  # default channel; the only one of a special case
    special_case: ClassVar[bool] = False
    uses_time: ClassVar[bool] = True
    words: ClassVar[str] = "one recorded channel has an error of its instrument (not physics)"
    shown_by: ClassVar[str] = "comparison with the other channels"
    source: ClassVar[str] = (
        "J. A. Farrell, Aided Navigation: GPS with High Rate Sensors, 2008 (scale factor and bias)"
    )
    apply_measurement_error: ClassVar = apply_measurement_error

    channel: str = ""  # a column of a recording; empty: `column`
    gain_fraction: float = param(
        0.0, low=-0.95, high=20.0, unit="", words="relative error of the channel"
    )
    offset: float = param(
        0.0, low=-1e6, high=1e6, unit="", words="constant error [unit of the channel]"
    )
    delay: float = param(
        0.0, low=0.0, high=60.0, unit="s", words="delay of the channel", within=(0.0, 1.0)
    )
    drift: float = param(
        0.0, low=-1e6, high=1e6, unit="", words="growth of the error [unit of the channel / s]"
    )
    place: float = name_code_parameter("place of the channel among those of a motion")

    def __post_init__(self) -> None:
        super().__post_init__()
        allowed = CHANNELS
        if self.special_case:
            allowed = (self.column,)
        channel = self.channel or self.column
        if channel not in allowed:
            raise BadInput(unknown_name_message(f"{self.name}: channel", channel, allowed))
        if channel in RATES and self.delay != 0.0:
            raise BadInput(
                f"{self.name}: delay = {self.delay:g} s of {channel}; allowed is 0, because the "
                "rate of change of a velocity is not recorded"
            )
        object.__setattr__(self, "channel", channel)

    def derived_parameters(self, vessel: Boat) -> dict[str, float]:
        """Return the number that stands for the erroneous channel in the compiled law.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return {"place": float(CHANNELS.index(self.channel))}

    def fixed_settings(self) -> dict[str, object]:
        """Return the name of the erroneous channel, as a setting that no fit changes.

        The result is empty if the name of the effect already determines the channel.
        """
        if self.special_case:
            return {}
        return {"channel": self.channel}


# Prior sds for a hull of 1.2 m. An offset of 0.05 m, rad, m/s or rad/s is 10 % of what such a hull
# reaches in its usual motions; a drift of 0.001 per second adds as much within a minute.
OFFSET_SPREAD, DRIFT_SPREAD, GAIN_SPREAD, DELAY_SPREAD = 0.05, 0.001, 0.1, 0.2


SYMBOLS = {"phi": r"\phi", "theta": r"\theta", "psi": r"\psi"}  # those that are no letters


def instrument_formula(channel: InstrumentChannel, freed: str) -> str:
    """Return the law of one error of one recorded channel in LaTeX.

    Args:
        channel: The recorded channel.
        freed: Parameter of the error: gain_fraction, offset, delay or drift.
    """
    symbol = channel.column.partition("_")[0]
    symbol = SYMBOLS.get(symbol, symbol)
    laws = {
        "gain_fraction": rf"(1 + \epsilon) \, {symbol}(t)",
        "offset": f"{symbol}(t) + b",
        "delay": rf"{symbol}(t - \tau)",
        "drift": rf"{symbol}(t) + c \, t",
    }
    return rf"{symbol}_\mathrm{{recorded}}(t) = {laws[freed]}"


def preset_arguments(
    channel: InstrumentChannel,
    freed: str,
    about: ParameterChanges,
    words: str,
    with_rate: bool = False,
) -> dict[str, Any]:
    """Return the arguments with which `preset_effect` defines one error of one recorded channel.

    The result is an effect such as a gain error of the yaw rate gyro, which a diagnosis tests.

    Args:
        channel: The recorded channel.
        freed: Parameter that a diagnosis fits (gain, offset, delay or drift); the others are zero.
        about: Attributes of that parameter.
        words: Description of the error.
        with_rate: Whether the error shows only in comparison with the recorded rate of the channel.
    """
    others = {"gain_fraction", "offset", "delay", "drift"} - {freed}
    columns = [channel.column]
    if with_rate:
        columns.append(channel.rate)
    return {
        "frees": {freed: about},
        "fixed": dict.fromkeys(sorted(others), 0.0),
        "formula": instrument_formula(channel, freed),
        "words": f"the recorded {channel.words} {words} (not physics)",
        "column": channel.column,
        "of_columns": (channel.column,),
        "needs_columns": tuple(columns),
        "needs": (channel.axis,),
        "special_case": True,
    }


def gain_error_preset(channel: InstrumentChannel, with_rate: bool = False) -> dict[str, Any]:
    """Return the arguments of `preset_effect` that define a gain error of a recorded channel."""
    about: ParameterChanges = {
        "words": f"relative error of the {channel.words}",
        "spread": GAIN_SPREAD,
        "in_per_cent": f"the recorded {channel.words} is {{larger}} than the true one",
    }
    settings = preset_arguments(channel, "gain_fraction", about, "is too small", with_rate)
    above = f"the recorded {channel.words} is too large (not physics)"
    return settings | {"words_above": above}


def offset_error_preset(channel: InstrumentChannel) -> dict[str, Any]:
    """Return the arguments of `preset_effect` for a constant error of a recorded channel."""
    about: ParameterChanges = {
        "words": f"constant error of the {channel.words}",
        "unit": channel.unit,
        "spread": OFFSET_SPREAD,
        "low": -channel.largest,
        "high": channel.largest,
    }
    return preset_arguments(channel, "offset", about, "has a constant error")


def drift_error_preset(channel: InstrumentChannel, with_rate: bool = False) -> dict[str, Any]:
    """Return the arguments of `preset_effect` for a channel's error that grows with time."""
    unit = f"{channel.unit}/s"
    if channel.unit.endswith("/s"):
        unit = f"{channel.unit}^2"
    about: ParameterChanges = {
        "words": f"growth of the error of the {channel.words}",
        "unit": unit,
        "spread": DRIFT_SPREAD,
        "low": -channel.largest,
        "high": channel.largest,
    }
    return preset_arguments(channel, "drift", about, "has an error that grows with time", with_rate)


def delay_error_preset(channel: InstrumentChannel) -> dict[str, Any]:
    """Return the arguments of `preset_effect` that define a delay of a recorded channel.

    Comparison with the recorded rate of the channel reveals the delay.
    """
    about: ParameterChanges = {
        "words": f"delay of the {channel.words}",
        "spread": DELAY_SPREAD,
    }
    return preset_arguments(channel, "delay", about, "is older than its rate in the same row", True)


SurgeVelocityGain = preset_effect(
    SensorError, "SurgeVelocityGain", **gain_error_preset(SURGE_VELOCITY)
)
SurgeVelocityOffset = preset_effect(
    SensorError, "SurgeVelocityOffset", **offset_error_preset(SURGE_VELOCITY)
)
SurgeVelocityDrift = preset_effect(
    SensorError, "SurgeVelocityDrift", **drift_error_preset(SURGE_VELOCITY)
)
SwayVelocityGain = preset_effect(
    SensorError, "SwayVelocityGain", **gain_error_preset(SWAY_VELOCITY)
)
SwayVelocityOffset = preset_effect(
    SensorError, "SwayVelocityOffset", **offset_error_preset(SWAY_VELOCITY)
)
SwayVelocityDrift = preset_effect(
    SensorError, "SwayVelocityDrift", **drift_error_preset(SWAY_VELOCITY)
)
HeaveVelocityGain = preset_effect(
    SensorError, "HeaveVelocityGain", **gain_error_preset(HEAVE_VELOCITY)
)
HeaveVelocityOffset = preset_effect(
    SensorError, "HeaveVelocityOffset", **offset_error_preset(HEAVE_VELOCITY)
)
HeaveVelocityDrift = preset_effect(
    SensorError, "HeaveVelocityDrift", **drift_error_preset(HEAVE_VELOCITY)
)
RollRateGain = preset_effect(SensorError, "RollRateGain", **gain_error_preset(ROLL_RATE))
RollRateOffset = preset_effect(SensorError, "RollRateOffset", **offset_error_preset(ROLL_RATE))
RollRateDrift = preset_effect(SensorError, "RollRateDrift", **drift_error_preset(ROLL_RATE))
PitchRateGain = preset_effect(SensorError, "PitchRateGain", **gain_error_preset(PITCH_RATE))
PitchRateOffset = preset_effect(SensorError, "PitchRateOffset", **offset_error_preset(PITCH_RATE))
PitchRateDrift = preset_effect(SensorError, "PitchRateDrift", **drift_error_preset(PITCH_RATE))
YawRateGain = preset_effect(SensorError, "YawRateGain", **gain_error_preset(YAW_RATE))
YawRateOffset = preset_effect(SensorError, "YawRateOffset", **offset_error_preset(YAW_RATE))
YawRateDrift = preset_effect(SensorError, "YawRateDrift", **drift_error_preset(YAW_RATE))
HeaveGain = preset_effect(SensorError, "HeaveGain", **gain_error_preset(HEAVE))
HeaveOffset = preset_effect(SensorError, "HeaveOffset", **offset_error_preset(HEAVE))
HeaveDrift = preset_effect(SensorError, "HeaveDrift", **drift_error_preset(HEAVE))
PitchGain = preset_effect(SensorError, "PitchGain", **gain_error_preset(PITCH))
PitchOffset = preset_effect(SensorError, "PitchOffset", **offset_error_preset(PITCH))
PitchDrift = preset_effect(SensorError, "PitchDrift", **drift_error_preset(PITCH))

# The recorded rate distinguishes these errors from motions.
RollGain = preset_effect(SensorError, "RollGain", **gain_error_preset(ROLL, True))
RollDrift = preset_effect(SensorError, "RollDrift", **drift_error_preset(ROLL, True))
HeadingDrift = preset_effect(SensorError, "HeadingDrift", **drift_error_preset(HEADING, True))
HeaveDelay = preset_effect(SensorError, "HeaveDelay", **delay_error_preset(HEAVE))
RollDelay = preset_effect(SensorError, "RollDelay", **delay_error_preset(ROLL))
PitchDelay = preset_effect(SensorError, "PitchDelay", **delay_error_preset(PITCH))
HeadingDelay = preset_effect(SensorError, "HeadingDelay", **delay_error_preset(HEADING))
