"""Orders to drives that lost their sign: whether the vessel followed the sign, by her motion.

The recording has the force and the moment from which a program computed its orders; see
`boatsim.recordings.order_signs`. Surge and yaw acceleration show what the drives really did.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.importing.drive_names import effort_of_name
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
    effort_of_orders,
    laws_of_unsigned_orders,
    signed_orders,
)
from boatsim.recordings.table import Recording

# [nats] by which the accelerations must be more probable with the signs: odds of 20 to one, next
# to the law that the log shows
FOLLOWED = 3.0
AS_LOGGED = "as logged"
REMARK = "lost their sign where force and moment ask for thrust astern"
UNKNOWN = (
    "have no sign where force and moment ask for thrust astern; they are used as logged, because "
    "their laws do not fit what other recordings show"
)


def restore_order_signs(
    recordings: Sequence[Recording], vessel: Vessel, judged: int
) -> list[Recording]:
    """Return recordings whose orders have the sign of the force and moment they were computed from.

    They are changed only if the orders of all drives follow from a recorded force and moment, are
    never negative although these ask for it, and surge and yaw acceleration over several recordings
    together show that the vessel did not follow the orders as logged. They also show whether the
    drives took the sizes with the sign, exchanged them, stood still, or followed the law.

    Args:
        recordings: Prepared recordings of one vessel.
        vessel: The vessel.
        judged: Number of recordings, the first ones, whose motion is compared.

    Returns:
        The recordings, with a remark on each that is changed.
    """
    unsigned = [_unsigned(recording, vessel) for recording in recordings]
    evidence = evidence_of_signs(
        [(r, own) for r, own in zip(recordings[:judged], unsigned, strict=False) if own is not None]
    )
    if not evidence:
        return list(recordings)
    found = max(evidence, key=lambda name: evidence[name])
    gain = evidence[found] - evidence[AS_LOGGED]
    if gain < FOLLOWED:
        return list(recordings)
    restored = []
    for recording, own in zip(recordings, unsigned, strict=True):
        if own is None:
            restored.append(recording)
        elif found in own.possible:
            restored.append(_restored(recording, own, found, gain))
        else:
            remark = f"{recording.origin}: {', '.join(own.laws)} {UNKNOWN}"
            restored.append(replace(recording, remarks=(*recording.remarks, remark)))
    return restored


class UnsignedOrders(NamedTuple):
    """Orders of a recording that lost their sign.

    Attributes:
        laws: Order -> its law of force and moment.
        possible: What the drives may have done -> order -> values (N,), also as logged.
    """

    laws: Mapping[str, OrderLaw]
    possible: Mapping[str, Mapping[str, Array]]


def _unsigned(recording: Recording, vessel: Vessel) -> UnsignedOrders | None:
    """Orders of a recording that lost their sign; None if none did."""
    if recording.orders is not None or not set(vessel.commands) <= recording.signals.keys():
        return None
    efforts: dict[str, Array] = {}
    for name, values in recording.signals.items():
        kind = effort_of_name(name)
        if kind and name not in vessel.commands:
            efforts.setdefault(kind, values)
    for kind, name in EFFORT_COLUMNS.items():  # the usual names go before similar ones
        if name in recording.signals:
            efforts[kind] = recording.signals[name]
    if not EFFORT_COLUMNS.keys() <= efforts.keys():
        return None
    orders = {name: recording.signals[name] for name in vessel.commands}
    laws = laws_of_unsigned_orders(orders, efforts["effort_x"], efforts["effort_n"])
    if not laws:
        return None
    possible = {AS_LOGGED: orders, **signed_orders(orders, laws, efforts["effort_x"])}
    return UnsignedOrders(laws, possible)


def evidence_of_signs(runs: Sequence[tuple[Recording, UnsignedOrders]]) -> dict[str, float]:
    """Return how well surge and yaw acceleration follow what the drives may have done [nats].

    In each recording the surge acceleration follows from the force and the speed, and the yaw
    acceleration from the moment and the yaw rate, by least squares at the best delay.

    Args:
        runs: Recordings with their orders that lost the sign.

    Returns:
        What all drives may have done -> gain of log-likelihood over drives without effect.
    """
    total: dict[str, float] = {}
    for recording, own in runs:
        surge, yaw = _surge_motion(recording), _yaw_motion(recording)
        if not len(surge[0]):  # without it the sign of a force does not show
            continue
        for name, orders in own.possible.items():
            force, moment = effort_of_orders(orders, own.laws)
            gain = _response_evidence(force, recording.t, *surge)
            gain += _response_evidence(moment, recording.t, *yaw)
            total[name] = total.get(name, 0.0) + gain
    shared = [name for name in total if all(name in own.possible for _, own in runs)]
    return {name: total[name] for name in shared}


def _response_evidence(
    effort: Array, times: Array, t: Array, speed: Array, acceleration: Array
) -> float:
    """Gain of log-likelihood by a response to force or moment at the best delay; 0 for none."""
    most = 0.0
    for delay in DELAYS:
        rows = np.searchsorted(times, t - delay, side="right") - 1
        inside = rows >= 0
        if inside.sum() < MIN_ROWS:
            continue
        u, a = speed[inside], acceleration[inside]
        without = np.column_stack([np.ones(len(u)), u, u * np.abs(u)])
        response = np.column_stack([without, effort[rows[inside]]])
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
    if not {"x_m", "y_m", "psi_rad"} <= recording.signals.keys():
        return np.empty(0), np.empty(0), np.empty(0)
    x, y, psi = (recording.signals[name] for name in ("x_m", "y_m", "psi_rad"))
    fixed, known = np.isfinite(x) & np.isfinite(y), np.isfinite(psi)
    if fixed.sum() < MIN_ROWS or known.sum() < MIN_ROWS:
        return np.empty(0), np.empty(0), np.empty(0)
    track = track_of_positions(recording.t[fixed], x[fixed], y[fixed])
    bow = np.interp(track.t, recording.t[known], psi[known])
    return _differenced(track.t, track.north * np.cos(bow) + track.east * np.sin(bow))


def _yaw_motion(recording: Recording) -> tuple[Array, Array, Array]:
    """Times, yaw rate [rad/s] and its rate of change [rad/s^2]; empty if none was recorded."""
    rate = recording.signals.get("r_radps", np.full(len(recording.t), np.nan))
    known = np.isfinite(rate)
    if known.sum() < MIN_ROWS:
        return np.empty(0), np.empty(0), np.empty(0)
    return _differenced(recording.t[known], rate[known])


def _differenced(t: Array, speed: Array) -> tuple[Array, Array, Array]:
    """Times, values and rates of change of a speed (N,) over one window each."""
    begin, end = rows_one_window_apart(t)
    middle = 0.5 * (t[begin] + t[end])
    return (
        middle,
        0.5 * (speed[begin] + speed[end]),
        (speed[end] - speed[begin]) / (t[end] - t[begin]),
    )


# What the drives did -> words of a remark
WORDS = {
    "computed": "that the vessel followed the sign {gain}; it is restored by them",
    "signed": "that the vessel followed the sign {gain}; it is restored, and the sizes stay",
    "idle": "that the drives stood still instead {gain}; these orders are zero now",
    "exchanged": (
        "that the vessel followed the sign {gain}; it is restored, and the sides are exchanged "
        "while the force is astern, as in a program that computes orders for its size"
    ),
}


def _restored(recording: Recording, own: UnsignedOrders, found: str, gain: float) -> Recording:
    """A recording with the signs of its orders, and a remark."""
    signals, changed = dict(recording.signals), np.zeros(len(recording.t), dtype=bool)
    for name, values in own.possible[found].items():
        before = recording.signals[name]
        changed |= (values != before) & np.isfinite(before)
        signals[name] = values
    remark = (
        f"{recording.origin}: {', '.join(own.laws)} {REMARK} ({100.0 * changed.mean():.2g} % of "
        f"the rows); they follow from these elsewhere, and surge and yaw acceleration show "
        f"{WORDS[found].format(gain=f'({gain:.0f} nats over the fitted recordings)')}"
    )
    return replace(recording, signals=signals, remarks=(*recording.remarks, remark))
