"""Coefficients from the output files of WAMIT.

They are NAME.1, NAME.3 or NAME.2, and where they exist NAME.hst, NAME.8 or NAME.9, and NAME.12d or
NAME.11d. Response amplitude operators are NAME.2, NAME.3 or NAME.4 alone.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.arguments import short_repr
from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import SIGNS, excitation_to_sname, to_sname
from boatsim.hydrodynamics.headings import on_starboard_side
from boatsim.hydrodynamics.mean_drift import DRIFT_AXES
from boatsim.hydrodynamics.rao_table import Complex, RaoTable, complete_table, refuse_holes
from boatsim.hydrodynamics.wamit_pairs import COLUMNS as PAIR_COLUMNS
from boatsim.hydrodynamics.wamit_pairs import pairs_next_to, wamit_pairs
from boatsim.physics.coefficients.memory_fit import estimated_infinite_added_mass
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array

COLUMNS = 5  # of NAME.1: period, row, column, added mass, damping; the last only of finite periods
STIFFNESS_COLUMNS = 3  # of NAME.hst: row, column, stiffness
RAO_COLUMNS = 7  # of NAME.2 to .4: period, direction, axis, modulus, phase, real, imaginary part
DRIFT_COLUMNS = 8  # of NAME.8: period, two directions, axis, modulus, phase, real, imaginary part
SAME_DIRECTION = 1e-3  # [deg] between directions that are the same


@dataclass(frozen=True)
class OutputScale:
    """Dimensions and water, which the files of WAMIT or Nemoh do not contain.

    Attributes:
        length: Unit of length of WAMIT, ULEN [m].
        density: Density of the water [kg/m^3].
        depth: Depth of the water [m]; 0 for deep water.
        draught: Draught of the hull [m].
        volume: Displaced volume [m^3]; 0 if it is not known.
    """

    length: float
    density: float
    depth: float
    draught: float
    volume: float = 0.0


def read_wamit(path: Path, scale: OutputScale) -> Coefficients:
    """Read coefficients from WAMIT's output next to NAME.1.

    A period of zero stands for infinite frequency, a negative one for frequency zero. Without
    infinite frequency the added mass there is estimated.

    Args:
        path: NAME.1.
        scale: Dimensions that the files do not contain.

    Raises:
        BadInput: A file is missing or has another form.
    """
    frequency, added_mass, damping, infinite = read_wamit_radiation(path, scale)
    heading, excitation = _read_excitation(path, frequency, scale)
    drift, drift_of = _read_drift(path, frequency, heading, scale)
    pairs, file = None, pairs_next_to(path)
    if file is not None:
        pairs = wamit_pairs(_read_numbers(file, PAIR_COLUMNS), file, scale.density, scale.length)
    return Coefficients(
        source=f"WAMIT, {path.name}",
        density=scale.density,
        depth=scale.depth,
        draught=scale.draught,
        volume=scale.volume,
        buoyancy=np.zeros(3),
        restoring=_read_restoring(path.with_suffix(".hst"), scale),
        frequency=frequency,
        added_mass=added_mass,
        damping=damping,
        infinite_added_mass=infinite,
        heading=heading,
        excitation=excitation,
        drift=drift,
        drift_of=drift_of,
        drift_pairs=pairs,
    )


def read_wamit_radiation(path: Path, scale: OutputScale) -> tuple[Array, Array, Array, Array]:
    """Read added mass and damping alone.

    Args:
        path: NAME.1.
        scale: Dimensions that the file does not contain.

    Returns:
        Frequencies (N,) [rad/s], added mass and damping (N, 6, 6), and the added mass at infinite
        frequency (6, 6), which is estimated if the file lacks it.

    Raises:
        BadInput: The file is missing or has another form.
    """
    rows = _read_numbers(path, COLUMNS - 1)
    infinite = np.full((6, 6), np.nan)
    found: dict[float, Array] = {}
    for row in rows:
        period, i, j = row[0], _axis(row[1], path), _axis(row[2], path)
        size = scale.density * scale.length ** _power(i, j)
        if period == 0.0:
            infinite[i, j] = row[3] * size
        elif period > 0.0:
            if len(row) < COLUMNS:
                raise BadInput(f"{path}: a period of {period:g} s has no damping")
            w = 2.0 * np.pi / period
            matrices = found.setdefault(w, np.zeros((2, 6, 6)))
            matrices[:, i, j] = row[3] * size, row[4] * size * w
    if len(found) < 3:
        raise BadInput(f"{path}: at least three periods are required")
    frequency = np.array(sorted(found))
    added_mass = to_sname(np.array([found[w][0] for w in frequency]))
    damping = to_sname(np.array([found[w][1] for w in frequency]))
    if np.isnan(infinite).all():
        infinite = estimated_infinite_added_mass(frequency, added_mass, damping)
    else:
        infinite = to_sname(np.nan_to_num(infinite))
    return frequency, added_mass, damping, infinite


def _power(i: int, j: int) -> int:
    """Power of the length in the unit of an entry of the added mass."""
    return 3 + (i > 2) + (j > 2)


def _read_numbers(path: Path, columns: int) -> list[list[float]]:
    """Return the rows of numbers of a file, without lines of text.

    Args:
        path: The file.
        columns: Least number of columns of a row.

    Raises:
        BadInput: There is no such file, it has no numbers, or a row has a value that is none.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    found = []
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    for number, line in enumerate(lines, 1):
        words = line.replace("D", "E").split()
        if not words or not _is_number(words[0]):
            continue  # a header
        if "*" in line:  # Fortran writes a number that is too long for its columns so
            raise BadInput(f"{path}:{number}: {short_repr(line.strip())}: a value is no number")
        if not all(map(_is_number, words)):
            continue  # a header that begins with a number
        row = [float(word) for word in words]
        if row[0] == np.inf:
            row[0] = -1.0  # the period of frequency zero
        if not np.isfinite(row).all():
            raise BadInput(f"{path}:{number}: {short_repr(line.strip())}: a value is no number")
        if len(row) < columns:
            raise BadInput(f"{path}:{number}: a row has {len(row)} columns; {columns} are required")
        found.append(row)
    if not found:
        raise BadInput(f"{path}: the file has no numbers")
    return found


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _axis(number: float, path: Path) -> int:
    """Return the place of an axis in `AXES` from its number in a file."""
    if number not in range(1, 7):
        raise BadInput(f"{path}: motion {number:g}; only one body of six is read")
    return int(number) - 1


