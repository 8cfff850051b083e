"""Motion of a vessel by the positions in a log, and columns that contradict it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.expression import UNITS, parse
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.signal_classification import NOT_MEASURED, Classification
from boatsim.recordings.importing.signal_words import tokenize_name

EARTH_RADIUS = 6.371e6  # [m] mean radius; 0.3 % is enough to compare speeds
WINDOW = 1.0  # [s] over which positions are differenced
MIN_WINDOWS = 20  # of a comparison
MAX_WINDOWS = 100_000  # of a comparison; a day has fewer, a wrong time makes a log of years
# A track that extends over this many times its noise is that of a moving vessel
MIN_EXTENT = 20.0
# A speed is contradicted if its correlation with that of the track is below the first number, and
# its difference from it exceeds the second one, relative to the speed of the track. Errors of sign,
# unit and delay have a larger correlation; the checks of a recording find them
MAX_CORRELATION = 0.5
MIN_DIFFERENCE = 0.7
# An error of the heading turns a part of the speed ahead into one to starboard: a compass may be
# off by 5 deg, and course and heading are not logged at the same instant
HEADING_ERROR = 0.1  # [rad]
MIN_RATE_CORRELATION = 0.7  # of a rate with the changes of the heading that show its unit
SPEED_UNITS = ("kn", "kmh")
MIN_UNIT_CORRELATION = 0.9  # of a speed with that of the track that shows its unit
UNIT_TOLERANCE = 1.15  # factor by which a log of speed may be wrong; the units differ by 1.85
STRAIGHT = 0.2  # [rad] a constant heading is true on a course that differs by no more than this
LATITUDES, LONGITUDES = ("lat", "latitude"), ("lon", "lng", "long", "longitude")


@dataclass(frozen=True)
class Track:
    """Velocities of a vessel by its positions.

    Attributes:
        t: Times (N,) of the middle of each window [s].
        north: Velocities (N,) to the north [m/s].
        east: Velocities (N,) to the east [m/s].
        extent: Largest extent of the track [m].
        noise: Scatter of the positions [m].
    """

    t: Array
    north: Array
    east: Array
    extent: float
    noise: float

    @property
    def moves(self) -> bool:
        """Whether the vessel moved."""
        return self.extent > MIN_EXTENT * self.noise

    @property
    def speed(self) -> Array:
        """Speeds over ground (N,) [m/s]."""
        return np.hypot(self.north, self.east)


def values_in_si(g: Classification) -> tuple[Array, Array]:
    """Return times (N,) [s] and values (N,) of a signal in SI units, sorted, without nan."""
    values = g.signal.values
    if g.word:
        values = parse(f"x * {g.word}", ()).convert(values)
    known = np.isfinite(values) & np.isfinite(g.signal.t)
    t, rows = np.unique(g.signal.t[known], return_index=True)
    return t, values[known][rows]


def track_of(best: Mapping[str, Sequence[Classification]]) -> Track | None:
    """Return the motion by the positions of a log; None without positions.

    Args:
        best: Column -> classified signals, the most probable first.
    """
    found = positions_of(best)
    return None if found is None else track_of_positions(*found)


def positions_of(
    best: Mapping[str, Sequence[Classification]],
) -> tuple[Array, Array, Array] | None:
    """Return times (N,) [s] and positions (N,) to the north and east [m] of a log.

    Args:
        best: Column -> classified signals, the most probable first.

    Returns:
        None without positions.
    """
    for first, second in (("latitude", "longitude"), ("x_m", "y_m")):
        if not best.get(first) or not best.get(second):
            continue
        t, north, east = _in_common_rows(
            *values_in_si(best[first][0]), *values_in_si(best[second][0])
        )
        if first == "latitude":
            there = (north != 0.0) | (east != 0.0)
            t, north, east = t[there], north[there], east[there]
        if len(t) < 2:
            continue
        if first == "latitude":
            east = EARTH_RADIUS * np.cos(np.median(north)) * (east - east[0])
            north = EARTH_RADIUS * (north - north[0])
        return t, north, east
    return None


def _in_common_rows(t: Array, x: Array, other: Array, y: Array) -> tuple[Array, Array, Array]:
    """Times (K,) [s] at which both coordinates are known, and their values (K,).

    Equally many coordinates with times of their own are pairs, each one message after the other.
    """
    common, rows, others = np.intersect1d(t, other, assume_unique=True, return_indices=True)
    if len(t) == len(other) and 2 * len(common) < len(t):
        return t, x, y
    return common, x[rows], y[others]


def constant_heading_fault(t: Array, x: Array, y: Array, psi: Array) -> str:
    """Return why a constant heading (K,) [rad] was not measured: the boat moves, but not along it.

    Returns "" for a heading that varies or may have been measured.

    Args:
        t: Times (N,) of the positions [s].
        x: Positions (N,) to the north [m].
        y: Positions (N,) to the east [m].
        psi: Headings (K,) [rad], not all of them at times of positions.
    """
    if len(t) < 2 or not len(psi) or float(np.ptp(psi)) > 0.0:
        return ""
    track = track_of_positions(t, x, y)
    if not track.moves or _is_course(float(psi[0]), track):
        return ""
    return (
        f"is {np.degrees(psi[0]):g} deg in all {len(psi)} samples, but the track extends over "
        f"{_m(track)}: no heading was measured"
    )


def track_of_positions(t: Array, north: Array, east: Array) -> Track:
    """Return the motion by positions.

    Args:
        t: Times (N,) [s], increasing.
        north: Positions (N,) to the north [m].
        east: Positions (N,) to the east [m].
    """
    new = np.append(True, (np.diff(north) != 0.0) | (np.diff(east) != 0.0))
    extent = float(max(np.ptp(north), np.ptp(east)))
    noise = 0.0
    if new.sum() > 3:
        z = (north + 1j * east)[new]
        noise = float(np.median(np.abs(np.diff(z, 2)))) / np.sqrt(6.0)
    begin, end = rows_one_window_apart(t)
    span = t[end] - t[begin]
    return Track(
        0.5 * (t[begin] + t[end]),
        (north[end] - north[begin]) / span,
        (east[end] - east[begin]) / span,
        extent,
        noise,
    )


def rows_one_window_apart(t: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return pairs of rows `WINDOW` apart, between which values are differenced; no gap is bridged.

    Args:
        t: Times (N,) [s], increasing.

    Returns:
        First and second rows (M,) of the pairs.
    """
    after = np.searchsorted(t, t + WINDOW)
    inside = after < len(t)
    begin, end = np.flatnonzero(inside), after[inside]
    near = t[end] - t[begin] < 2.0 * WINDOW
    return begin[near], end[near]


