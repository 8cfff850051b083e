"""Line of a proposed map for one channel: the signal, its scale or its unit."""

from typing import NamedTuple

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.channel_units import (
    ALL_AROUND,
    HELM_EXCESS,
    is_azimuth,
    is_thrust_by_revolutions,
    unit_of_signal,
)
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.drive_names import PULSE
from boatsim.recordings.importing.effort_allocation import USUAL_PULSE
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import expression_of, printable_name, sampling_rate
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.importing.single_axis import is_load_of_channel
from boatsim.recordings.importing.turning import MIN_CORRELATION
from boatsim.recordings.notes import unit_of


def channel_line(
    name: str, g: Classification, drive: VesselChannel | None, sense: float = 0.0
) -> str:
    """Return the line of a channel.

    Args:
        name: Name of the column.
        g: The signal.
        drive: Channel of the vessel; None if unknown.
        sense: Correlation of the signal with turning to the side of the channel, -1 for the
            opposite side.
    """
    values = g.signal.values[np.isfinite(g.signal.values)]
    low, high = -1.0, 1.0
    if drive:
        low, high = drive.low, drive.high
    note = f"  # {sampling_rate(g.signal):.3g} Hz"
    if g.signal.about:
        note += f"; {printable_name(g.signal.about)}"
    if drive and is_load_of_channel(g.tokens, tokenize_name(name)) and not unit_of_signal(g):
        note += f"; CHECK: assumed to be in {unit_of(name) or 'the unit of the channel'}"
    turned = sense < -MIN_CORRELATION
    if turned:
        note += (
            "; CHECK: sign inverted, for the boat turns to the opposite side (correlation "
            f"{sense:+.2f})"
        )
    scale = scale_of_signal(g, values, drive)
    if scale is None:
        expression = expression_with_unit(g, name)
        if drive and _is_raw_command(g, values, drive):
            expression = g.name
        if turned:
            expression = f"-{expression}"
        if drive and _turns_beyond(g, values, drive):
            note += (
                f"; CHECK: the vessel's {name} allows only {np.degrees(low):.0f} to "
                f"{np.degrees(high):.0f} deg, the signal is {values.min():.0f} to "
                f"{values.max():.0f} deg: set low and high of the channel in vessel.toml to the "
                "range of the drive"
            )
        return f"{toml_key(name)} = {toml_value(expression)}{note}"
    if turned:
        low, high = high, low
    given = "low = {:g}, neutral = {:g}, high = {:g}".format(*scale.ends)
    if scale.why:
        note += f"; {scale.why}"
    if drive and unit_of(drive.name) == "rad":
        note += (
            f"; CHECK: full helm is assumed to be {np.degrees(max(abs(low), abs(high))):.0f} deg"
        )
    law = ""
    if scale.exponent != 1.0:
        law = f", exponent = {scale.exponent:g}"
    return (
        f"{toml_key(name)} = {{ signal = {toml_value(g.name)}, {given}, least = {low:g}, most = "
        f"{high:g}{law} }}{note}"
    )


class Scale(NamedTuple):
    """Conversion of a signal to a share of full command.

    Attributes:
        ends: Low, neutral and high value of the signal.
        why: Source of these values.
        exponent: Exponent of the share.
    """

    ends: tuple[float, float, float]
    why: str
    exponent: float = 1.0


def scale_of_signal(
    g: Classification,
    values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]",
    drive: VesselChannel | None,
) -> Scale | None:
    """Return the scale of a signal that is a share of full command; None for another signal.

    Args:
        g: The signal.
        values: Its known values (N,).
        drive: Channel of the vessel; None if unknown.
    """
    share = "in proportion to full command"
    if drive and (g.name == drive.name or _is_raw_command(g, values, drive)):
        return None
    if g.signal.pulse:
        why = ""
        if drive:
            why = share
        return Scale(g.signal.pulse, why)
    if PULSE[0] <= values.min() and values.max() <= PULSE[1]:
        return Scale(USUAL_PULSE, f"usual pulses of 1100 to 1900 us are assumed, {share}")
    largest = float(np.max(np.abs(values)))
    if drive is None or is_load_of_channel(g.tokens, tokenize_name(drive.name)):
        return None
    if is_thrust_by_revolutions(drive, g):
        why = "thrust by the square of the revolutions; CHECK: those of full thrust, here the most"
        return Scale((-largest, 0.0, largest), why, 2.0)
    span = max(abs(drive.low), abs(drive.high))
    if g.word == "deg" and unit_of(drive.name) == "rad":
        if span > ALL_AROUND or np.radians(largest) <= HELM_EXCESS * span or is_azimuth(g):
            return None
        why = "the wheel turns farther than the rudder; CHECK: full wheel, here the largest angle"
        return Scale((-largest, 0.0, largest), why)
    if unit_of(drive.name) and g.word and g.word != "percent":
        return None
    if g.word == "percent" and (span != 100.0 or unit_of(drive.name)):
        return Scale((-100.0, 0.0, 100.0), f"per cent, {share}")
    if g.name != drive.name and 1.5 < largest <= 100.0 and not 0.3 < largest / span < 1.01:
        return Scale((-100.0, 0.0, 100.0), f"per cent by its range, {share}")
    if largest <= 1.01 and span > 2.0:
        return Scale((-1.0, 0.0, 1.0), f"-1 to 1, {share}")
    return None


def _is_raw_command(
    g: Classification,
    values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]",
    drive: VesselChannel,
) -> bool:
    """Whether a signal is the raw command of a channel without a unit, such as per cent or pulses.

    The file of the vessel converts it to thrust.
    """
    if unit_of(drive.name) or g.word not in ("percent", "us"):
        return False
    if g.word == "percent" and max(abs(drive.low), abs(drive.high)) != 100.0:
        return False
    return bool(drive.low <= values.min() and values.max() <= drive.high)


def _turns_beyond(
    g: Classification,
    values: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]",
    drive: VesselChannel,
) -> bool:
    """Whether a signal is the direction of a drive that the vessel's file lets turn less far."""
    if unit_of(drive.name) != "rad" or not is_azimuth(g):
        return False
    span = max(abs(drive.low), abs(drive.high))
    largest = np.radians(np.max(np.abs(values)))
    return span <= ALL_AROUND and bool(largest > HELM_EXCESS * span)


def expression_with_unit(g: Classification, name: str) -> str:
    """Return the expression of a signal in the unit of a column.

    Args:
        g: The signal.
        name: Name of the column.
    """
    if g.name == name or g.word == "rpm" and name.endswith("_rpm"):
        return g.name
    if g.word == "rpm" and name.endswith("_rps"):
        return f"{g.name} / 60"
    return expression_of(g)
