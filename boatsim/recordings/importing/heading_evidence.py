"""Unit and sense of a heading by the course of the track, and the sense of its rate.

A vessel that makes way ahead moves about where her bow points. Over a track with turns only one
unit and one sense of the heading follow the course.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.importing.motion_names import CLOCKWISE, COUNTERCLOCKWISE, FROM_EAST
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.signal_units import has_stated_unit
from boatsim.recordings.importing.track import MAX_WINDOWS, MIN_WINDOWS, WINDOW, Track, values_in_si

# Resultant length of the differences between course and heading, 1 for a constant difference: from
# the first number on one follows the other, and below the second it does not. A vessel that drifts,
# or goes astern at times, lowers both
MIN_AGREEMENT, MAX_DISAGREEMENT = 0.7, 0.5
# Circular variance of the differences in the wrong unit, at least and relative to the right one: on
# a straight course both are small
MIN_SPREAD, SPREAD_RATIO = 0.1, 4.0
SPEED_PERCENTILE = 75.0  # above it a vessel makes way ahead, and drifts least
# Words of a name, heading of the axis from which such a heading counts [rad], and its name
SENSES = ((COUNTERCLOCKWISE, 0.0, "north"), (FROM_EAST, 0.5 * np.pi, "east"))
# [rad] of the mean difference; headings from north and east differ by a quarter turn
MAX_OFFSET = np.pi / 8.0
MIN_RATE_CORRELATION = 0.7  # of a rate with the changes of the heading that show its sense


class _Agreement(NamedTuple):
    """Resultant lengths and mean differences [rad] of a course with a heading in both senses."""

    clockwise: complex
    counterclockwise: complex


def heading_by_course(g: Classification, track: Track | None) -> Classification:
    """Return a heading with the unit and the sense in which it follows the course of a track.

    A unit that format or name states, and a sense that the name states, are kept. Another unit or
    sense is chosen if the heading follows the course with it and not as it is.

    Args:
        g: The heading, with the unit by its range.
        track: Motion by the positions; None if unknown.
    """
    if track is None or not track.moves:
        return g
    if not has_stated_unit(g.name, g.signal):
        other = "" if g.word == "deg" else "deg"
        changed = replace(g, word=other)
        as_it_is, with_other = _best(_agreement(g, track)), _best(_agreement(changed, track))
        is_worse = 1.0 - as_it_is > max(MIN_SPREAD, SPREAD_RATIO * (1.0 - with_other))
        if with_other > MIN_AGREEMENT and is_worse:
            unit = "degrees" if other else "radians"
            g = replace(changed, why=f"CHECK: {unit} by the course of the track")
    if g.tokens & (CLOCKWISE | COUNTERCLOCKWISE | FROM_EAST):
        return g
    return _with_sense(g, track)


def _with_sense(g: Classification, track: Track) -> Classification:
    """A heading whose name states no sense, with the sense in which it follows the course."""
    found = _agreement(g, track)
    if abs(found.clockwise) > MAX_DISAGREEMENT or abs(found.counterclockwise) < MIN_AGREEMENT:
        return g
    for marks, origin, name in SENSES:
        off = float(np.angle(found.counterclockwise * np.exp(-1j * origin)))
        if abs(off) < MAX_OFFSET:
            why = f"CHECK: counterclockwise from {name} by the course of the track"
            tokens = g.tokens | {min(marks)}
            return replace(g, tokens=tokens, why="; ".join(filter(None, (g.why, why))))
    return g


def rate_by_heading(g: Classification, heading: Classification) -> Classification:
    """Return a rate of turn with the sense in which it is the change of the heading.

    Args:
        g: The rate of turn.
        heading: The heading, with its sense.
    """
    t, rate = values_in_si(g)
    at, psi = values_in_si(heading)
    if len(t) < MIN_WINDOWS or len(at) < MIN_WINDOWS:
        return g
    begin, end = max(t[0], at[0]), min(t[-1], at[-1])
    rows = np.arange(begin, end - WINDOW, max(0.5 * WINDOW, (end - begin) / MAX_WINDOWS))
    if len(rows) < MIN_WINDOWS:
        return g
    integral = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)))
    by_rate = np.interp(rows + WINDOW, t, integral) - np.interp(rows, t, integral)
    psi = np.unwrap(psi)
    turned = np.interp(rows + WINDOW, at, psi) - np.interp(rows, at, psi)
    size = float(np.linalg.norm(by_rate) * np.linalg.norm(turned))
    if size == 0.0 or abs(float(by_rate @ turned)) < MIN_RATE_CORRELATION * size:
        return g
    reversed_heading = bool(heading.tokens & (COUNTERCLOCKWISE | FROM_EAST))
    is_counterclockwise = reversed_heading == bool(by_rate @ turned > 0.0)
    if is_counterclockwise == bool(g.tokens & (COUNTERCLOCKWISE | FROM_EAST)):
        return g
    tokens = g.tokens - COUNTERCLOCKWISE - FROM_EAST
    if is_counterclockwise:
        tokens |= {min(COUNTERCLOCKWISE)}
    why = f"CHECK: sign by the changes of {heading.name}"
    return replace(g, tokens=tokens, why="; ".join(filter(None, (g.why, why))))


def _agreement(g: Classification, track: Track) -> _Agreement:
    """Mean of the unit vectors of course minus and plus heading."""
    t, psi = values_in_si(g)
    inside = (track.t > t[0]) & (track.t < t[-1]) if len(t) else np.zeros(0, dtype=np.bool_)
    if inside.sum() < MIN_WINDOWS:
        return _Agreement(0j, 0j)
    fast = inside & (track.speed >= float(np.percentile(track.speed[inside], SPEED_PERCENTILE)))
    course = np.arctan2(track.east[fast], track.north[fast])
    bow = _nearest(track.t[fast], t, psi)
    return _Agreement(
        complex(np.mean(np.exp(1j * (course - bow)))), complex(np.mean(np.exp(1j * (course + bow))))
    )


def _nearest(rows: Array, t: Array, values: Array) -> Array:
    """The values (N,) of the nearest sample of each row."""
    if len(t) < 2:
        return np.full(len(rows), values[0])
    return np.asarray(values[np.searchsorted(0.5 * (t[1:] + t[:-1]), rows)])


def _best(found: _Agreement) -> float:
    """Share of the course along the heading, in the best of the senses."""
    shares = [found.clockwise.real]
    for _, origin, _ in SENSES:
        shares.append(float((found.counterclockwise * np.exp(-1j * origin)).real))
    return max(shares)