def reason_not_measured(
    column: str, g: Classification, track: Track | None, heading: Classification | None
) -> str:
    """Return why a signal is no measurement of a motion, "" if nothing contradicts it.

    Args:
        column: Column of a recording.
        g: The signal.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
    """
    t, values = values_in_si(g)
    if track is None or not track.moves or not len(values):
        return ""
    if float(np.ptp(values)) == 0.0:
        if column == "psi_rad" and _is_course(float(values[0]), track):
            return ""
        value = float(g.signal.values[np.isfinite(g.signal.values)][0]) + 0.0  # no -0
        return f"it is {value:g} throughout, but the track extends over {_m(track)}"
    if column in ("u_mps", "v_mps") and heading is not None:
        return _speed_contradiction(column, t, values, track, heading)
    return ""


def _m(track: Track) -> str:
    return f"{track.extent:.3g} m"


def _is_course(psi: float, track: Track) -> bool:
    """Whether a heading [rad] is the course of the whole track."""
    fast = track.speed > 0.5 * float(np.median(track.speed))
    off = np.angle((track.north + 1j * track.east)[fast] * np.exp(-1j * psi))
    return bool(len(off)) and float(np.percentile(np.abs(off), 90)) < STRAIGHT


def speed_unit(
    column: str, g: Classification, track: Track | None, heading: Classification | None
) -> str:
    """Return the unit of a speed that states none, by the speed of the track; "" for m/s.

    Two signs are needed: the speed follows that of the track, and their ratio is that of a unit.

    Args:
        column: u_mps or v_mps.
        g: The speed, taken as m/s.
        track: Motion by the positions; None if unknown.
        heading: The heading; None if unknown.
    """
    if track is None or not track.moves or heading is None:
        return ""
    t, values = values_in_si(g)
    expected, recorded = _speeds(column, t, values, track, heading)
    if not len(expected) or _correlation(recorded, expected) < MIN_UNIT_CORRELATION:
        return ""
    ratio = float(np.linalg.norm(recorded) / np.linalg.norm(expected))
    for unit in SPEED_UNITS:
        factor = ratio * UNITS[unit]
        if 1.0 / UNIT_TOLERANCE < factor < UNIT_TOLERANCE:
            return unit
    return ""


def _speeds(
    column: str, t: Array, values: Array, track: Track, heading: Classification
) -> tuple[Array, Array]:
    """Speeds (K,) of the hull by its track, and recorded ones; empty for too few windows."""
    at, psi = values_in_si(heading)
    if not len(t) or not len(at):
        return np.empty(0), np.empty(0)
    inside = (track.t > max(t[0], at[0])) & (track.t < min(t[-1], at[-1]))
    if inside.sum() < MIN_WINDOWS:
        return np.empty(0), np.empty(0)
    rows = track.t[inside]
    bow = np.exp(1j * np.interp(rows, at, np.unwrap(psi)))
    along = (track.north + 1j * track.east)[inside] * bow.conj()
    expected = along.real
    if column == "v_mps":
        expected = along.imag
    integral = np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(t)))
    half = 0.5 * WINDOW
    recorded = (np.interp(rows + half, t, integral) - np.interp(rows - half, t, integral)) / WINDOW
    return expected, recorded