def _read_excitation(path: Path, frequency: Array, scale: OutputScale) -> tuple[Array, Array]:
    """Return headings and excitation from NAME.3 (diffraction) or NAME.2 (Haskind)."""
    file = path.with_suffix(".3")
    if not file.is_file():
        file = path.with_suffix(".2")
    if not file.is_file():
        raise BadInput(f"{path.with_suffix('.3')}: there is neither this file nor {file.name}")
    table: dict[float, Complex] = {}
    for row in _read_numbers(file, RAO_COLUMNS):
        if row[0] <= 0.0:
            continue
        k = int(np.argmin(np.abs(frequency - 2.0 * np.pi / row[0])))
        values = table.setdefault(row[1], np.full((len(frequency), 6), np.nan + 0j))
        i = _axis(row[2], file)
        size = scale.density * GRAVITY * scale.length ** (2 + (i > 2))
        values[k, i] = (row[5] + 1j * row[6]) * size
    heading = np.array(sorted(table))
    if not table:
        raise BadInput(f"{file}: there is no period above 0")
    excitation: Complex = np.stack([table[angle] for angle in heading], axis=1)
    refuse_holes(excitation, frequency, np.radians(heading), file)
    sname = excitation_to_sname(np.nan_to_num(excitation), conjugate=False)
    return on_starboard_side(np.radians(-heading), sname, file)


