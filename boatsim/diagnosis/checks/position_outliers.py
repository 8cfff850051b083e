"""Fixes that leap away and come back, one or several in a row: no boat moves so, and no force is to be sought for it.

The filter lets a single outlier pass with little weight; of several in a row it believes that it has lost the boat.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.priors import FINEST, froude_time, sensed_noise
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

# [s] of fixes that are away, on a boat of 1.2 m: longer ones may be where the boat is
LONGEST = 1.5
SURE = 10.0  # sds of a step's prediction error by which a fix leaps,
QUICK = 1.5  # and usual accelerations that the boat may have had meanwhile
BEFORE = 6  # fixes from which the speed is told,
SLACK = 0.1  # of a leap by which that speed may mislead with every further step
STAYS, LOOKED = (
    4,
    200,
)  # fixes for which it must stay where it came back to; rows that are looked at
BEHIND = 8  # fixes by whose course one is judged with which a recording begins,
ASTRAY, FEW = 6.0, 3  # sds by which it is off; such rows at most
NOTHING = np.zeros(0)
# share of the prediction errors that are no leaps; of a normal variable it lies within two sds
MOST = 0.95


def without_outliers(recording: Recording, vessel: Vessel) -> Recording:
    """The recording without fixes and headings that leap away and come back (nan); a remark says how many.

    It begins where they lie on the course of those behind.
    """
    if late := begins_astray(recording, vessel):
        kept = recording.between(float(recording.t[late]), float(recording.t[-1]))
        where, begin = recording.path or recording.name, recording.t[late]
        remark = f"{where}: what lies before t = {begin:g} s is off the course behind it: not used"
        recording = replace(kept, remarks=(*kept.remarks, remark))
    signals, remarks = dict(recording.signals), list(recording.remarks)
    longest = LONGEST * froude_time(vessel)
    for names, unit in ((("x_m", "y_m"), vessel.length), (("psi_rad",), 1.0)):
        if any(n not in signals for n in names):
            continue
        values = np.column_stack([signals[n] for n in names])
        away = outlying(recording.t, values, FINEST * unit, longest)
        if away.any():
            remarks.append(
                f"{recording.path or recording.name}: {', '.join(names)} leap away and come back "
                f"({int(away.sum())} of {len(recording)} rows, first at {recording.t[away][0]:g} s): not used"
            )
            signals |= {n: np.where(away, np.nan, signals[n]) for n in names}
    return replace(recording, signals=signals, remarks=tuple(remarks))


def begins_astray(recording: Recording, vessel: Vessel) -> int:
    """First row from which on no fix is off the course of the `BEHIND` fixes behind it; `FEW` fixes are judged.

    A filter starts from the first fix, so it has nothing by which to doubt that one.
    """
    late = 0
    for name, family in (
        ("x_m", "position_sd_m"),
        ("y_m", "position_sd_m"),
        ("psi_rad", "heading_sd_rad"),
    ):
        column = recording.signals.get(name, NOTHING)
        there = np.flatnonzero(np.isfinite(column))[: FEW + BEHIND]
        sensed = sensed_noise(vessel, [recording], family) if len(there) > BEHIND else 0.0
        for first in range(len(there) - BEHIND):
            rows = there[first : first + BEHIND + 1]
            y, t = column[rows], recording.t[rows] - recording.t[rows[0]]
            powers = np.vander(t[1:], 3)  # of a parabola, whose last coefficient is where it began
            inverse = np.linalg.pinv(powers.T @ powers)
            course = inverse @ (powers.T @ y[1:])
            off = float(np.sqrt(np.sum((y[1:] - powers @ course) ** 2) / (BEHIND - 3)))
            if abs(y[0] - course[2]) > ASTRAY * max(sensed, off) * np.sqrt(1.0 + inverse[2, 2]):
                late = max(late, int(rows[0]) + 1)
    return late


def outlying(t: Array, values: Array, finest: float, longest: float) -> NDArray[np.bool_]:
    """Rows of values (N, C) that are away from where the rows before lead to, if it comes back there soon.

    `finest` is the least sd of a prediction over one step; they are away for less than `longest` s.
    """
    there = np.flatnonzero(np.isfinite(values).all(axis=1))
    away = np.zeros(len(t), dtype=np.bool_)
    if len(there) <= 2 * BEFORE:
        return away
    t, y, step = t[there], values[there], float(np.median(np.diff(t)))
    if len(t) <= 2 * longest / step:
        return away
    expected = y[1:-1] + (y[1:-1] - y[:-2]) * ((t[2:] - t[1:-1]) / (t[1:-1] - t[:-2]))[:, None]
    leap = SURE * max(0.5 * float(np.quantile(np.abs(y[2:] - expected).max(axis=1), MOST)), finest)
    wide = max(1, round(0.5 * longest / step))
    bent = np.abs(y[2 * wide :] - 2.0 * y[wide:-wide] + y[: -2 * wide]).max(axis=1)
    quick = QUICK * float(np.median(bent)) / (wide * step) ** 2
    k = BEFORE
    while k < len(t):
        since = t[k - BEFORE : k] - t[k - BEFORE : k].mean()
        middle, speed = y[k - BEFORE : k].mean(axis=0), since @ y[k - BEFORE : k] / (since @ since)
        gap = t[k : k + LOOKED] - t[k - 1]
        off = y[k : k + LOOKED] - middle - speed * (gap + since[-1])[:, None]
        fits = np.abs(off).max(axis=1) < leap * (1.0 + SLACK * (gap / step - 1.0)) + quick * gap**2
        back = int(np.argmax(fits))
        was, left = (np.abs(off[i]).max() for i in (back - 1, back))
        leaps_back = back and gap[back] < longest and was - left > max(leap, 0.5 * was)
        if leaps_back and fits[back : back + STAYS].all():
            away[there[k : k + back]] = True
            share = (gap[:back] / gap[back])[:, None]
            y[k : k + back] = (1.0 - share) * y[k - 1] + share * y[k + back]
            k += back
        k += 1
    return away
