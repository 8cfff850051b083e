"""Unit of revolutions that a log does not state."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.channel_line import scale_of_signal
from boatsim.recordings.importing.channel_units import UNITS_OF_KINDS, unit_of_signal
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_text import printable_name
from boatsim.recordings.importing.track import Track
from boatsim.recordings.notes import unit_of

# Sizes relative to the range of the channel that a unit must have, and the largest ratio of speeds
# that a vessel file, a current and acceleration may cause
MIN_UNIT_EXCESS, MIN_UNIT_SHARE, MAX_UNIT_EXCESS = 3.0, 0.1, 1.5
MAX_SPEED_RATIO = 3.0
SPEED_PERCENTILE = 75.0  # [%] of revolutions and speeds that are compared


class RevolutionUnit:
    """Unit of revolutions that a log does not state, by their size and by the speed of the vessel.

    Two independent signs are needed: revolutions in rad/s would be far beyond the range of the
    channel and those in rpm are not, and the speed over ground is that of the vessel with
    revolutions in rpm and not in rad/s. With one sign the unit is left to the owner.

    Attributes:
        track: Motion by the positions; None if unknown.
        approach_speed: Speed of the vessel at the commands `ahead` of its channels [m/s], computed
            only where it is needed; 0 if unknown.
    """

    def __init__(self, track: Track | None, approach_speed: Callable[[], float]) -> None:
        self.track, self.approach_speed = track, approach_speed

    def with_unit(self, g: Classification, drive: VesselChannel) -> tuple[Classification, str]:
        """Return a signal with the unit that it shows, and what the owner must check."""
        stated = g.signal.unit or g.word or unit_of_signal(g)
        values = g.signal.values[np.isfinite(g.signal.values)]
        if stated or g.name == drive.name or not len(values):
            return g, ""
        size = float(np.max(np.abs(values)))
        limit = max(abs(drive.low), abs(drive.high))
        unit = unit_of(drive.name)
        excess = size > MAX_UNIT_EXCESS * limit and scale_of_signal(g, values, drive) is None
        if unit in UNITS_OF_KINDS["force"] and excess:
            return g, f"; CHECK: as {unit} up to {size / limit:.2g} times the vessel's range"
        if unit != "rad/s" or size < MIN_UNIT_EXCESS * limit:
            return g, ""
        rpm = UNITS["rpm"]
        by_size = MIN_UNIT_SHARE * limit < size * rpm < MAX_UNIT_EXCESS * limit
        ratio = self._speed_ratio(g, drive)
        by_speed = ratio > MAX_SPEED_RATIO and 1.0 / MAX_SPEED_RATIO < ratio * rpm < MAX_SPEED_RATIO
        as_it_is = f"as rad/s up to {size / limit:.2g} times the vessel's range"
        if by_size and by_speed:
            note = f"; in rpm: {as_it_is}, and for {ratio:.2g} times the speed of the track"
            return replace(g, word="rpm"), note
        signs = []
        if by_size:
            called = printable_name(g.name)
            signs.append(f'; CHECK: {as_it_is}; in rpm it would be "{called} * rpm"')
        return g, "".join(signs) or f"; CHECK: {as_it_is}"

    def _speed_ratio(self, g: Classification, drive: VesselChannel) -> float:
        """Speed by the signal in rad/s, relative to that of the track; 0 if unknown.

        The speed of a vessel is about proportional to her revolutions.
        """
        if self.track is None or not self.track.moves or not drive.ahead:
            return 0.0
        usual = float(np.nanpercentile(np.abs(g.signal.values), SPEED_PERCENTILE))
        over_ground = float(np.percentile(self.track.speed, SPEED_PERCENTILE))
        return usual / abs(drive.ahead) * self.approach_speed() / max(over_ground, 1e-9)
