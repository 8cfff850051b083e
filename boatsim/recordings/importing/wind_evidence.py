"""Frame, sense and unit of a recorded wind by the motion of a boat.

A wind aboard contains the velocity of the boat. In the right unit the difference of both is a wind
over ground that is nearly steady, while the boat turns and changes its speed.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.track import MIN_WINDOWS, Track, values_in_si

Complex = NDArray[np.complex128]
APPARENT, TRUE = "apparent", "true"
SPEED_WORDS = {"": 1.0, "kn": UNITS["kn"], "kmh": UNITS["kmh"]}  # unit -> m/s
GUST_TIME = 10.0  # [s] over which gusts are correlated, so that fewer values are independent
TOLERANCE = 1.25  # factor by which an anemometer may be wrong; the units differ by 1.85 and more
LEAST_DEVIATIONS = 4.0  # standard deviations by which the other units are excluded
# Share of the scatter of one reading of the angle below which another one is excluded; two frames
# differ by the velocity of the boat, which is known well
LARGEST_SHARE = 0.5


class WindEvidence(NamedTuple):
    """Evidence of the motion on a pair of wind speed and direction.

    Attributes:
        frame: APPARENT or TRUE; "" if the motion does not show it.
        to_port: Whether the angle counts to port.
        unit: Unit of the speed as a word of expressions, "" for m/s; None if unknown.
        goes_to: Whether the angle is the direction to which the wind goes.
    """

    frame: str = ""
    to_port: bool = False
    unit: str | None = None
    goes_to: bool = False


class _Reading(NamedTuple):
    """One meaning of the angle: slope of the recorded wind on the velocity, and the scatter.

    A boat that moves meets the wind of her own speed from ahead: in m/s the slope is 1 for an angle
    from which the wind comes, and -1 for one to which it goes.
    """

    frame: str
    to_port: bool
    slope: float
    sd: float
    scatter: float

    @property
    def goes_to(self) -> bool:
        """Whether the recorded wind falls with the speed of the boat against it."""
        return self.slope < -LEAST_DEVIATIONS * self.sd


def wind_evidence(
    speed: Classification,
    angle: Classification,
    track: Track | None,
    heading: Classification | None,
    frame: str = "",
) -> WindEvidence:
    """Return what the motion of a boat shows of a recorded wind.

    Args:
        speed: Speed of the wind, in the unit of the log.
        angle: Its direction, with its unit.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
        frame: Frame that the names state; "" if they state none.
    """
    if track is None or not track.moves or heading is None:
        return WindEvidence(frame)
    pieces = _common_values(speed, angle, track, heading)
    if pieces is None:
        return WindEvidence(frame)
    strength, comes_from, velocity, bow, count = pieces
    readings = []
    for to_port in (False, True):
        sense = -1.0 if to_port else 1.0
        recorded = strength * np.exp(1j * (bow + sense * comes_from))
        readings.append(_reading(APPARENT, to_port, recorded, velocity, count))
    readings.append(_reading(TRUE, False, strength * np.exp(1j * comes_from), velocity, count))
    if frame:
        readings = [one for one in readings if one.frame == frame]
    usual = readings[0]
    readings.sort(key=lambda one: one.scatter)
    best = readings[0]
    if all(best.scatter < LARGEST_SHARE * one.scatter for one in readings[1:]):
        return WindEvidence(best.frame, best.to_port, _unit(best), best.goes_to)
    if frame:
        return WindEvidence(frame, False, _unit(usual), usual.goes_to)
    return WindEvidence()


def water_speed_unit(
    speed: Classification, track: Track | None, heading: Classification | None
) -> str | None:
    """Return the unit of a speed through the water by the motion of the boat; None if unknown.

    The water, like the air, moves nearly steadily over ground: its velocity is that of the boat
    less the recorded speed along the bow.

    Args:
        speed: Speed through the water, ahead, in the unit of the log.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
    """
    if track is None or not track.moves or heading is None:
        return None
    ahead = replace(speed, signal=replace(speed.signal, values=0.0 * speed.signal.values))
    pieces = _common_values(speed, ahead, track, heading)
    if pieces is None:
        return None
    strength, _, velocity, bow, count = pieces
    return _unit(_reading(APPARENT, False, strength * np.exp(1j * bow), velocity, count))


def _common_values(
    speed: Classification, angle: Classification, track: Track, heading: Classification
) -> tuple[Array, Array, Complex, Array, float] | None:
    """Speed, angle, velocity over ground and heading at common times, and independent values."""
    t, strength = values_in_si(speed)
    at, comes_from = values_in_si(angle)
    of_heading, psi = values_in_si(heading)
    if min(len(t), len(at), len(of_heading)) < MIN_WINDOWS:
        return None
    begin = max(t[0], at[0], of_heading[0])
    end = min(t[-1], at[-1], of_heading[-1])
    inside = (track.t > begin) & (track.t < end)
    rows = track.t[inside]
    if len(rows) < MIN_WINDOWS:
        return None
    velocity = (track.north + 1j * track.east)[inside]
    count = max((end - begin) / GUST_TIME, 2.0)
    return (
        np.interp(rows, t, strength),
        np.interp(rows, at, np.unwrap(comes_from)),
        velocity,
        np.interp(rows, of_heading, np.unwrap(psi)),
        count,
    )


def _reading(
    frame: str, to_port: bool, recorded: Complex, velocity: Complex, count: float
) -> _Reading:
    """Regression of the recorded wind on the velocity of the boat; none for a true wind."""
    moved = velocity - velocity.mean()
    power = float(np.mean(np.abs(moved) ** 2))
    slope = 0.0
    if frame == APPARENT and power > 0.0:
        slope = float(np.mean((recorded - recorded.mean()) * moved.conj()).real) / power
    wind = recorded - slope * velocity
    scatter = float(np.var(wind))
    sd = np.sqrt(scatter / (2.0 * count * power)) if power > 0.0 else np.inf
    size = float(np.mean(np.abs(recorded) ** 2))
    return _Reading(frame, to_port, slope, float(sd), scatter / max(size, 1e-12))


def _unit(reading: _Reading) -> str | None:
    """The unit of an apparent wind whose slope excludes all others; None if there is none."""
    if reading.frame != APPARENT:
        return None
    slopes = {word: 1.0 / factor for word, factor in SPEED_WORDS.items()}
    own = -reading.slope if reading.goes_to else reading.slope
    found = [w for w, s in slopes.items() if 1.0 / TOLERANCE < own / s < TOLERANCE]
    if len(found) != 1:
        return None
    for word, slope in slopes.items():
        if word != found[0] and abs(own - slope) < LEAST_DEVIATIONS * reading.sd:
            return None
    return found[0]
