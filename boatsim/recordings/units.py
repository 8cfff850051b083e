"""Angles recorded in degrees, found by how they move: headings pass any number of radians, so range says nothing."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array

DEGREES = 180.0 / math.pi
# factor by which a ratio may miss what it is taken for: sensors lag, drift and are scaled
NEAR = 1.5
# [rad/s] sustained turning no vessel here reaches; 4 deg/s is a gentle turn of a small boat
FASTEST = 4.0
# [rad] 8.6 degrees: compasses and cameras are ten times better; 0.15 degrees is a good one
NOISIEST = 0.15
# [rad] hulls here stay below 57 degrees of roll; any roll worth recording passes 1 degree
STEEPEST = 1.0
FEWEST = 4  # rows that time runs through
ALIKE = 0.8  # correlation from which two series are taken to show the same motion


def in_degrees(columns: Mapping[str, Array]) -> dict[str, int]:
    """Of a table's columns (N,), `t_s` among them, those in degrees: the row of each that shows it.

    Rows at which time stands still or runs back say nothing.
    """
    forward = np.flatnonzero(
        np.append(True, columns["t_s"][1:] > np.maximum.accumulate(columns["t_s"])[:-1])
    )
    if len(forward) < FEWEST:
        return {}
    found = _in_degrees({name: values[forward] for name, values in columns.items()})
    return {name: int(forward[index]) for name, index in found.items()}


def _in_degrees(columns: Mapping[str, Array]) -> dict[str, int]:
    suspects: dict[str, int | None] = {}
    if "psi_rad" in columns:
        rows, t, psi, others = _measured(columns, "psi_rad")
        suspects["psi_rad"] = _row(rows, heading_in_degrees(t, psi, others))
    if "phi_rad" in columns:
        rows, t, phi, others = _measured(columns, "phi_rad")
        suspects["phi_rad"] = _row(rows, roll_in_degrees(t, phi, others.get("p_radps")))
    for name, angle in (("r_radps", "psi_rad"), ("p_radps", "phi_rad")):
        if name in columns:
            rows, t, rate, others = _measured(columns, name)
            suspects[name] = _row(rows, rate_in_degrees(t, rate, others.get(angle)))
    return {name: index for name, index in suspects.items() if index is not None}


def _measured(
    columns: Mapping[str, Array], name: str
) -> tuple[NDArray[np.int64], Array, Array, dict[str, Array]]:
    """The rows in which a column is measured: their numbers, times, its values, and those of what is full there."""
    rows = np.flatnonzero(np.isfinite(columns[name]))
    there = {n: v[rows] for n, v in columns.items()}
    return rows, there["t_s"], there[name], {n: v for n, v in there.items() if np.isfinite(v).all()}


def _row(rows: NDArray[np.int64], index: int | None) -> int | None:
    return None if index is None else int(rows[index])


def heading_in_degrees(t: Array, psi: Array, signals: Mapping[str, Array]) -> int | None:
    """Index of the row that shows that `psi` (N,) as written, not unwrapped, is in degrees; None if it does not.

    Recorded rates and the course made good decide by their ratio to the heading's changes; where there are none, steps,
    scatter and rates that no vessel and no compass has in radians do.
    """
    steps = np.diff(psi)
    largest = int(np.argmax(np.abs(steps))) + 1
    if abs(steps[largest - 1]) > 3.0 * math.pi:  # radians wrap by 2 pi, degrees by 360
        return largest
    if "r_radps" in signals:
        turned = _turned(t, signals["r_radps"])
        if _near(
            _ratio(turned, psi), DEGREES
        ):  # as written: fast turning in degrees can not be told from wraps
            return largest
        if _near(_ratio(turned, np.unwrap(psi)), 1.0):
            return None
    if (
        "x_m" in signals
        and "y_m" in signals
        and _follows_course(t, psi, signals["x_m"], signals["y_m"])
    ):
        return largest
    return largest if _scatter(steps) > NOISIEST or _fastest(t, psi) > FASTEST else None


def rate_in_degrees(t: Array, rate: Array, angle: Array | None) -> int | None:
    """Index of the row that shows that a rate (N,) is in degrees per second while its angle is in radians."""
    largest = int(np.argmax(np.abs(rate)))
    if angle is not None:
        ratio = _ratio(np.unwrap(angle), _turned(t, rate))
        if _near(ratio, DEGREES) or _near(ratio, 1.0):
            return largest if _near(ratio, DEGREES) else None
    return largest if np.percentile(np.abs(rate), 75) > FASTEST else None


def roll_in_degrees(t: Array, phi: Array, rate: Array | None) -> int | None:
    """Index of the steepest row if the roll (N,) passes what a hull survives in radians, or what its rate says."""
    largest = int(np.argmax(np.abs(phi)))
    against_rate = math.nan if rate is None else _ratio(_turned(t, rate), phi)
    return largest if abs(phi[largest]) > STEEPEST or _near(against_rate, DEGREES) else None


def _turned(t: Array, rate: Array) -> Array:
    """(N,) angle turned since the first row, trapezoid rule."""
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))))


def _near(ratio: float, value: float) -> bool:
    return value / NEAR < ratio < value * NEAR


def _rows_in(t: Array, seconds: float) -> int:
    return max(1, round(min(len(t) / 4, seconds / float(np.median(np.diff(t))))))


def _ratio(known: Array, asked: Array) -> float:
    """Size of the changes of `asked` over those of `known` over windows of some length; nan where not alike."""
    for parts in (64, 16, 4):  # short windows tell most, long ones average the noise
        rows = max(1, len(known) // parts)
        a, b = known[rows:] - known[:-rows], asked[rows:] - asked[:-rows]
        size = math.sqrt(float(a @ a) * float(b @ b))
        if size > 0.0 and float(a @ b) > ALIKE * size:
            return math.sqrt(float(b @ b) / float(a @ a))
    return math.nan


def _follows_course(t: Array, psi: Array, x: Array, y: Array) -> bool:
    """Whether the bow points where the boat goes if the heading is read as degrees, and does not if it is radians."""
    rows = _rows_in(t, 1.0)
    dx, dy = x[rows:] - x[:-rows], y[rows:] - y[:-rows]
    course, bow = np.arctan2(dy, dx), psi[rows // 2 : rows // 2 + len(dx)]
    degrees, radians = (
        float(np.median(np.abs(_wrapped(course - a)))) for a in (bow / DEGREES, bow)
    )
    return degrees < 0.3 and radians > 0.6 and float(np.ptp(bow)) > 0.5 * DEGREES


def _wrapped(angle: Array) -> Array:
    return np.remainder(angle + math.pi, 2.0 * math.pi) - math.pi


def _scatter(steps: Array) -> float:
    """[rad] standard deviation of one heading reading, from second differences, blind to a few outliers and wraps."""
    second = np.abs(np.diff(_wrapped(steps)))
    return 1.48 * float(np.median(second)) / math.sqrt(6.0)


def _fastest(t: Array, psi: Array) -> float:
    """[rad/s] turning that a quarter of the recording exceeds, over half a second so that noise averages out."""
    rows = _rows_in(t, 0.5)
    smooth = np.unwrap(psi)
    return float(np.percentile(np.abs(smooth[rows:] - smooth[:-rows]) / (t[rows:] - t[:-rows]), 75))
