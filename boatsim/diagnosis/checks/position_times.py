"""Positions whose rows have the times at which a program read them, not those of measurement.

A vessel under way then seems to move in jerks, which would have to be forces. Where the track shows
the rhythm of the sensor, the positions are moved along the track to the times of their rows.
"""

from dataclasses import replace

import numpy as np

from boatsim.recordings.importing.regular_times import regular_times, values_at_rows
from boatsim.recordings.table import Recording

PLACE = ("x_m", "y_m")
# phrase in the remark, by which the finding recognizes it
LATE_BY_ROWS = "were measured in a steady rhythm, but logged late"


def correct_position_times(recording: Recording) -> Recording:
    """Return a recording whose positions are those at the times of its rows.

    Args:
        recording: A prepared recording.

    Returns:
        The recording; a remark states the rhythm and the sizes of the shifts. The same recording if
        the positions show no rhythm, or agree with it already.
    """
    if not set(PLACE) <= recording.signals.keys():
        return recording
    places = np.column_stack([recording.signals[name] for name in PLACE])
    known = np.flatnonzero(np.isfinite(places).all(axis=1))
    fresh = np.append(True, np.any(np.diff(places[known], axis=0) != 0.0, axis=1))[: len(known)]
    measured = np.zeros(len(places), dtype=np.bool_)
    measured[known[fresh]] = True
    t, track = recording.t[measured], places[measured] @ np.array([1.0, 1.0j])
    found = regular_times(t, track)
    if found is None:
        return recording
    regular, period = found
    moved = np.full(places.shape, np.nan)
    for i in range(len(PLACE)):
        moved[measured, i] = values_at_rows(t, regular, places[measured, i])
    shift = float(np.sqrt(np.mean((regular - t) ** 2)))
    remark = (
        f"{recording.origin}: x_m, y_m {LATE_BY_ROWS}: every {period:.4g} s by the "
        f"track, the rows deviate by {shift:.2g} s rms; the positions are moved along the track to "
        "the times of their rows"
    )
    signals = dict(recording.signals) | {name: moved[:, i] for i, name in enumerate(PLACE)}
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))
