"""Compiled functions that change one channel of a recorded motion: the mechanism of sensor errors.

A channel is a place among the fields of `MeasuredMotion`. All measurement effects that concern
single channels use these functions.
"""

from math import cos, sin, tan
from typing import NamedTuple

import numpy as np

from boatsim.physics.kernel.compiling import merged
from boatsim.physics.signals import STATE, MeasuredMotion

CHANNELS = tuple(signal.column for signal in STATE)  # in the order of the fields
# as 64-bit integers: numba would compile a function for each value of a plain integer
X, Y, Z, PHI, THETA, PSI, U, V, W, P, Q, R = np.arange(12)


class InstrumentChannel(NamedTuple):
    """Recorded channel (such as heading) whose instrument may have an error of its own.

    Positions x and y are not among them, because one position fix contains both.
    """

    column: str
    axis: str  # degree of freedom
    words: str
    unit: str
    largest: float  # [unit] bound of a constant error
    rate: str = ""  # column of its rate, where that is another channel


HEAVE = InstrumentChannel("z_m", "heave", "heave", "m", 100.0, "w_mps")
ROLL = InstrumentChannel("phi_rad", "roll", "roll", "rad", 1.0, "p_radps")
PITCH = InstrumentChannel("theta_rad", "pitch", "pitch", "rad", 1.0, "q_radps")
HEADING = InstrumentChannel("psi_rad", "yaw", "heading", "rad", 1.0, "r_radps")
SURGE_VELOCITY = InstrumentChannel("u_mps", "surge", "surge velocity", "m/s", 50.0)
SWAY_VELOCITY = InstrumentChannel("v_mps", "sway", "sway velocity", "m/s", 50.0)
HEAVE_VELOCITY = InstrumentChannel("w_mps", "heave", "heave velocity", "m/s", 50.0)
ROLL_RATE = InstrumentChannel("p_radps", "roll", "roll rate", "rad/s", 10.0)
PITCH_RATE = InstrumentChannel("q_radps", "pitch", "pitch rate", "rad/s", 10.0)
YAW_RATE = InstrumentChannel("r_radps", "yaw", "yaw rate", "rad/s", 10.0)
INSTRUMENT_CHANNELS = (
    HEAVE,
    ROLL,
    PITCH,
    HEADING,
    SURGE_VELOCITY,
    SWAY_VELOCITY,
    HEAVE_VELOCITY,
    ROLL_RATE,
    PITCH_RATE,
    YAW_RATE,
)


@merged
def select_if(condition: bool, value: float, other: float) -> float:
    """Return `value` if the condition holds, else `other`; an expression for compiled code."""
    if condition:
        return value
    return other


@merged
def with_channel(m: MeasuredMotion, channel: np.int64, value: float) -> MeasuredMotion:
    """Return a recorded motion in which one channel, such as the heading, has another value.

    Args:
        m: Motion: position [m], attitude [rad], velocities [m/s], rates [rad/s].
        channel: Index of the channel among the fields of the motion.
        value: Its new value, in the unit of the channel.
    """
    return MeasuredMotion(
        select_if(channel == X, value, m.x),
        select_if(channel == Y, value, m.y),
        select_if(channel == Z, value, m.z),
        select_if(channel == PHI, value, m.phi),
        select_if(channel == THETA, value, m.theta),
        select_if(channel == PSI, value, m.psi),
        select_if(channel == U, value, m.u),
        select_if(channel == V, value, m.v),
        select_if(channel == W, value, m.w),
        select_if(channel == P, value, m.p),
        select_if(channel == Q, value, m.q),
        select_if(channel == R, value, m.r),
    )


@merged
def channel_rate(m: MeasuredMotion, channel: np.int64, delay: float) -> float:
    """Return the mean rate of change of one motion channel over the last `delay` seconds.

    The vessel turns steadily over the delay, so that the chord of its turn stands for the arc. For
    x, y and psi the hull is level: terms of second order in roll and pitch are neglected. The
    accelerations are unknown, therefore the rate of a velocity is zero.

    Args:
        m: Motion at the end of the delay.
        channel: Index of the channel among the fields of the motion.
        delay: The delay [s].

    Returns:
        Rate of change [unit of the channel / s].
    """
    if channel == X or channel == Y:
        middle = m.psi - 0.5 * delay * m.r
        c, s = cos(middle), sin(middle)
        return select_if(channel == X, c * m.u - s * m.v, s * m.u + c * m.v)
    if channel == Z:
        return (m.v * sin(m.phi) + m.w * cos(m.phi)) * cos(m.theta) - m.u * sin(m.theta)
    if channel == PHI:
        return m.p + (m.q * sin(m.phi) + m.r * cos(m.phi)) * tan(m.theta)
    if channel == THETA:
        return m.q * cos(m.phi) - m.r * sin(m.phi)
    return select_if(channel == PSI, m.r, 0.0)


@merged
def delayed_channel(m: MeasuredMotion, channel: np.int64, delay: float) -> float:
    """Return the value that one motion channel had `delay` seconds ago, to first order.

    Args:
        m: Present motion.
        channel: Index of the channel among the fields of the motion.
        delay: The delay [s].
    """
    return m[channel] - delay * channel_rate(m, channel, delay)
