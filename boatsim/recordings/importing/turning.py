"""Correlation of outputs with the motion in a log: turning follows a helm.

The sign of the correlation shows to which side a positive helm turns the vessel.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.expression import parse
from boatsim.recordings.importing.motion_names import has_opposite_sense
from boatsim.recordings.importing.queued_messages import late_samples, queued_positions
from boatsim.recordings.importing.signal_classification import Classification
from boatsim.recordings.importing.track import positions_of
from boatsim.recordings.interpolated_wraps import interpolated_wrap_rows

TIME_DIGITS = 6  # decimals of a time [s]; two samples in one microsecond are one
MIN_CORRELATION = 0.3  # with the turning, of a signal that steers
# By which the score of the helm (correlation with turning less that with speed) must exceed all
# others
MIN_LEAD = 0.2
DELAYS = (0.0, 0.3, 0.6, 1.0, 1.5, 2.5, 4.0)  # [s] between helm and turning of small boats
SPEED_WINDOW = 1.0  # [s] over which a speed is computed
MAX_DURATION = 400.0  # [s] of rows that are compared
RATE = 10.0  # [Hz] of these rows


class Turning:
    """Turning to starboard and speed over ground in a log."""

    def __init__(self, best: Mapping[str, Sequence[Classification]], enu: bool) -> None:
        """Compute turning and speed.

        Args:
            best: Column -> classified signals, the most probable first.
            enu: Whether rates and yaws are positive to port, as in ROS.
        """
        self.t, self.r = np.empty(0), np.empty(0)
        self.at, self.speed = _speed(best)
        places = positions_of(best)
        queues = [] if places is None else list(queued_positions(*places))
        # Orders that had queued are followed until the longest delay after the last of them
        self.unknown = [(queue.last, queue.end + DELAYS[-1]) for queue in queues]
        for column in ("r_radps", "psi_rad"):
            if found := best.get(column):
                g = found[0]
                t, values = _sorted_samples(g)
                for queue in queues:
                    on_time = ~late_samples(t, values, queue)
                    t, values = t[on_time], values[on_time]
                if column == "psi_rad" and len(t) > 2:
                    t, values = _rates_of_turn(t, values, _full_turn(g))
                is_compass = column == "psi_rad" and "yaw" not in g.tokens
                is_to_port = enu and not is_compass
                if is_to_port or not enu and has_opposite_sense(column, g.tokens):
                    values = -values
                self.t, self.r = t, values
                return

    def correlation(self, *signals: tuple[Classification, float]) -> float:
        """Return the correlation of a weighted sum of signals with the turning, at the best delay.

        1: all turning to starboard follows it; 0 where there is no data.
        """
        return _best_delayed_correlation(signals, self.t, self.r, self.unknown)

    def steering_signal(
        self, signals: Sequence[Classification]
    ) -> tuple[Classification, float] | None:
        """Return the signal that steers, with its correlation; None where several are possible."""
        turns = [(g, self.correlation((g, 1.0))) for g in signals]
        scores = [
            abs(c) - abs(_best_delayed_correlation(((g, 1.0),), self.at, self.speed, self.unknown))
            for g, c in turns
        ]
        order = np.argsort(scores)[::-1]
        if not len(order) or abs(turns[order[0]][1]) < MIN_CORRELATION:
            return None
        rivals = len(order) > 1 and scores[order[0]] < scores[order[1]] + MIN_LEAD
        if rivals:
            return None
        return turns[int(order[0])]


def _full_turn(g: Classification) -> float:
    """A full turn in the unit of a heading."""
    if g.word:
        return 2.0 * np.pi / float(parse(f"x * {g.word}", ()).convert(np.ones(1))[0])
    return 2.0 * np.pi


def _rates_of_turn(t: Array, heading: Array, turn: float) -> tuple[Array, Array]:
    """Times and rates of turn by headings, without those interpolated across a full turn."""
    measured = ~interpolated_wrap_rows(heading, turn)
    if measured.sum() > 2:
        t, heading = t[measured], heading[measured]
    return t, np.asarray(np.gradient(np.unwrap(heading, period=turn), t))


def _sorted_samples(g: Classification) -> tuple[Array, Array]:
    """Times and values of a signal, sorted and one per time."""
    finite = np.isfinite(g.signal.values) & np.isfinite(g.signal.t)
    t, order = np.unique(np.round(g.signal.t[finite], TIME_DIGITS), return_index=True)
    return t, g.signal.values[finite][order]


def _speed(best: Mapping[str, Sequence[Classification]]) -> tuple[Array, Array]:
    """Times [s] and speeds over ground, in an arbitrary unit."""
    pair = _most_probable_pair(best, "x_m", "y_m")
    is_earth = not pair
    if is_earth:
        pair = _most_probable_pair(best, "latitude", "longitude")
    if not pair or len(pair[0].signal.t) != len(pair[1].signal.t):
        return np.empty(0), np.empty(0)
    north, east, t = pair[0].signal.values, pair[1].signal.values, pair[0].signal.t
    there = np.isfinite(north) & np.isfinite(east) & np.isfinite(t)
    t, rows = np.unique(np.round(t[there], TIME_DIGITS), return_index=True)
    if len(t) < 3:
        return np.empty(0), np.empty(0)
    wide = 1.0
    if is_earth:
        degrees = 1.0
        if "1e-7" in pair[0].word:
            degrees = 1e-7
        wide = float(np.cos(np.radians(degrees * np.median(north[there]))))
    z = north[there][rows] + 1j * wide * east[there][rows]
    after = np.searchsorted(t, t + SPEED_WINDOW).clip(max=len(t) - 1)
    return t, np.asarray(np.abs(z[after] - z) / np.maximum(t[after] - t, 1e-9))


def _most_probable_pair(
    best: Mapping[str, Sequence[Classification]], first: str, second: str
) -> list[Classification]:
    """The most probable signals of two columns; [] if one has none."""
    if best.get(first) and best.get(second):
        return [best[first][0], best[second][0]]
    return []


def _best_delayed_correlation(
    signals: Sequence[tuple[Classification, float]],
    t: Array,
    values: Array,
    unknown: Sequence[tuple[float, float]],
) -> float:
    """Correlation of a weighted sum of signals with a signal that follows, at the best delay.

    0 without data. Times between begin and end of an interval of `unknown` [s] are left out.
    """
    if len(t) < 2 or any(len(g.signal.t) < 2 for g, _ in signals):
        return 0.0
    begin = float(t[0])
    for g, _ in signals:
        begin = max(begin, float(np.nanmin(g.signal.t)))
    begin += DELAYS[-1]
    rows = np.arange(begin, min(float(t[-1]), begin + MAX_DURATION), 1.0 / RATE)
    for first, last in unknown:
        rows = rows[(rows <= first) | (rows >= last)]
    if len(rows) < 10:
        return 0.0
    followed = np.interp(rows, t, values)
    correlations = []
    for delay in DELAYS:
        weighted = [
            weight * held_values(*_sorted_samples(g), rows - delay) for g, weight in signals
        ]
        correlations.append(_correlation(np.asarray(np.sum(weighted, axis=0)), followed))
    return max(correlations, key=abs)


def held_values(t: Array, values: Array, rows: Array) -> Array:
    """Return the values in force at given times, those of the last sample before.

    Args:
        t: Times (N,) of the samples [s], increasing.
        values: Samples (N,).
        rows: Times (M,) [s].
    """
    return np.asarray(values[np.searchsorted(t, rows, side="right").clip(min=1) - 1])


def _correlation(a: Array, b: Array) -> float:
    """Correlation; 0 for a constant signal."""
    a, b = a - np.mean(a), b - np.mean(b)
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    if size > 0.0:
        return float(a @ b) / size
    return 0.0
