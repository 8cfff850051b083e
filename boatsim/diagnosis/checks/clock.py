"""A clock that stands still, goes back, or leaps ahead while the boat does not move on."""

import numpy as np

from boatsim.diagnosis.checks.finding import Finding
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

LEAPS = 20.0  # usual steps, and times of the boat, that pass at once
NO_FARTHER = 3.0  # usual steps of the boat, which it has moved meanwhile
WOULD = 10.0  # times as far as it would have moved
SHOWN = 5  # places that are named


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Rows whose time is not later than that of the row before, and leaps of time that the boat knows nothing of."""
    steps = np.diff(recording.t)
    found = []
    for name, rows, words in (
        ("clock_stalls", np.flatnonzero(steps == 0.0) + 1, "rows have the time of the row before"),
        (
            "clock_goes_back",
            np.flatnonzero(steps < 0.0) + 1,
            "rows have an earlier time than the row before",
        ),
    ):
        if len(rows):
            places = ", ".join(str(r + 1) for r in rows[:SHOWN].tolist())
            spans = tuple((float(recording.t[r]), float(recording.t[r])) for r in rows[:SHOWN])
            remedy = "write the time with all its digits, or leave those rows out"
            evidence = f"{len(rows)} of {len(recording)} {words} (rows {places}, counted without the header)"
            found.append(Finding(name, evidence, spans=spans, remedy=remedy))
    if not found and len(leaps := _leaps(recording, steps, froude_time(vessel))):
        parts = np.split(recording.t, leaps + 1)
        longest = max(parts, key=lambda t: float(np.ptp(t)) if len(t) else 0.0)
        at = ", ".join(f"{recording.t[k]:g} s by {steps[k]:.4g} s" for k in leaps[:SHOWN])
        evidence = f"the time leaps ahead at {at}, while the boat stays where it is"
        spans = tuple((float(recording.t[k]), float(recording.t[k + 1])) for k in leaps[:SHOWN])
        use = (float(longest[0]), float(longest[-1]))
        found.append(Finding("clock_leaps", evidence, sure=0.95, spans=spans, use=use))
    return found


def _leaps(
    recording: Recording, steps: Array, usual_time: float
) -> "np.ndarray[tuple[int], np.dtype[np.int64]]":
    """Rows before which the clock leapt: it stood for far more than the boat sailed."""
    none = np.zeros(0, dtype=np.int64)
    if (
        not {"x_m", "y_m"} <= recording.signals.keys()
        or not (usual := float(np.median(steps))) > 0.0
    ):
        return none
    moved = np.hypot(np.diff(recording["x_m"]), np.diff(recording["y_m"]))
    known = moved[np.isfinite(moved)]
    if not len(known):
        return none
    step = float(np.quantile(known, 0.75))
    long = steps > LEAPS * max(usual, usual_time / LEAPS)
    near = moved < NO_FARTHER * step
    speed = np.convolve(
        np.nan_to_num(moved / np.maximum(steps, usual)), np.ones(9) / 9.0, "same"
    )  # about each row
    return np.flatnonzero(long & near & (speed * steps > WOULD * step))