def _correlation(a: Array, b: Array) -> float:
    """Correlation; 0 for a constant signal."""
    if a.std() > 0.0 and b.std() > 0.0:
        return float(np.corrcoef(a, b)[0, 1])
    return 0.0


def _speed_contradiction(
    column: str, t: Array, values: Array, track: Track, heading: Classification
) -> str:
    expected, recorded = _speeds(column, t, values, track, heading)
    if not len(expected):
        return ""
    size = float(np.sqrt(np.mean(expected**2)))
    difference = float(np.sqrt(np.mean((recorded - expected) ** 2)))
    if size == 0.0 or difference < MIN_DIFFERENCE * size:
        return ""
    hidden = HEADING_ERROR * float(np.sqrt(np.mean(track.speed**2)))
    if column == "v_mps" and difference < hidden:
        return ""
    correlation = _correlation(recorded, expected)
    if abs(correlation) >= MAX_CORRELATION:
        return ""
    return (
        f"it differs from the derivative of the track by {difference:.3g} m/s rms, where that is "
        f"{size:.3g} m/s (correlation {correlation:.2f})"
    )


def unit_of_rate(g: Classification, heading: Classification) -> str | None:
    """Return the unit of a rate of turn, by the changes of the heading.

    Args:
        g: The rate of turn, taken as rad/s.
        heading: The heading with its unit.

    Returns:
        "" for radians per second, "degps" or "degpmin"; None if the rate does not follow the
        heading closely enough to show it.
    """
    t, rate = values_in_si(replace(g, word=""))
    at, psi = values_in_si(heading)
    if len(t) < MIN_WINDOWS or len(at) < MIN_WINDOWS:
        return None
    begin, end = max(t[0], at[0]), min(t[-1], at[-1])
    rows = np.arange(begin, end - WINDOW, max(0.5 * WINDOW, (end - begin) / MAX_WINDOWS))
    if len(rows) < MIN_WINDOWS:
        return None
    integral = np.append(0.0, np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t)))
    by_rate = np.interp(rows + WINDOW, t, integral) - np.interp(rows, t, integral)
    psi = np.unwrap(psi)
    turned = np.interp(rows + WINDOW, at, psi) - np.interp(rows, at, psi)
    size = float(np.linalg.norm(by_rate) * np.linalg.norm(turned))
    if size == 0.0 or abs(float(by_rate @ turned)) < MIN_RATE_CORRELATION * size:
        return None
    ratio = float(np.linalg.norm(by_rate) / np.linalg.norm(turned))
    units = ("", "degps", "degpmin")
    factors = np.array([1.0, UNITS["degps"], UNITS["degpmin"]])
    return units[int(np.argmin(np.abs(np.log(ratio * factors))))]


def reason_poses_unusable(
    log: Log, best: Mapping[str, Sequence[Classification]], needs_heading: bool
) -> str:
    """Return why a log has no poses that can be used, "" if it may have.

    Args:
        log: The log.
        best: Column -> classified signals, the most probable first.
        needs_heading: Whether the vessel turns.
    """
    reasons = []
    fixes = _constant_signals(log, (*LATITUDES, *LONGITUDES))
    moving = [*best.get("latitude", ()), *best.get("x_m", ()), *best.get("u_mps", ())]
    if fixes and all(float(np.ptp(values_in_si(g)[1])) == 0.0 for g in moving):
        reasons.append(f"no position: {_constant_words(fixes)}")
    headings = best.get("psi_rad", ())
    track = track_of(best)
    if needs_heading and headings and (track is None or track.moves):
        if all(_is_unmeasured(g, track) for g in headings):
            named = {g.name: g.signal for g in headings[:2]}
            reasons.append(f"no heading: {_constant_words(named)}")
    if not reasons:
        return ""
    return f"no usable poses ({'; '.join(reasons)}); it cannot become a recording"


def _is_unmeasured(g: Classification, track: Track | None) -> bool:
    if float(np.ptp(values_in_si(g)[1])) > 0.0:
        return False
    return track is None or reason_not_measured("psi_rad", g, track, None) != ""


def _constant_signals(log: Log, last: Sequence[str]) -> dict[str, Signal]:
    """Signals with one of these last words that are constant."""
    found = {}
    for name, signal in log.signals.items():
        words = tokenize_name(name)
        values = signal.values[np.isfinite(signal.values)]
        is_place = bool(words) and words[-1] in last and not NOT_MEASURED & set(words)
        if is_place and len(values) and np.ptp(values) == 0.0:
            found[name] = signal
    return found


def _constant_words(signals: Mapping[str, Signal]) -> str:
    name, signal = next(iter(signals.items()))
    value = signal.values[np.isfinite(signal.values)][0]
    names = " and ".join(list(signals)[:2])
    verb = "are" if len(signals) > 1 else "is"
    return f"{names} {verb} {value:g} in all {len(signal.values)} rows"
