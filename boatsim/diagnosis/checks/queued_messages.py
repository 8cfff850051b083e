"""Poses of messages that had queued: they are older than their rows, and are dropped."""

from dataclasses import replace

import numpy as np

from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.importing.queued_messages import late_samples, queued_positions
from boatsim.recordings.table import Recording

QUEUED = "had queued"  # phrase in the remark, by which the finding recognizes it


def drop_queued_messages(recording: Recording) -> Recording:
    """Return a recording without the poses and rates that had queued, with a remark on each.

    Orders stay: a program writes them when it gives them.

    Args:
        recording: A prepared recording; its rows keep their times.
    """
    if not {"x_m", "y_m"} <= recording.signals.keys():
        return recording
    queues = list(queued_positions(recording.t, recording["x_m"], recording["y_m"]))
    if not queues:
        return recording
    signals, remarks = dict(recording.signals), list(recording.remarks)
    measured = [name for name in (*POSE, *RATES) if name in signals]
    for queue in queues:
        dropped = []
        for name in measured:
            late = late_samples(recording.t, recording.signals[name], queue)
            if np.isfinite(signals[name][late]).any():
                signals[name] = np.where(late, np.nan, signals[name])
                dropped.append(name)
        if not dropped:
            continue
        remarks.append(
            f"{recording.origin}: {', '.join(dropped)} from t = {queue.begin:g} s to "
            f"{queue.end:g} s {QUEUED} since {queue.last:g} s: {queue.evidence}; they are not used"
        )
    return replace(recording, signals=signals, remarks=tuple(remarks))
