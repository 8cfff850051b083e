"""Positions that were bridged over gaps: rows on a straight line with equal steps, as no instrument gives them."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import Finding
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

POSE = ("x_m", "y_m", "psi_rad")
# of the last digit, by which the difference of two equal steps is off when three places are rounded
ROUNDED = 2.1
TURNS = -0.5  # of white noise, fourth differences are alike by -0.8 from row to row
LEAST = 5.0  # digits, by which fourth differences are more than those of rounding, 1.6
CHANCE = 1e-4  # of one such run among all rows, at most
BESIDE, RARE = 30, 1e-3  # rows on either side, by whose equal steps a run must be a rare one
FEWEST = 2  # rows in a run
SHOWN = 5  # places that are named


def look(recording: Recording, _: Vessel) -> list[Finding]:
    """Runs of rows between which nothing changes but by equal steps, where noise elsewhere forbids it."""
    straight = bridged(recording)
    if not straight.any():
        return []
    begins, ends = _runs(straight)
    t = recording.t
    order = np.argsort(t[ends] - t[begins])[::-1][:SHOWN]
    spans = tuple((float(t[begins[k]]), float(t[ends[k]])) for k in sorted(order.tolist()))
    evidence = (
        f"{int(straight.sum())} of {len(recording)} rows in {len(begins)} places lie on straight lines with equal "
        f"steps, to the last digit (longest {float((t[ends] - t[begins]).max()):.3g} s)"
    )
    remedy = (
        "leave x_m, y_m and psi_rad empty in those rows: what was not measured is no measurement"
    )
    return [Finding("bridged", evidence, sure=0.95, spans=spans, remedy=remedy)]


def bridged(recording: Recording) -> NDArray[np.bool_]:
    """Rows (N,) that lie on such lines."""
    n = len(recording)
    none = np.zeros(n, dtype=np.bool_)
    columns = [recording[c] for c in POSE if c in recording.signals]
    if n < 30 or len(columns) < 2 or not all(np.isfinite(c).all() for c in columns):
        return none
    exact, chance, used = np.ones(n - 2, dtype=np.bool_), 1.0, 0
    for values in columns:
        bent, digit = np.abs(np.diff(values, 2)), _digit(values)
        equal = bent < ROUNDED * digit
        if not _noisy(np.diff(values, 4), digit):
            continue  # a smooth course has equal steps of its own
        used += 1
        exact &= equal
        chance *= max(float(equal.mean()), 1.0 / n)
    if used < 2:
        return none
    moving = np.any([np.diff(c)[1:] != 0.0 for c in columns], axis=0)
    exact &= moving  # what stands still is repeated, not bridged
    straight = np.concatenate(([False], exact, [False]))
    begins, ends = _runs(straight)
    for begin, end in zip(begins, ends, strict=True):
        rows = int(end - begin) + 1
        beside = np.concatenate(
            (straight[max(begin - BESIDE, 0) : begin], straight[end + 1 : end + 1 + BESIDE])
        )
        if rows < FEWEST or n * chance**rows > CHANCE or _share(beside) ** rows > RARE:
            none[begin : end + 1] = True
    return straight & ~none


def _share(rows: NDArray[np.bool_]) -> float:
    """Of rows that are true, counted as if half a one were seen besides: how likely a further one is."""
    return (float(rows.sum()) + 0.5) / (len(rows) + 1.0)


def _noisy(bent: Array, digit: float) -> bool:
    """Whether fourth differences (N,) are those of noise, which turn round from row to row, and not of rounding."""
    ends = np.quantile(bent, [0.05, 0.95])
    inside = np.clip(bent, *ends)
    size = float(inside @ inside)
    turns = size > 0.0 and float(inside[1:] @ inside[:-1]) < TURNS * size
    return turns and float(np.median(np.abs(bent))) > LEAST * digit


def _digit(values: Array) -> float:
    """The last digit to which values (N,) are written: most of their steps are multiples of it."""
    for places in range(1, 8):
        unit = 10.0**-places
        if np.abs(values / unit - np.round(values / unit)).max() < 1e-3:
            return unit
    return 1e-8


def _runs(rows: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last rows of the runs of true rows."""
    edges = np.diff(np.concatenate(([0], rows.astype(np.int64), [0])))
    return np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
