"""When one file of a run begins after another, by the turning of the vessel that both show.

The course of a vessel turns later than her bow, by some tenths of a second for a small boat; the
begin of a track relative to a heading has this error.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.signal import correlate

from boatsim.physics.base import Array
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.track import track_of, values_in_si

RATE = 10.0  # [Hz] at which rates of turn are compared
SMOOTHING = 1.0  # [s] over which a rate is averaged, as that of a track is
MAX_DURATION = 3600.0  # [s] of a file that is compared
MIN_CORRELATION = 0.7  # of both rates of turn
# Any other time must leave this many times as much of the turning unexplained (1 - correlation^2).
# A boat in regular zigzags shows the same turning after each period, which tells no time
MIN_LEAD = 2.0
NEAR = 3.0  # [s] times closer than this are of one maximum
MIN_OVERLAP = 0.3  # share of the shorter file that must overlap
MIN_SPEED = 0.3  # of the median speed: the course of a slower vessel is noise


class Begin(NamedTuple):
    """Begin of a file after that of the first [s], and the correlation of both rates of turn."""

    seconds: float
    correlation: float


class TurnRate(NamedTuple):
    """Rate of turn at equal steps: time of the first value [s], and values (N,) [rad/s]."""

    begin: float
    values: Array


def begins_by_motion(
    best: Mapping[str, Sequence[Classification]], begins: Mapping[str, float]
) -> dict[str, Begin]:
    """Return when each further file of a run begins, if it shows the same turning as the first.

    Args:
        best: Column -> classified signals, the most probable first; signals have their file.
        begins: Name of each file -> its first time [s]; the first file is first.

    Returns:
        Name of a further file -> its begin; without files whose turning is not unmistakable.
    """
    first, *others = begins
    known = _turn_rate(_signals_of(best, first))
    if known is None:
        return {}
    found = {}
    for name in others:
        rate = _turn_rate(_signals_of(best, name))
        shift = None if rate is None else _best_shift(known, rate)
        if shift is not None:
            seconds = shift.seconds + begins[name] - begins[first]
            found[name] = Begin(round(seconds, 2), shift.correlation)
    return found


def _signals_of(
    best: Mapping[str, Sequence[Classification]], file: str
) -> dict[str, list[Classification]]:
    """The classified signals of one file."""
    found = {}
    for column, signals in best.items():
        own = [g for g in signals if g.signal.source == file]
        if own:
            found[column] = own
    return found


def _turn_rate(best: Mapping[str, Sequence[Classification]]) -> TurnRate | None:
    """Rate of turn by a gyroscope, a heading, or the course of a track; None without one."""
    if best.get("r_radps"):
        t, rate = values_in_si(best["r_radps"][0])
        if len(t) < 2:
            return None
        angle = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)))
        return _differenced(t, angle)
    if best.get("psi_rad"):
        t, psi = values_in_si(best["psi_rad"][0])
        return _differenced(t, np.unwrap(psi))
    track = track_of(best)
    if track is None or not track.moves:
        return None
    fast = track.speed > MIN_SPEED * float(np.median(track.speed))
    if fast.sum() < 2:
        return None
    course = np.unwrap(np.arctan2(track.east[fast], track.north[fast]))
    return _differenced(track.t[fast], course)


def _differenced(t: Array, angle: Array) -> TurnRate | None:
    """Rate of an angle, averaged over a second."""
    if len(t) < 2 or t[-1] - t[0] < 10.0 * SMOOTHING:
        return None
    end = min(float(t[-1]), float(t[0]) + MAX_DURATION)
    rows = np.arange(float(t[0]) + SMOOTHING, end - SMOOTHING, 1.0 / RATE)
    ahead = np.interp(rows + 0.5 * SMOOTHING, t, angle)
    behind = np.interp(rows - 0.5 * SMOOTHING, t, angle)
    return TurnRate(float(rows[0]), (ahead - behind) / SMOOTHING)


def _best_shift(known: TurnRate, rate: TurnRate) -> Begin | None:
    """Time to add to those of `rate` so that both agree; None if several times agree."""
    a, b = known.values - known.values.mean(), rate.values - rate.values.mean()
    product = correlate(a, b, "full")
    ones = np.ones_like
    counts = np.round(correlate(ones(a), ones(b), "full"))
    size = np.sqrt(
        np.maximum(correlate(a**2, ones(b), "full"), 0.0)
        * np.maximum(correlate(ones(a), b**2, "full"), 0.0)
    )
    enough = counts >= MIN_OVERLAP * min(len(a), len(b))
    scores = np.where(enough & (size > 0.0), np.abs(product) / np.maximum(size, 1e-30), 0.0)
    at = int(np.argmax(scores))
    far = np.abs(np.arange(len(scores)) - at) > NEAR * RATE
    second = float(scores[far].max(initial=0.0))
    best = float(scores[at])
    if best < MIN_CORRELATION or 1.0 - second**2 < MIN_LEAD * (1.0 - best**2):
        return None
    steps = at - (len(b) - 1)
    return Begin(known.begin + steps / RATE - rate.begin, best)
