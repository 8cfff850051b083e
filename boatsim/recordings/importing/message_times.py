"""Common times of signals that a logger wrote one after another from one message."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.importing.coordinates import kind_of_place
from boatsim.recordings.importing.log import median_sampling_rate
from boatsim.recordings.importing.signal_words import tokenize_name

# Signals whose samples lie nearer to each other than this share of their step are of one message;
# those of a position may be in two messages
SAME_MESSAGE, SAME_POSITION = 0.1, 0.4
MAX_COMPARED = 500  # signals; of more, each keeps its own times
MIN_TOGETHER = 0.9  # share of the samples of both that have a partner
POSITIONS = ({"x", "y"}, {"north", "east"}, {"n", "e"}, {"latitude", "longitude"})


def with_shared_times(
    signals: Mapping[str, tuple[Array, Array]],
) -> dict[str, tuple[Array, Array]]:
    """Return signals, of which those of one message have the same times, so that rows pair them.

    Args:
        signals: Name -> times (N,) [s] and values (N,) of each sample.

    Returns:
        Name -> times and values; a value is nan where a signal has no sample in a message.
    """
    if len(signals) > MAX_COMPARED:
        return dict(signals)
    messages: list[list[str]] = []
    for name, (t, _) in signals.items():
        for message in messages:
            if _are_together(signals[message[0]][0], t, _largest_distance(name, message[0])):
                message.append(name)
                break
        else:
            messages.append([name])
    shared: dict[str, tuple[Array, Array]] = {}
    for message in messages:
        shared |= _on_one_clock({name: signals[name] for name in message})
    return {name: shared[name] for name in signals}


def _largest_distance(one: str, other: str) -> float:
    """Distance of the samples of one message, as a share of their step."""
    if one == other or not _are_one_position(one, other):
        return SAME_MESSAGE
    return SAME_POSITION


def _are_one_position(one: str, other: str) -> bool:
    """Whether two names differ in the axis of a position only."""
    words = [tokenize_name(name) or [""] for name in (one, other)]
    axes = {kind_of_place(one) or words[0][-1], kind_of_place(other) or words[1][-1]}
    return axes in POSITIONS and words[0][:-1] == words[1][:-1]


def _are_together(first: Array, other: Array, limit: float) -> bool:
    """Whether two signals have nearly all samples in pairs, nearer than a share of their step."""
    first, other = np.sort(first[np.isfinite(first)]), np.sort(other[np.isfinite(other)])
    rate = median_sampling_rate(first)
    if len(first) < 2 or len(other) < 2 or not rate:
        return False
    if not MIN_TOGETHER < len(first) / len(other) < 1.0 / MIN_TOGETHER:
        return False
    _, off = _nearest(first, other)
    return float(np.mean(np.abs(off) <= limit / rate)) >= MIN_TOGETHER


def _nearest(base: Array, t: Array) -> tuple[NDArray[np.intp], Array]:
    """Index (N,) of the nearest of some increasing times, and the distance (N,) from it."""
    after = np.searchsorted(base, t).clip(1, len(base) - 1)
    nearest = np.where(t - base[after - 1] < base[after] - t, after - 1, after)
    return nearest, t - base[nearest]


def _on_one_clock(signals: Mapping[str, tuple[Array, Array]]) -> dict[str, tuple[Array, Array]]:
    """Signals of one message at the times of the first one; samples without a pair keep theirs."""
    if len(signals) == 1:
        return dict(signals)
    name_of_first = next(iter(signals))
    first = signals[name_of_first][0]
    base = np.unique(first[np.isfinite(first)])
    step = 1.0 / median_sampling_rate(base)
    moved: dict[str, Array] = {}
    for name, (t, _) in signals.items():
        nearest, off = _nearest(base, t)
        limit = _largest_distance(name, name_of_first) * step
        moved[name] = np.where(np.abs(off) <= limit, base[nearest], t)
    together = np.unique(np.concatenate(list(moved.values())))
    together = together[np.isfinite(together)]
    shared = {}
    for name, (_, values) in signals.items():
        known = np.isfinite(moved[name])
        on_clock = np.full(len(together), np.nan)
        on_clock[np.searchsorted(together, moved[name][known])] = values[known]
        shared[name] = (together, on_clock)
    return shared
