"""Detection of angles recorded in degrees, by their motion.

The range of a heading does not show its unit.
"""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.raw_table import select_rows

DEGREES = 180.0 / math.pi  # [deg/rad]
# Factor by which a ratio may differ from its expected value, for sensors have delay, drift and
# scale errors
RATIO_TOLERANCE = 1.5
# [rad/s] sustained turning that no boat reaches; 4 deg/s is a gentle turn of a small boat. Small
# hovercraft and models turn faster, so that a second sign must confirm the unit
MAX_TURNING = 4.0
# [rad/s] sustained rolling that no body in bearings reaches: three turns a second. In degrees it
# would be a third of a degree in a second
MAX_TUMBLING = 20.0
# [rad/s] sustained turning that nothing reaches, 6 turns a second; 40 deg/s is a fast small boat
IMPOSSIBLE_TURNING = 40.0
# [rad] 8.6 degrees: compasses and cameras are ten times better; 0.15 degrees is a good one
MAX_NOISE = 0.15
# [rad/s] scatter of a rate of turn, 3 deg/s: gyroscopes are twenty times better
MAX_RATE_NOISE = 0.05
# An angle moves by more than a turn and a half in one row where it is in degrees and wraps. An
# angle in radians that is counted on does so in a gap, but not at this many times its usual rate
MAX_LEAP_RATE = 3.0
USUAL_RATE_PERCENTILE = 90.0  # of the rates from row to row
# Numbers with one decimal or none: a resolution of 6 degrees if they were radians
COARSEST = 0.1
MIN_LEVELS = 10  # different values that show the resolution of a column
# [rad] hulls stay below 57 degrees of roll; any roll worth recording exceeds 1 degree
MAX_ROLL = 1.0
# by which the course agrees better with the heading in one unit than in the other (mean resultant
# length); it is 0.4 or more on nearly all recordings of boats that turn, at most 0.35 on others
MIN_COURSE_AGREEMENT = 0.4
NOISE_ORDERS = (2, 3, 4, 5)  # of the differences in which the noise of a heading is estimated
FEWEST_VALUES = 2  # of a column, without which no change of an angle is seen
MIN_ROWS = 4  # with increasing time
MIN_CORRELATION = 0.8  # between two series of the same motion
# [rad] excess over a full circle of a wrapped heading, for numbers are rounded
WRAP_TOLERANCE = 0.01
# share of the circle that a wrapped heading of a turning vessel covers
MIN_COVERED = 0.95
MIN_WRAPS = 2  # one large step may be an outlier
ANGLES = {"r_radps": "psi_rad", "p_radps": "phi_rad"}  # rate -> its integral


def find_columns_in_degrees(
    columns: Mapping[str, Array], turns_over: bool = False
) -> dict[str, int]:
    """Return the columns of a table that hold degrees although their names promise radians.

    The motion decides. Rows at which time does not increase are ignored.

    Args:
        columns: Columns (N,) of a table with `t_s`.
        turns_over: Whether the vessel may roll to any angle.

    Returns:
        Column -> number of a row that shows that it is in degrees.
    """
    forward = np.flatnonzero(
        np.append(True, columns["t_s"][1:] > np.maximum.accumulate(columns["t_s"])[:-1])
    )
    if len(forward) < MIN_ROWS:
        return {}
    found = _in_degrees(select_rows(columns, forward), turns_over)
    for name, index in found.items():
        found[name] = int(forward[index])
    return found


def _in_degrees(columns: Mapping[str, Array], turns_over: bool) -> dict[str, int]:
    found: dict[str, int] = {}
    for name in ("psi_rad", "phi_rad", "r_radps", "p_radps"):
        if name not in columns:
            continue
        rows, t, values, others = _rows_with_values(columns, name)
        if len(rows) < FEWEST_VALUES:
            continue
        if name == "psi_rad":
            index = find_heading_in_degrees(t, values, others)
        elif name == "phi_rad":
            index = find_roll_in_degrees(t, values, others.get("p_radps"), turns_over)
        else:
            fastest = MAX_TURNING
            if name == "p_radps" and turns_over:
                fastest = MAX_TUMBLING
            angle = _angle_at(columns, ANGLES[name], t)
            index = find_rate_in_degrees(t, values, angle, fastest)
        if index is not None:
            found[name] = int(rows[index])
    return found


