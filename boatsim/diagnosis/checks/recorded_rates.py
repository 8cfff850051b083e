"""Recorded velocities that disagree with the recorded positions: another sign or unit, late, or of another point."""

import numpy as np

from boatsim.diagnosis.checks.finding import Change, Finding
from boatsim.diagnosis.priors import froude_time
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.expression import UNITS
from boatsim.recordings.table import Recording

NEEDED, RATES = ("x_m", "y_m", "psi_rad"), ("u_mps", "v_mps", "r_radps")
WINDOW = 1.0  # [s] over which positions are differenced, on a boat of 1.2 m
ALIKE = 0.9  # correlation from which both show the same motion
NEAR = 1.2  # factor by which a ratio may miss that of a unit
HALF = 0.5  # of what is left over, at most, once a lag or a lever is taken into account
SMALL = 0.02  # of the size, from which it counts what is left over
LEVER = 0.1  # of the length, from which a point is another


def look(recording: Recording, vessel: Vessel) -> list[Finding]:
    """Each recorded rate beside the one that follows from the poses."""
    if any(n not in recording.signals or not np.isfinite(recording[n]).all() for n in NEEDED):
        return []
    if (
        len(recording) < 4 * followed_rows(recording, vessel) + 30
        or not set(RATES) & recording.signals.keys()
    ):
        return []
    followed = _rates(recording, vessel)
    rows = followed.pop("rows").astype(np.int64)
    found = []
    for name, rate in followed.items():
        if name in recording.signals and np.isfinite(recording[name]).all():
            smooth = _smooth(recording[name], followed_rows(recording, vessel))[rows]
            found += _compared(recording, name, smooth, rate, followed["r_radps"], vessel)
    return found


def followed_rows(recording: Recording, vessel: Vessel) -> int:
    """Rows on either side over which positions are differenced."""
    step = float(np.median(np.diff(recording.t)))
    return max(1, round(0.5 * WINDOW * froude_time(vessel) / step))


def _rates(recording: Recording, vessel: Vessel) -> dict[str, Array]:
    """u, v, r by central differences, and the rows they are of."""
    k = followed_rows(recording, vessel)
    rows = np.arange(k, len(recording) - k)
    span = recording.t[rows + k] - recording.t[rows - k]
    dx, dy, dpsi = ((recording[n][rows + k] - recording[n][rows - k]) / span for n in NEEDED)
    psi = _smooth(recording["psi_rad"], k)[rows]
    c, s = np.cos(psi), np.sin(psi)
    return {
        "u_mps": c * dx + s * dy,
        "v_mps": c * dy - s * dx,
        "r_radps": dpsi,
        "rows": rows.astype(float),
    }


def _smooth(values: Array, k: int) -> Array:
    """Mean over k rows on either side, as a central difference takes it."""
    total = np.concatenate(([0.0], np.cumsum(values)))
    mean = values.copy()
    mean[k:-k] = (total[2 * k + 1 :] - total[: -2 * k - 1])[: len(values) - 2 * k] / (2 * k + 1)
    return mean


def _compared(
    recording: Recording, name: str, recorded: Array, rate: Array, r: Array, vessel: Vessel
) -> list[Finding]:
    if len(rate) < 30 or not recorded.std() > 0.0 or not rate.std() > 0.0:
        return []
    like = float(np.corrcoef(recorded, rate)[0, 1])
    ratio = float(np.sqrt((rate @ rate) / (recorded @ recorded)))
    if like < -ALIKE and 1.0 / 1.5 < ratio < 1.5:
        evidence = (
            f"{name} goes against what follows from x_m, y_m, psi_rad (correlation {like:.2f})"
        )
        return [Finding("velocity_sign", evidence, sure=0.99, changes=(Change(name, name, -1.0),))]
    if like > ALIKE and name != "r_radps":
        for unit in ("kn", "kmh", "cmps"):
            if 1.0 / NEAR < ratio / UNITS[unit] < NEAR and not 1.0 / 1.5 < ratio < 1.5:
                evidence = (
                    f"{name} is {1.0 / ratio:.3g} times what follows from x_m, y_m: it is in {unit}"
                )
                return [
                    Finding(
                        "velocity_unit",
                        evidence,
                        sure=0.95,
                        changes=(Change(name, name, UNITS[unit]),),
                    )
                ]
    late = 1.0 / 1.5 < ratio < 1.5 and like > 0.3 and _late(recording, name, recorded, rate, vessel)
    return late or _elsewhere(name, recorded, rate, r, vessel)


def _late(
    recording: Recording, name: str, recorded: Array, rate: Array, vessel: Vessel
) -> list[Finding]:
    step = float(np.median(np.diff(recording.t)))
    most = round(2.0 * froude_time(vessel) / step)
    least = max(2, round(0.1 * froude_time(vessel) / step))
    if most <= least or len(rate) < 10 * most:
        return []
    inside = slice(most, -most)
    left = {}
    for lag in range(-most, most + 1):
        moved = recorded[most + lag : len(recorded) - most + lag]
        left[lag] = float(np.mean((moved - rate[inside]) ** 2))
    best = min(left, key=lambda k: left[k])
    large = left[0] > SMALL * float(np.mean(rate**2))
    if abs(best) < least or abs(best) == most or left[best] > 0.3 * left[0] or not large:
        return []
    words = "late" if best > 0 else "early"
    evidence = (
        f"{name} is {abs(best) * step:.3g} s {words} beside x_m, y_m, psi_rad, which takes away "
    )
    evidence += f"{100.0 * (1.0 - left[best] / left[0]):.0f} % of what they differ by"
    return [Finding("velocity_late", evidence, sure=0.9, changes=(_aside(name),))]


def _elsewhere(name: str, recorded: Array, rate: Array, r: Array, vessel: Vessel) -> list[Finding]:
    if name != "v_mps":
        return []
    off = recorded - rate
    A = np.column_stack([r, np.ones_like(r)])
    (lever, _), *_ = np.linalg.lstsq(A, off, rcond=None)
    left, before = float(np.var(off - A[:, 0] * lever)), float(np.var(off))
    if (
        abs(lever) < LEVER * vessel.length
        or left > HALF * before
        or before < SMALL * float(np.mean(rate**2))
    ):
        return []
    where = "ahead of" if lever > 0.0 else "behind"
    evidence = (
        f"{name} is that of a point {abs(lever):.3g} m {where} the one whose x_m, y_m are recorded"
    )
    return [Finding("velocity_elsewhere", evidence, sure=0.9, changes=(_aside(name),))]


def _aside(name: str) -> Change:
    """The column under a name that no fit looks at."""
    return Change(f"estimate_{name}", name)