def read_wamit_operators(path: Path, scale: OutputScale, origin: float) -> RaoTable:
    """Read the response amplitude operators of WAMIT.

    Motions are those of the origin of the body's axes; a rotation is dimensionless with the unit of
    length. Loads are dimensionless with density, gravity and powers of the unit of length.

    Args:
        path: NAME.4, motions, or NAME.2 or NAME.3, loads.
        scale: Dimensions that the file does not contain.
        origin: Place of the vessel's origin of motion along x of the body's axes [m].

    Raises:
        BadInput: The file has another form.
    """
    waves, rows = [], []
    motion = path.suffix == ".4"
    found: dict[tuple[float, float], list[complex]] = {}
    for row in _read_numbers(path, RAO_COLUMNS):
        i = _axis(row[2], path)
        if row[0] <= 0.0:
            continue  # the limits of frequency zero and infinity
        values = found.setdefault((row[0], row[1]), [complex(np.nan)] * 6)
        size = scale.density * GRAVITY * scale.length ** (2 + (i > 2))
        if motion:
            size = scale.length ** -float(i > 2)
        values[i] = (row[5] + 1j * row[6]) * size
    for (period, direction), values in found.items():
        turned = (np.radians(-direction) + np.pi + 1e-9) % (2.0 * np.pi) - np.pi - 1e-9
        waves.append((2.0 * np.pi / period, turned))
        rows.append(values)
    if not rows:
        raise BadInput(f"{path}: there is no period above 0")
    sname = excitation_to_sname(np.array(rows), conjugate=False)
    frequency, heading, complete = complete_table(np.array(waves), sname.astype(complex), path)
    return RaoTable(
        source=f"WAMIT, {path.name}",
        kind="motion" if motion else "load",
        frequency=frequency,
        heading=heading,
        values=complete,
        depth=scale.depth,
        point=(-origin, 0.0),
    )


def _read_drift(
    path: Path, frequency: Array, heading: Array, scale: OutputScale
) -> tuple[Array | None, str]:
    """Return the mean drift of NAME.8 (momentum) or NAME.9 (pressure), and its origin in words.

    Rows of two waves of different directions are not used, and neither are the moments about the
    axes of the body, whose numbers are negative.
    """
    file = path.with_suffix(".8")
    if not file.is_file():
        file = path.with_suffix(".9")
    if not file.is_file():
        return None, ""
    table: dict[float, Array] = {}
    for row in _read_numbers(file, DRIFT_COLUMNS):
        i = int(row[3]) - 1
        if row[0] <= 0.0 or abs(row[1] - row[2]) > SAME_DIRECTION or i not in DRIFT_AXES:
            continue
        k = int(np.argmin(np.abs(frequency - 2.0 * np.pi / row[0])))
        values = table.setdefault(row[1], np.full((len(frequency), 6), np.nan))
        values[k, i] = row[6] * scale.density * GRAVITY * scale.length ** (1 + (i > 2))
    if not table:
        raise BadInput(f"{file}: there is no mean drift of waves of one direction")
    angles = np.array(sorted(table))
    values = np.stack([table[angle] for angle in angles], axis=1) * SIGNS
    found, values = on_starboard_side(np.radians(-angles), values, file)
    drift = values[:, :, DRIFT_AXES]
    if len(found) != len(heading) or not np.allclose(
        found, heading, atol=np.radians(SAME_DIRECTION)
    ):
        raise BadInput(f"{file}: the directions differ from those of the excitation")
    if np.isnan(drift).any():
        raise BadInput(f"{file}: surge, sway and yaw of every period and direction are required")
    return drift, f"motions of {file.name}"


def _read_restoring(path: Path, scale: OutputScale) -> Array:
    """Return the hydrostatic stiffness of NAME.hst (6, 6), zero without the file."""
    found = np.zeros((6, 6))
    if not path.is_file():
        return found
    for row in _read_numbers(path, STIFFNESS_COLUMNS):
        i, j = _axis(row[0], path), _axis(row[1], path)
        power = 2 + (i > 2) + (j > 2)
        found[i, j] = row[2] * scale.density * GRAVITY * scale.length**power
    return to_sname(found)