def _angle_at(columns: Mapping[str, Array], name: str, t: Array) -> Array | None:
    """An unwrapped angle (N,) at times (N,) [s], between its own samples; None without samples."""
    if name not in columns:
        return None
    known = np.isfinite(columns[name])
    if known.sum() < MIN_ROWS:
        return None
    return np.asarray(np.interp(t, columns["t_s"][known], np.unwrap(columns[name][known])))


def _rows_with_values(
    columns: Mapping[str, Array], name: str
) -> tuple[NDArray[np.int64], Array, Array, dict[str, Array]]:
    """Rows with values of a column: numbers, times, values, and columns without gaps there."""
    rows = np.flatnonzero(np.isfinite(columns[name]))
    selected = select_rows(columns, rows)
    others = {n: v for n, v in selected.items() if np.isfinite(v).all()}
    return rows, selected["t_s"], selected[name], others


def find_heading_in_degrees(t: Array, psi: Array, signals: Mapping[str, Array]) -> int | None:
    """Return a row that shows that a recorded heading is in degrees, None if it is in radians.

    Recorded rates and the course made good decide by their ratio to the changes of the heading.
    Without them two independent signs are required: scatter that no compass has in radians,
    together with values beyond one turn; turning that no boat has; and a course that agrees better
    with the heading if that is in degrees. A craft that spins, whose heading is counted on over
    hundreds of radians, shows the second one only.

    Args:
        t: Times (N,) [s].
        psi: Heading (N,) as written, not unwrapped.
        signals: Other signals (N,).
    """
    steps = np.diff(psi)
    largest = int(np.argmax(np.abs(steps))) + 1
    if _is_wrapped_in_radians(psi, steps):
        return None
    if _is_wrapped_in_radians(psi / DEGREES, steps / DEGREES):
        return largest
    if _leaps(t, steps, largest - 1):  # radians wrap by 2 pi, degrees by 360
        return largest
    if "r_radps" in signals:
        turned = cumulative_integral(t, signals["r_radps"])
        # The heading is not unwrapped, for fast turning in degrees looks like wraps
        if _is_near(_ratio(turned, psi), DEGREES):
            return largest
        if _is_near(_ratio(turned, np.unwrap(psi)), 1.0):
            return None
    turning = _sustained_turning(t, psi)
    scatters = _heading_noise(psi) > MAX_NOISE
    signs = [scatters, turning > MAX_TURNING]
    if "x_m" in signals and "y_m" in signals:
        x, y = signals["x_m"], signals["y_m"]
        if _follows_course(t, psi, x, y):
            return largest
        signs.append(_course_agreement(t, psi, x, y) > MIN_COURSE_AGREEMENT)
    beyond_turn = float(np.max(np.abs(psi))) > 2.0 * math.pi + WRAP_TOLERANCE
    if sum(signs) > 1 or (scatters and beyond_turn) or turning > IMPOSSIBLE_TURNING:
        return largest
    return None


def _leaps(t: Array, steps: Array, at: int) -> bool:
    """Whether a step of a heading is far beyond a turn, and its time does not explain it.

    Args:
        t: Times (N,) [s].
        steps: Steps (N - 1,) of the heading from row to row.
        at: Index of the largest step.
    """
    if abs(steps[at]) <= 3.0 * math.pi:
        return False
    rates = np.abs(steps) / np.diff(t)
    usual = float(np.percentile(np.delete(rates, at), USUAL_RATE_PERCENTILE))
    return bool(rates[at] > MAX_LEAP_RATE * usual)


