"""Orders to drives that lost their sign: whether the vessel followed the sign, by her motion.

The recording has the force and the moment from which a program computed its orders; see
`boatsim.recordings.order_signs`. The surge acceleration shows what the drives really did.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.signal_classification import effort_of_name
from boatsim.recordings.importing.track import (
    WINDOW,
    rows_one_window_apart,
    track_of_positions,
)
from boatsim.recordings.importing.turning import DELAYS
from boatsim.recordings.order_signs import (
    EFFORT_COLUMNS,
    MIN_ROWS,
    OrderLaw,
    laws_of_unsigned_orders,
    rows_without_sign,
)
from boatsim.recordings.table import Recording

# [nats] by which the surge acceleration must be more probable with the signs: odds of 20 to one,
# next to the law that the log shows
FOLLOWED = 3.0
REMARK = "lost their sign where force and moment ask for thrust astern"


def restore_order_signs(
    recordings: Sequence[Recording], vessel: Vessel, judged: int
) -> list[Recording]:
    """Return recordings whose orders have the sign of the force and moment they were computed from.

    They are changed only if the orders of all drives follow from a recorded force and moment, are
    never negative although these ask for it, and the surge acceleration over several recordings
    together shows that the vessel followed the sign.

    Args:
        recordings: Prepared recordings of one vessel.
        vessel: The vessel.
        judged: Number of recordings, the first ones, whose motion is compared.

    Returns:
        The recordings, with a remark on each that is changed.
    """
    laws = [_laws(recording, vessel) for recording in recordings]
    gain = 0.0
    for recording, own in zip(recordings[:judged], laws[:judged], strict=True):
        gain += gain_of_signs(recording, own)
    if gain < FOLLOWED:
        return list(recordings)
    return [_restored(r, own, gain) for r, own in zip(recordings, laws, strict=True)]


def _laws(recording: Recording, vessel: Vessel) -> dict[str, OrderLaw]:
    """Laws of the orders of a recording that lost their sign; {} if none did."""
    if recording.orders is not None or not set(vessel.commands) <= recording.signals.keys():
        return {}
    efforts: dict[str, Array] = {}
    for name, values in recording.signals.items():
        kind = effort_of_name(name)
        if kind and name not in vessel.commands:
            efforts.setdefault(kind, values)
    for kind, name in EFFORT_COLUMNS.items():  # the usual names go before similar ones
        if name in recording.signals:
            efforts[kind] = recording.signals[name]
    if not EFFORT_COLUMNS.keys() <= efforts.keys():
        return {}
    orders = {name: recording.signals[name] for name in vessel.commands}
    return laws_of_unsigned_orders(orders, efforts["effort_x"], efforts["effort_n"])


def gain_of_signs(recording: Recording, laws: Mapping[str, OrderLaw]) -> float:
    """Return how much more probable the surge acceleration is with the signs than as logged [nats].

    Both follow from the sum of the orders and from the speed, by least squares at the best delay.

    Args:
        recording: The recording.
        laws: Order -> its law; 0 is returned for none.
    """
    if not laws or not {"x_m", "y_m", "psi_rad"} <= recording.signals.keys():
        return 0.0
    t, speed, acceleration = _surge_motion(recording)
    logged, signed = np.zeros(len(recording.t)), np.zeros(len(recording.t))
    rows = rows_without_sign(laws)
    for name, law in laws.items():
        values = recording.signals[name]
        logged += law.force(values)
        signed += law.force(law.with_sign(values, rows))
    evidence = []
    for force in (signed, logged):
        evidence.append(_response_evidence(force, recording.t, t, speed, acceleration))
    return evidence[0] - evidence[1]


def _response_evidence(
    force: Array, times: Array, t: Array, speed: Array, acceleration: Array
) -> float:
    """Gain of log-likelihood by a response to a force, at the best delay [nats]; 0 for none."""
    most = 0.0
    for delay in DELAYS:
        rows = np.searchsorted(times, t - delay, side="right") - 1
        inside = rows >= 0
        if inside.sum() < MIN_ROWS:
            continue
        u, a = speed[inside], acceleration[inside]
        without = np.column_stack([np.ones(len(u)), u, u * np.abs(u)])
        response = np.column_stack([without, force[rows[inside]]])
        size, fitted = _residual(without, a)[0], _residual(response, a)
        if fitted[1] > 0.0 and 0.0 < fitted[0] < size:
            # differences over one window are independent; times without positions do not count
            independent = len(np.unique(np.floor(t[inside] / WINDOW)))
            most = max(most, 0.5 * independent * float(np.log(size / fitted[0])))
    return most


def _residual(columns: Array, values: Array) -> tuple[float, float]:
    """Sum of squares that least squares leave, and the last coefficient."""
    found = np.linalg.lstsq(columns, values, rcond=None)[0]
    return float(np.sum((values - columns @ found) ** 2)), float(found[-1])


def _surge_motion(recording: Recording) -> tuple[Array, Array, Array]:
    """Times, surge speed over ground [m/s] and its rate of change [m/s^2]; empty if unknown."""
    x, y, psi = (recording.signals[name] for name in ("x_m", "y_m", "psi_rad"))
    fixed, known = np.isfinite(x) & np.isfinite(y), np.isfinite(psi)
    if fixed.sum() < MIN_ROWS or known.sum() < MIN_ROWS:
        return np.empty(0), np.empty(0), np.empty(0)
    track = track_of_positions(recording.t[fixed], x[fixed], y[fixed])
    bow = np.interp(track.t, recording.t[known], psi[known])
    speed = track.north * np.cos(bow) + track.east * np.sin(bow)
    begin, end = rows_one_window_apart(track.t)
    span = track.t[end] - track.t[begin]
    middle = 0.5 * (track.t[begin] + track.t[end])
    return middle, 0.5 * (speed[begin] + speed[end]), (speed[end] - speed[begin]) / span


def _restored(recording: Recording, laws: Mapping[str, OrderLaw], gain: float) -> Recording:
    """A recording with the signs of its orders, and a remark."""
    if not laws:
        return recording
    signals, changed = dict(recording.signals), np.zeros(len(recording.t), dtype=bool)
    rows = rows_without_sign(laws)
    for name, law in laws.items():
        signals[name] = law.with_sign(recording.signals[name], rows)
        changed |= signals[name] != recording.signals[name]
    remark = (
        f"{recording.origin}: {', '.join(laws)} {REMARK} ({100.0 * changed.mean():.2g} % of the "
        f"rows); they follow from these elsewhere, and the surge acceleration shows that the "
        f"vessel followed the sign ({gain:.0f} nats over the fitted recordings); it is restored"
    )
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))
