"""Table of the slow drift of pairs of waves, drift_pairs.csv of a folder of coefficients.

A row has the frequencies of two waves [rad/s], the second at most as high as the first, their
direction [rad], and the real and imaginary part of force and moment per product of the amplitudes,
as `table.DriftPairs` has them.
"""

import csv
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.files import read_csv, replace_file
from boatsim.physics.coefficients.table import DriftPairs
from boatsim.physics.signals import AXES, ROTATIONS

NAME = "drift_pairs.csv"
COLUMNS = (
    "omega1_radps",
    "omega2_radps",
    "heading_rad",
    *(
        f"{axis}_{part}_{'Npm' if axis in ROTATIONS else 'Npm2'}"
        for axis in AXES
        for part in ("real", "imaginary")
    ),
)
DIGITS = 9  # significant digits of the numbers
MOST_ROWS = 1_000_000  # 100 frequencies and 181 headings are less
SAME = 1e-6  # relative difference of frequencies, and difference of headings, that are the same


def write_drift_pairs(path: Path, pairs: DriftPairs) -> None:
    """Write the slow drift of pairs of waves.

    Args:
        path: The file.
        pairs: The drift.
    """
    with replace_file(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for k, first in enumerate(pairs.frequency):
            for m, second in enumerate(pairs.frequency[: k + 1]):
                for h, heading in enumerate(pairs.heading):
                    row = [first, second, heading]
                    for value in pairs.values[k, m, h]:
                        row += [value.real, value.imag]
                    writer.writerow([f"{number:.{DIGITS}g}" for number in row])


def read_drift_pairs(path: Path) -> DriftPairs:
    """Read the slow drift of pairs of waves.

    Args:
        path: The file.

    Raises:
        BadInput: A line has another form, a pair is missing, or the drift of a wave with itself is
            not real.
    """
    lines = read_csv(path)
    if not lines or tuple(lines[0]) != COLUMNS:
        raise BadInput(f"{path}: the first line must be {','.join(COLUMNS)}")
    if len(lines) > MOST_ROWS:
        raise BadInput(f"{path}: more than {MOST_ROWS} rows")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        if len(line) != len(COLUMNS):
            raise BadInput(f"{path}:{number}: {len(line)} columns; {len(COLUMNS)} are required")
        try:
            row = [float(cell) for cell in line]
        except ValueError:
            raise BadInput(f"{path}:{number}: a cell is not a number") from None
        if not np.isfinite(row).all():
            raise BadInput(f"{path}:{number}: a number is not finite")
        rows.append(row)
    table = np.array(rows).reshape(-1, len(COLUMNS))
    return complete_pairs(table[:, :3], table[:, 3::2] + 1j * table[:, 4::2], str(path))


def complete_pairs(
    waves: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    values: np.ndarray[tuple[int, ...], np.dtype[np.complex128]],
    label: str,
) -> DriftPairs:
    """Return the drift of all pairs from rows in any order, half of the pairs at least.

    Args:
        waves: Frequencies of both waves and their direction (R, 3) [rad/s, rad].
        values: Force and moment of each row (R, 6).
        label: File, for messages.

    Raises:
        BadInput: A pair is missing, or the drift of a wave with itself is not real.
    """
    frequency, heading = _different(waves[:, :2], SAME), _different(waves[:, 2], SAME)
    if len(frequency) < 3 or frequency[0] <= 0.0:
        raise BadInput(f"{label}: at least three frequencies above 0 are required")
    shape = (len(frequency), len(frequency), len(heading), 6)
    found = np.full(shape, np.nan + 0j)
    for (first, second, direction), row in zip(waves, values, strict=True):
        k = int(np.argmin(np.abs(frequency - first)))
        m = int(np.argmin(np.abs(frequency - second)))
        h = int(np.argmin(np.abs(heading - direction)))
        found[k, m, h] = row
        if np.isnan(found[m, k, h]).any():
            found[m, k, h] = np.conj(row)
    missing = np.argwhere(np.isnan(found).any(axis=3))
    if len(missing):
        k, m, h = missing[0]
        raise BadInput(
            f"{label}: the pair of {frequency[k]:.4g} and {frequency[m]:.4g} rad/s at "
            f"{heading[h]:.4g} rad is missing; every frequency is paired with every one"
        )
    diagonal = np.einsum("kkha->kha", found)
    size = np.abs(found).max()
    if size > 0.0 and np.abs(diagonal.imag).max() > 1e-3 * size:
        raise BadInput(f"{label}: the drift of a wave with itself must be real")
    exchanged = np.conj(found.transpose(1, 0, 2, 3))
    return DriftPairs(frequency, heading, np.asarray(0.5 * (found + exchanged)))


def _different(
    values: np.ndarray[tuple[int, ...], np.dtype[np.float64]], close: float
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the different numbers, increasing."""
    ordered = np.sort(values.ravel())
    if len(ordered) == 0:
        return ordered
    new = np.append(True, np.diff(ordered) > close * max(1.0, float(np.abs(ordered).max())))
    return np.asarray(ordered[new])
