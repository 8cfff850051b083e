"""Comparison of what the drives report with what they were ordered.

A column `actual_NAME` is the reported value of the command NAME. The comparison shows where the
drive stops or saturates, its dead time and largest rate, and whether the reports are fit to be an
input: reports may be stale, because the logger repeats an old value, or wrong for a while.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.config import ChecksConfig
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.recordings.units import DEGREES

REPORTED = "actual_"
SENSED = ("actual_", "sensed_")
TURN = 2.0 * np.pi  # [rad]


class Response(NamedTuple):
    """How a drive follows its order: dead time, then a limited rate with a first-order lag."""

    dead_time: float  # [s]
    rate: float  # [unit/s]
    lag: float  # [s]
    error: float  # rms of the report less this response
    gap: float  # rms of the report less the order


class Reports(NamedTuple):
    """Reports of a drive: the rows in which a new value arrives, and how long each is held."""

    rows: NDArray[np.int64]
    values: Array
    held: Array  # [s]


def check_drive_response(
    recording: Recording, vessel: Vessel, config: ChecksConfig
) -> list[Finding]:
    """Compare the feedback of drives with their commands: dead time, rate limit and lag.

    Args:
        recording: A prepared recording.
        vessel: The vessel, which is not used: reports are columns of the recording alone.
        config: Thresholds of the quality checks.

    Returns:
        Findings of kind "drive": "report_stale", "report_outliers", "drive_stops",
        "drive_saturates" and "drive_follows".
    """
    found = []
    for name, values in recording.signals.items():
        if name.startswith(SENSED) and np.isfinite(values).all() and np.ptp(values) > 0.0:
            found += _outliers(recording, name, config)
    for order, report in _pairs(recording):
        found += _compare(recording, order, report, config)
    return found


def _pairs(recording: Recording) -> Iterator[tuple[str, str]]:
    """Names of order and report of each drive; neither is constant or has gaps."""
    for report, values in recording.signals.items():
        order = report.removeprefix(REPORTED)
        if order == report or order not in recording.signals:
            continue
        both = (values, recording[order])
        if all(np.isfinite(v).all() and np.ptp(v) > 0.0 for v in both):
            yield order, report


def _compare(recording: Recording, order: str, report: str, config: ChecksConfig) -> list[Finding]:
    x, y = recording[order], recording[report]
    if unit_of(order) == "rad":
        y = np.unwrap(y)
        middle = 0.5 * float(y.min() + y.max())
        x = middle + (x - middle + np.pi) % TURN - np.pi
    found = []
    stale = _stale(recording, order, report, x, y, config)
    found += stale
    low, high = _stops(recording, order, x, y, config)
    found += _limit_finding(order, x, low, high, config)
    if not stale:
        held = np.clip(x, low, high)
        if unit_of(order) == "rad" and not np.isfinite([low, high]).any():
            held = np.unwrap(recording[order])
            held += TURN * np.round(np.median(y - held) / TURN)
        found += _response_finding(order, recording.t, held, y, config)
    return found


def feedback_changes(t: Array, values: Array) -> Reports:
    """Return the rows in which a drive's feedback changes, and how long each value is held.

    Args:
        t: Times (N,) [s].
        values: Reported values (N,).
    """
    rows = np.flatnonzero(np.append(True, np.diff(values) != 0.0))
    ends = np.append(t[rows[1:]], t[-1])
    return Reports(rows, values[rows], ends - t[rows])


def _outliers(recording: Recording, name: str, config: ChecksConfig) -> list[Finding]:
    """Reports beyond all that was ever ordered; without an order, far beyond the other reports."""
    reports = feedback_changes(recording.t, recording[name])
    order = name.removeprefix(REPORTED)
    has_order = order != name and order in recording.signals
    if has_order:
        if unit_of(order) == "rad":
            return []  # whole turns change nothing
        low, high = float(recording[order].min()), float(recording[order].max())
        margin = config.report_beyond_orders * (high - low)
    else:
        low, high = map(float, np.quantile(reports.values, (0.25, 0.75)))
        if high <= low:
            return []
        margin = config.report_outlier_ratio * (high - low)
    wrong = (reports.values < low - margin) | (reports.values > high + margin)
    if not wrong.any():
        return []
    values = reports.values[wrong]
    seconds = float(reports.held[wrong].sum())
    others = "the middle half"
    if has_order:
        others = "the orders"
    evidence = (
        f"{name} has {int(wrong.sum())} impossible reports, from {values.min():.4g} to "
        f"{values.max():.4g}, held for {seconds:.1f} s in all, first at "
        f"{recording.t[reports.rows[wrong]][0]:g} s; {others} lie between {low:.4g} and {high:.4g}"
    )
    return [_drive_finding("report_outliers", evidence, "leave these values out")]


def _stale(
    recording: Recording, order: str, report: str, x: Array, y: Array, config: ChecksConfig
) -> list[Finding]:
    """Reports that stay the same while the order changes, and then jump."""
    reports = feedback_changes(recording.t, y)
    if len(reports.rows) < 2:
        return []
    least = config.report_change * float(np.ptp(x))
    starts = reports.rows[:-1]
    jumps = np.abs(np.diff(reports.values)) > least
    held = _time_since_change(recording.t, x, reports.rows, least)
    stale = jumps & (held >= config.report_stale_time)
    count = int(stale.sum())
    if count < config.report_stale_count:
        return []
    total = 100.0 * float(held[stale].sum()) / float(np.ptp(recording.t))
    evidence = (
        f"{report} repeats an old value while {order} changes, and then jumps: {count} times, for "
        f"{np.median(held[stale]):.1f} s (median) and up to {held[stale].max():.1f} s, first at "
        f"{recording.t[starts[stale]][0]:g} s, {total:.0f} % of the time"
    )
    remedy = f"do not use it as the input of a diagnosis; use the order {order}"
    return [_drive_finding("report_stale", evidence, remedy)]


def _time_since_change(t: Array, x: Array, rows: NDArray[np.int64], least: float) -> Array:
    """Times (R - 1,) from the first change of the order in each interval of rows to its end [s]."""
    late = np.zeros(len(rows) - 1)
    for k, (begin, end) in enumerate(zip(rows[:-1], rows[1:], strict=True)):
        changed = np.flatnonzero(np.abs(x[begin:end] - x[begin]) > least)
        if len(changed):
            late[k] = t[end] - t[begin + changed[0]]
    return late


def _stops(
    recording: Recording, order: str, x: Array, y: Array, config: ChecksConfig
) -> tuple[float, float]:
    """Smallest and largest value at which the drive stops although more is ordered; else inf."""
    span = max(float(np.ptp(y)), 1e-12)
    margin = config.stop_margin * span
    near = config.stop_tolerance * span
    reports = feedback_changes(recording.t, y)
    # wrong reports must not hide a stop
    low, high = np.quantile(reports.values, (config.stop_quantile, 1.0 - config.stop_quantile))
    limits = [-np.inf, np.inf]
    for k, (end, sign) in enumerate(((low, -1.0), (high, 1.0))):
        beyond = sign * (x - end) > margin
        at_end = np.abs(y - end) <= near
        farther = sign * (y - end) > near
        held = at_end[beyond].mean() if beyond.any() else 0.0
        enough = beyond.mean() > config.stop_order_share and at_end.mean() > config.stop_share
        enough = enough and held > config.stop_held_share
        if enough and farther.mean() < config.stop_share:
            limits[k] = float(end)
    return limits[0], limits[1]


def _limit_finding(
    order: str, x: Array, low: float, high: float, config: ChecksConfig
) -> list[Finding]:
    ends = [end for end in (low, high) if np.isfinite(end)]
    if not ends:
        return []
    if unit_of(order) == "rad":
        words = " and ".join(f"{end * DEGREES:.0f} deg" for end in ends)
        beyond = 100.0 * float(((x < low) | (x > high)).mean())
        evidence = (
            f"the drive of {order} does not turn beyond {words}, although {beyond:.0f} % of the "
            "orders lie beyond"
        )
        return [_drive_finding("drive_stops", evidence, "the reported angle shows its direction")]
    words = " and ".join(f"{end:.4g}" for end in ends)
    evidence = f"the drive of {order} reaches {words} at most, although up to "
    evidence += f"{x.max() if np.isfinite(high) else x.min():.4g} is ordered"
    return [_drive_finding("drive_saturates", evidence, "more order does not give more thrust")]


def _response_finding(
    order: str, t: Array, x: Array, y: Array, config: ChecksConfig
) -> list[Finding]:
    response = fit_drive_response(t, x, y, config)
    span = float(np.ptp(x))
    explained = response.error < config.response_error * response.gap
    rows = response.dead_time / float(np.median(np.diff(t)))
    at_once = response.lag == 0.0 and not np.isfinite(response.rate)
    if at_once and rows < config.response_dead_rows:
        return []  # the report is written one row after the order
    if not explained or response.gap < config.response_gap * span:
        return []
    factor, unit = 1.0, unit_of(order) or "units"
    if unit == "rad":
        factor, unit = DEGREES, "deg"
    parts = [f"after a dead time of {response.dead_time:.1f} s"]
    if np.isfinite(response.rate):
        parts.append(f"at {response.rate * factor:.3g} {unit}/s at most")
    if response.lag > 0.0:
        parts.append(f"with a lag of {response.lag:.1f} s")
    share = 100.0 * (1.0 - (response.error / response.gap) ** 2)
    evidence = (
        f"the drive of {order} follows its order {', '.join(parts)}: this explains {share:.0f} % "
        "of the difference between order and report"
    )
    return [_drive_finding("drive_follows", evidence, "the report may itself be late")]


def fit_drive_response(t: Array, x: Array, y: Array, config: ChecksConfig) -> Response:
    """Return dead time, rate limit and lag with which a drive's feedback follows its command best.

    All combinations of a grid are simulated.

    Args:
        t: Times (N,) [s].
        x: Orders (N,), held until the next row.
        y: Reports (N,), in the unit of the orders.
        config: Longest dead time, and ratios of the grid.
    """
    step = float(np.median(np.diff(t)))
    count = max(1, round(config.response_longest / step))
    stride = max(1, count // config.response_dead_times)
    dead = np.arange(0, count + 1, stride)
    moving = np.abs(np.diff(y)) / np.maximum(np.diff(t), 1e-9)
    moving = moving[moving > 0.0]
    usual = float(np.quantile(moving, config.response_rate_quantile))
    rates = np.array([*(usual * np.array(config.response_rates)), np.inf])
    lags = np.array(config.response_lags)
    delays, limits, times = (grid.ravel() for grid in np.meshgrid(dead, rates, lags))
    squares = _squares_of_errors(t, x, y, (delays, limits, times))
    best = int(np.argmin(squares))
    return Response(
        float(delays[best] * step),
        float(limits[best]),
        float(times[best]),
        float(np.sqrt(squares[best])),
        float(np.sqrt(np.mean((x - y) ** 2))),
    )


def _squares_of_errors(t: Array, x: Array, y: Array, grid: tuple[Array, Array, Array]) -> Array:
    """Mean squares (G,) of the report less the response, for each point of a grid."""
    delays, rates, lags = grid
    state = np.full(len(delays), y[0])
    total = np.zeros(len(delays))
    steps = np.diff(t)
    for i in range(len(steps)):
        total += (state - y[i]) ** 2
        gap = x[np.maximum(i - delays, 0)] - state
        share = np.where(lags > 0.0, 1.0 - np.exp(-steps[i] / np.maximum(lags, 1e-9)), 1.0)
        state = state + np.clip(gap * share, -rates * steps[i], rates * steps[i])
    return total / len(steps)


def _drive_finding(name: str, evidence: str, remedy: str) -> Finding:
    return Finding(name, evidence, "drive", remedy=remedy)
