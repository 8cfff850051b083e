"""Messages that queued while a program did not read them: poses that are older than their rows.

A link or a program stalls, and nothing is logged. Then the queued messages are read one after
another, faster than they were sent: the recorded vessel stands still over the gap, and afterwards
moves faster than before and after, until the queue is empty. The number of messages shows a queue
as well: a sensor of regular rate cannot have sent more since the gap than fit into the time. This
also tells a queue with which a log begins, before which no speed is known.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array

LONG_GAP = 5.0  # median intervals of fixes: a stall, not a lost message
# A program that reads in bursts stalls all the time; then the rhythm of the sensor shows the times
RARE, RARE_GAP = 95.0, 2.0  # percentile of the intervals, and how many times as long a stall is
LEAST_GAP = 0.5  # [s] a shorter stall is a late message
SMOOTH = 0.4  # [s] between fixes whose distances are summed: noise would lengthen the path
USUAL = 4.0  # [s] before the gap and after the queue, of the speed of the vessel
# Least ratio of the speed while the queue is read to those before and after. A vessel that
# accelerates after a gap does not reach it at once and slow down as suddenly.
FASTER = 1.5
STOOD = 0.5  # of the distance at the usual speed, that the fixes may move over the gap
# Share of the path at the usual speed since the gap began, from which on the queue is empty as soon
# as the speed is usual again: noise of the speeds hides the rest
NEARLY = 0.9
QUIET = 0.5  # of the gap without a new value: the signal stalled with the positions
LONGEST_QUEUE = 3.0  # of the gap: a queue that is read at less than 1.3 times its rate is not told
LEAST_PATH = 0.5  # [m] that must be missing over the gap
# Messages over which the period of the sensor is averaged: the jitter of a program that polls,
# about a period, is then 5 % of the sum
PERIODS = 20
LEAST_QUEUE = 2.0  # messages: a program that polls reads one up to a period late
BURST_INTERVAL = 0.2  # of the usual interval: messages that were read at once
BURST_TOLERANCE = 0.1  # share by which their number may differ from the missing one


class Queue(NamedTuple):
    """Interval in which queued positions were read.

    Attributes:
        last: Time of the last fix before the gap, or of the beginning of the log [s].
        begin: Time of the first fix after the gap [s].
        end: Time of the first fix that is on time again [s].
        late: Age of the first fix after the gap, by the number of messages [s]; nan if unknown.
    """

    last: float
    begin: float
    end: float
    late: float = float("nan")

    @property
    def evidence(self) -> str:
        """Clause of a remark that states the sign of the queue."""
        if np.isfinite(self.late):
            return (
                "messages then follow faster than the sensor sends them, and the first one is "
                f"{self.late:.2g} s old"
            )
        return "the vessel stands still over the gap and then moves too fast"


def queued_positions(t: Array, x: Array, y: Array) -> Iterator[Queue]:
    """Yield the intervals in which queued positions were read.

    The time before the first fix counts as a gap too: a program that waits for its first messages
    may find them queued.

    Args:
        t: Times of the rows (N,) [s], those without a fix among them.
        x: Positions north (N,) [m]; nan where unknown.
        y: Positions east (N,) [m]; nan where unknown.
    """
    known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    if len(known) < 2:
        return
    changed = np.concatenate([[True], (np.diff(x[known]) != 0.0) | (np.diff(y[known]) != 0.0)])
    rows = known[changed]
    times, points = t[rows], np.column_stack([x[rows], y[rows]])
    intervals = np.diff(times)
    if len(intervals) < 2:
        return
    usual, rare = np.percentile(intervals, [50.0, RARE])
    longest = max(LONG_GAP * usual, RARE_GAP * rare, LEAST_GAP)
    period = _period(times)
    since = np.append(t[0], times[:-1])  # the last fix before each one, or the beginning
    on_time = -np.inf
    for i in map(int, np.flatnonzero(times - since > longest)):
        if since[i] < on_time:
            continue
        end, late = None, float("nan")
        if i > 0:
            end = _end_of_burst(times, i - 1, float(usual))
            if end is None:
                end = _end_of_queue(times, points, i - 1)
        if end is None:
            end = _end_by_count(times, i, float(times[i] - since[i]), period)
            if end is not None:
                late = _age(times, i, end, period)
        if end is not None:
            on_time = times[end]
            yield Queue(float(since[i]), float(times[i]), float(on_time), late)


def late_samples(t: Array, values: Array, queue: Queue) -> NDArray[np.bool_]:
    """Return which samples of another signal (N,) had queued with the positions.

    These are all before the end of the queue from the gap on, if the signal stalled as well: it has
    no new value in most of the gap, while a sensor with a link of its own has.

    Args:
        t: Times of the samples (N,) [s].
        values: Samples (N,); nan where none is known.
        queue: Interval in which queued positions were read.
    """
    known = np.flatnonzero(np.isfinite(values) & (t < queue.begin))
    if not len(known):
        return np.asarray((t > queue.last) & (t < queue.end))
    new = np.append(True, np.diff(values[known]) != 0.0)
    newest = float(t[known[new]][-1])
    if queue.begin - newest < QUIET * (queue.begin - queue.last):
        return np.zeros(len(t), dtype=np.bool_)
    return np.asarray((t > max(newest, queue.last)) & (t < queue.end))


def _period(t: Array) -> float:
    """Period [s] of the sensor, the median over many messages; nan if there are too few.

    Stalls and queues change the mean of a log, but not that of most of its parts.
    """
    if len(t) <= 2 * PERIODS:
        return float("nan")
    return float(np.median(t[PERIODS:] - t[:-PERIODS])) / PERIODS


def _age(t: Array, i: int, end: int, period: float) -> float:
    """Age [s] of fix i if fix `end` is on time and the sensor sends one in each period."""
    return float((end - i) * period - (t[end] - t[i]))


def _end_by_count(t: Array, i: int, gap: float, period: float) -> int | None:
    """Number of the fix at which a queue is empty whose first message is fix i; None without one.

    While the queue is read, messages follow faster than their sensor sends them. None can be older
    than the gap. A sensor that has become faster for good goes on so, and shows no end.

    Args:
        t: Times of new fixes (N,) [s].
        i: Number of the first fix after the gap.
        gap: Time before it without a fix [s].
        period: Period of the sensor [s]; nan if unknown.
    """
    if not np.isfinite(period):
        return None
    last, stop = np.searchsorted(t, t[i] + LONGEST_QUEUE * gap + np.array([0.0, USUAL]))
    after = t[i:stop]
    ahead = np.arange(len(after)) * period - after  # [s] grows while messages follow too fast
    for j in range(min(int(last) - i, len(after))):
        later = int(np.searchsorted(after, after[j] + USUAL, side="right"))
        if ahead[j:later].max() - ahead[j] <= period:
            is_followed = i + later < len(t)
            is_queue = LEAST_QUEUE * period <= ahead[j] - ahead[0] <= gap + period
            return i + j if is_queue and is_followed else None
    return None


def _end_of_burst(t: Array, i: int, usual: float) -> int | None:
    """Number of the fix after the messages that arrived at once after fix i; None without them.

    Two signs are needed: they follow far faster than their sensor measures, and there are as many
    as are missing over the gap.
    """
    slow = np.flatnonzero(np.diff(t[i + 1 :]) > BURST_INTERVAL * usual)
    if not len(slow):
        return None
    end = i + 2 + int(slow[0])
    missing = (t[i + 1] - t[i]) / usual
    if abs(end - 1 - i - missing) > max(1.0, BURST_TOLERANCE * missing):
        return None
    return end


def _end_of_queue(t: Array, points: Array, i: int) -> int | None:
    """Number of the fix at which a queue is empty that began after fix i; None if none queued."""
    before = _speed(t, points, t[i] - USUAL, t[i])
    gap = t[i + 1] - t[i]
    stood = float(np.hypot(*(points[i + 1] - points[i])))
    if before is None or before * gap < LEAST_PATH or stood > STOOD * before * gap:
        return None
    path, at = stood, i + 1
    for j in range(i + 2, len(t)):
        if t[j] - t[i + 1] > LONGEST_QUEUE * gap:
            return None
        if t[j] - t[at] < SMOOTH:
            continue
        path += float(np.hypot(*(points[j] - points[at])))
        at = j
        after = _speed(t, points, t[j], t[j] + USUAL)
        if after is None:
            return None
        usual, most = 0.5 * (before + after), FASTER * max(before, after)
        if path >= NEARLY * usual * (t[j] - t[i]):
            fast = (path - stood) / (t[j] - t[i + 1])
            return _first_usual(t, points, j, most) if fast >= most else None
    return None


def _first_usual(t: Array, points: Array, j: int, most: float) -> int:
    """Number of the first fix from fix j on, after which the speed is at most `most` [m/s]."""
    while True:
        later = int(np.searchsorted(t, t[j] + 2.0 * SMOOTH))  # one step may be slow
        if later >= len(t):
            return j
        if np.hypot(*(points[later] - points[j])) <= most * (t[later] - t[j]):
            return j
        j = later


def _speed(t: Array, points: Array, begin: float, end: float) -> float | None:
    """Mean speed [m/s] of the fixes of a time, along their path; None if there are too few."""
    inside = np.flatnonzero((t >= begin) & (t <= end))
    if len(inside) < 3 or t[inside[-1]] - t[inside[0]] < 0.25 * USUAL:
        return None
    kept = [int(inside[0])]
    for k in inside[1:]:
        if t[k] - t[kept[-1]] >= SMOOTH:
            kept.append(int(k))
    if len(kept) < 3:
        return None
    steps = np.diff(points[kept], axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum() / (t[kept[-1]] - t[kept[0]]))
