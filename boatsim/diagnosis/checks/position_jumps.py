"""Leaps of the position or heading that stay: in one row, far faster than the ship moves, and it does not come back."""

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.checks.finding import Finding
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

FASTER = 3.0  # times the quickest hundredth of all steps
SURE = 20.0  # usual sizes of what the course before and behind a row differ by, there
BESIDE = 5  # rows on either side whose course is laid through
STAYS = 0.5  # of the leap, at least, that is left behind it
SHOWN = 5  # places that are named


def look(recording: Recording, _: Vessel) -> list[Finding]:
    """Leaps of the place and of the heading; the part to use is the longest between two of them."""
    found = []
    for name, columns, unit in (
        ("position_leaps", ("x_m", "y_m"), "m"),
        ("heading_leaps", ("psi_rad",), "rad"),
    ):
        if not all(c in recording.signals for c in columns):
            continue
        values = np.column_stack([recording[c] for c in columns])
        there = np.flatnonzero(np.isfinite(values).all(axis=1))
        t, rows = recording.t[there], leaps(recording.t[there], values[there])
        if not len(rows):
            continue
        parts = np.split(t, rows + 1)
        longest = max(parts, key=lambda part: float(np.ptp(part)))
        sizes = np.linalg.norm(values[there][rows + 1] - values[there][rows], axis=1)
        places = ", ".join(
            f"{s:.3g} {unit} at {t[k + 1]:g} s" for k, s in zip(rows[:SHOWN], sizes, strict=False)
        )
        spans = tuple((float(t[k]), float(t[k + 1])) for k in rows[:SHOWN])
        evidence = f"{', '.join(columns)} leap and stay there: {places}"
        use = (float(longest[0]), float(longest[-1]))
        found.append(Finding(name, evidence, sure=0.95, spans=spans, use=use))
    return found


def leaps(t: Array, values: Array) -> NDArray[np.int64]:
    """Rows of values (N, C) behind which they leap and stay: by more than the steps and the courses around allow."""
    n = len(t)
    if n < 8 * BESIDE:
        return np.zeros(0, dtype=np.int64)
    step = np.diff(values, axis=0)
    per_row = np.maximum(np.diff(t) / float(np.median(np.diff(t))), 1.0)[:, None]
    size = np.linalg.norm(step / per_row, axis=1)
    suspects = np.flatnonzero(size > FASTER * float(np.quantile(size, 0.99)))
    if not len(suspects) or len(suspects) > n // 50 + 3:
        return np.zeros(0, dtype=np.int64)
    usual = float(
        np.median([_gap(t, values, k) for k in range(BESIDE, n - BESIDE - 1, max(1, n // 200))])
    )
    found = [
        k
        for k in suspects.tolist()
        if BESIDE <= k < n - BESIDE - 1
        and (gap := _gap(t, values, k)) > SURE * usual
        and gap > STAYS * float(np.linalg.norm(step[k]))
    ]
    return np.array(found, dtype=np.int64)


def _gap(t: Array, values: Array, k: int) -> float:
    """How far apart the courses before and behind row k are half-way to the next."""
    middle, ends = 0.5 * (t[k] + t[k + 1]), []
    for rows in (slice(k - BESIDE + 1, k + 1), slice(k + 1, k + 1 + BESIDE)):
        since = t[rows] - t[rows].mean()
        speed = since @ (values[rows] - values[rows].mean(axis=0)) / float(since @ since)
        ends.append(
            np.median(values[rows] - since[:, None] * speed, axis=0)
            + speed * (middle - t[rows].mean())
        )
    return float(np.linalg.norm(ends[1] - ends[0]))
