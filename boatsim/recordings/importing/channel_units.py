"""Units of a channel and a signal: whether the signal may command the channel."""

from dataclasses import replace

import numpy as np

from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.foreign_words import english_unit
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_words import HELM, tokenize_name
from boatsim.recordings.notes import unit_of

ALL_AROUND = 3.1  # [rad] to each side: a thruster that turns around, whose angle may be counted on
HELM_EXCESS = 1.05  # a wheel that turns farther than the rudder by more than this is geared to it
AZIMUTHS = {"azimuth", "azi"}  # words of a drive that turns itself, without a geared wheel
QUARTER_TURN = 90.0  # [deg] a signal with such a word may be that of a wheel up to here
# Numbers of a helm are degrees if the largest is at least this share of full helm
MIN_HELM_SHARE = 0.6
UNITS_OF_KINDS = {
    "angle": ("rad", "deg"),
    "turning": ("rad/s", "deg/s", "1/s", "1/min", "rpm"),
    "force": ("N", "kN"),
}


def units_are_compatible(drive: VesselChannel, g: Classification) -> bool:
    """Return whether channel and signal may be of one kind: angle, rate or force.

    Pulses and plain numbers fit any kind.

    Args:
        drive: The channel.
        g: The signal.
    """
    kinds = (_kind_of(unit_of(drive.name)), _kind_of(unit_of_signal(g)))
    return "" in kinds or kinds[0] == kinds[1]


def are_of_one_kind(drive: VesselChannel, g: Classification) -> bool:
    """Return whether channel and signal are both known to be angles, rates or forces.

    Args:
        drive: The channel.
        g: The signal.
    """
    kind = _kind_of(unit_of(drive.name))
    return bool(kind) and kind == _kind_of(unit_of_signal(g))


def may_be_command_of(drive: VesselChannel, g: Classification) -> bool:
    """Return whether a signal may command a channel, by their units.

    Args:
        drive: The channel.
        g: The signal.
    """
    return units_are_compatible(drive, g) or is_thrust_by_revolutions(drive, g)


def is_thrust_by_revolutions(drive: VesselChannel, g: Classification) -> bool:
    """Return whether the channel is a thrust and the signal revolutions.

    Args:
        drive: The channel.
        g: The signal.
    """
    return (
        unit_of(drive.name) in UNITS_OF_KINDS["force"]
        and unit_of_signal(g) in UNITS_OF_KINDS["turning"]
    )


def unit_of_signal(g: Classification) -> str:
    """Return the unit of a signal by its format, else by its name; "" if unknown."""
    if g.signal.unit:
        return english_unit(g.signal.unit) or g.signal.unit
    return {"deg": "deg", "rpm": "rpm", "degps": "deg/s"}.get(g.word, unit_of(g.name))


def is_steering_channel(drive: VesselChannel) -> bool:
    """Return whether a channel is an angle or has the name of one."""
    unit = unit_of(drive.name)
    if unit:
        return unit == "rad"
    return not HELM.isdisjoint(tokenize_name(drive.name))


def with_unit_of_helm(g: Classification, drive: VesselChannel) -> Classification:
    """Return a signal in degrees, if its numbers are the degrees of the range of a helm.

    Args:
        g: The signal.
        drive: The channel.
    """
    if unit_of(drive.name) != "rad" or g.word or g.signal.unit:
        return g
    span = max(abs(drive.low), abs(drive.high))
    largest = float(np.radians(np.nanmax(np.abs(g.signal.values))))
    if MIN_HELM_SHARE * span < largest <= HELM_EXCESS * span and span < ALL_AROUND:
        return replace(g, word="deg")
    return g


def is_azimuth(g: Classification) -> bool:
    """Return whether a signal in degrees is the direction of a drive, by its name and its range.

    Args:
        g: The signal.
    """
    if g.word != "deg" or g.tokens.isdisjoint(AZIMUTHS):
        return False
    return float(np.nanmax(np.abs(g.signal.values))) > HELM_EXCESS * QUARTER_TURN


def _kind_of(unit: str) -> str:
    for kind, units in UNITS_OF_KINDS.items():
        if unit in units:
            return kind
    return ""