def _is_wrapped_in_radians(psi: Array, steps: Array) -> bool:
    """Whether a heading fills one turn in radians and wraps at its ends, as no heading in degrees.

    A vessel that spins under a large unknown moment turns faster than any other recording.
    """
    if not MIN_COVERED * 2.0 * math.pi < float(np.ptp(psi)) < 2.0 * math.pi + WRAP_TOLERANCE:
        return False
    low = float(psi.min())
    one_turn = min(abs(low), abs(low + math.pi)) < 2.0 * math.pi * (1.0 - MIN_COVERED)
    inside = low > -math.pi - WRAP_TOLERANCE and float(psi.max()) < 2.0 * math.pi + WRAP_TOLERANCE
    return one_turn and inside and int(np.sum(np.abs(steps) > math.pi)) >= MIN_WRAPS


def find_rate_in_degrees(
    t: Array, rate: Array, angle: Array | None, fastest: float = MAX_TURNING
) -> int | None:
    """Decide whether a recorded angular rate (N,) is in degrees per second.

    The changes of the angle decide. Without them two independent signs are required: a size that no
    vessel sustains, and scatter or a resolution that no gyroscope has in radians per second.

    Args:
        t: Times (N,) [s].
        rate: Rates (N,) as written.
        angle: Angle (N,) of which this is the rate, unwrapped; None without one.
        fastest: Largest rate [rad/s] that the vessel sustains.

    Returns:
        A row that shows it, None for radians per second.
    """
    largest = int(np.argmax(np.abs(rate)))
    if angle is not None:
        ratio = _ratio(np.unwrap(angle), cumulative_integral(t, rate))
        if _is_near(ratio, DEGREES):
            return largest
        if _is_near(ratio, 1.0):
            return None
    sustained = float(np.percentile(np.abs(rate), 75))
    if sustained <= fastest:
        return None
    is_coarse = _is_rounded(rate) or _noise(np.diff(rate)) > MAX_RATE_NOISE
    if is_coarse or sustained > IMPOSSIBLE_TURNING:
        return largest
    return None


def _is_rounded(values: Array) -> bool:
    """Whether values (N,) have one decimal or none, and enough levels to show it."""
    levels = np.unique(values)
    steps = levels / COARSEST
    return len(levels) >= MIN_LEVELS and bool(np.all(np.abs(steps - np.round(steps)) < 1e-6))


def find_roll_in_degrees(
    t: Array, phi: Array, rate: Array | None, turns_over: bool = False
) -> int | None:
    """Decide whether a recorded roll angle (N,) is in degrees.

    A recorded roll rate shows it. Without one, the size of the roll shows it for a hull, and the
    speed of the roll for a body that turns over.

    Args:
        t: Times (N,) [s].
        phi: Roll (N,) as written.
        rate: Recorded roll rate (N,), None without one.
        turns_over: Whether the vessel may roll to any angle.

    Returns:
        A row that shows it, None for radians.
    """
    largest = int(np.argmax(np.abs(phi)))
    if rate is not None:
        ratio = _ratio(cumulative_integral(t, rate), phi)
        if _is_near(ratio, DEGREES):
            return largest
        if _is_near(ratio, 1.0):  # a hull that is knocked down
            return None
    limit = MAX_ROLL
    if turns_over:
        limit = math.inf
        if _fastest_rolling(t, phi) > MAX_TUMBLING:
            return largest
    if abs(phi[largest]) > limit:
        return largest
    return None


def cumulative_integral(t: Array, rate: Array) -> Array:
    """Return the time integral (N,) of a rate from the first row on, by the trapezoidal rule.

    Args:
        t: Times (N,) [s].
        rate: Rates (N,).
    """
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(t))))


def _is_near(ratio: float, value: float) -> bool:
    return value / RATIO_TOLERANCE < ratio < value * RATIO_TOLERANCE


def _rows_in(t: Array, seconds: float) -> int:
    return max(1, round(min(len(t) / 4, seconds / float(np.median(np.diff(t))))))


def _ratio(known: Array, asked: Array) -> float:
    """Ratio of the changes of `asked` to those of `known` over windows.

    Nan where they are not correlated.
    """
    for parts in (64, 16, 4):  # short windows have most information, long ones average the noise
        rows = max(1, len(known) // parts)
        a, b = known[rows:] - known[:-rows], asked[rows:] - asked[:-rows]
        size = math.sqrt(float(a @ a) * float(b @ b))
        if size > 0.0 and float(a @ b) > MIN_CORRELATION * size:
            return math.sqrt(float(b @ b) / float(a @ a))
    return math.nan


def _follows_course(t: Array, psi: Array, x: Array, y: Array) -> bool:
    """Whether the heading agrees with the course if in degrees, but not if in radians."""
    rows = _rows_in(t, 1.0)
    dx, dy = x[rows:] - x[:-rows], y[rows:] - y[:-rows]
    course, bow = np.arctan2(dy, dx), psi[rows // 2 : rows // 2 + len(dx)]
    degrees = float(np.median(np.abs(_wrap(course - bow / DEGREES))))
    radians = float(np.median(np.abs(_wrap(course - bow))))
    return degrees < 0.3 and radians > 0.6 and float(np.ptp(bow)) > 0.5 * DEGREES


def _course_agreement(t: Array, psi: Array, x: Array, y: Array) -> float:
    """How much better the course agrees with a heading if that is in degrees, -1 to 1.

    The agreement is the mean resultant length of the angle between them, weighted by the distance.
    It must be better than that of radians and than that of any constant heading: a spinning craft
    that drifts one way agrees with a heading that hardly changes.
    """
    rows = _rows_in(t, 1.0)
    dx, dy = x[rows:] - x[:-rows], y[rows:] - y[:-rows]
    course, bow = np.arctan2(dy, dx), psi[rows // 2 : rows // 2 + len(dx)]
    distance = np.hypot(dx, dy)
    total = float(np.sum(distance))
    if total == 0.0:
        return 0.0
    degrees = np.sum(distance * np.exp(1j * (course - bow / DEGREES)))
    radians = np.sum(distance * np.exp(1j * (course - bow)))
    constant = np.sum(distance * np.exp(1j * course))
    return float(abs(degrees) - max(abs(radians), abs(constant))) / total


def _wrap(angle: Array) -> Array:
    return np.remainder(angle + math.pi, 2.0 * math.pi) - math.pi


def _heading_noise(psi: Array) -> float:
    """Standard deviation of a heading [rad] from its differences, robust to outliers.

    A heading that is counted on may turn by more than half a turn from row to row.
    """
    differences = np.diff(psi)
    return min(_noise(differences), _noise(_wrap(differences)))


def _noise(differences: Array) -> float:
    """Standard deviation of a signal from its differences (N,), robust to outliers.

    Differences of higher order contain less of the motion; the smallest estimate counts.
    """
    found = math.inf
    for order in NOISE_ORDERS:
        differences = np.diff(differences)
        if len(differences):
            sd = (
                1.48
                * float(np.median(np.abs(differences)))
                / math.sqrt(math.comb(2 * order, order))
            )
            found = min(found, sd)
    return found


def _sustained_turning(t: Array, psi: Array) -> float:
    """Rate of turning over half a second [rad/s] that a quarter of the recording exceeds."""
    rows = _rows_in(t, 0.5)
    smooth = np.unwrap(psi)
    return float(np.percentile(np.abs(smooth[rows:] - smooth[:-rows]) / (t[rows:] - t[:-rows]), 75))


def _fastest_rolling(t: Array, phi: Array) -> float:
    """Rate of roll over a tenth of a second [rad/s] that one in a hundred rows exceeds."""
    rows = _rows_in(t, 0.1)
    if float(np.ptp(phi)) < 2.0 * math.pi + WRAP_TOLERANCE:
        phi = np.unwrap(phi)
    return float(np.percentile(np.abs(phi[rows:] - phi[:-rows]) / (t[rows:] - t[:-rows]), 99))
