"""Folder of hydrodynamic coefficients: text files that a person can check.

    coefficients.toml   hull, water, conventions, added mass at infinite frequency, hydrostatics
    radiation.csv       a row for each frequency and row of the matrices: added mass and damping
    excitation.csv      a row for each frequency and heading: force per amplitude of the wave
    memory.csv          sections of the model of the memory of the radiation force
    drift.csv           a row for each frequency and heading: mean drift
    drift_pairs.csv     a row for each pair of frequencies and heading: slow drift

A folder of wave loads alone, such as those of a table of motions, has no radiation.csv and
memory.csv, and only source, conventions and depth in coefficients.toml.

The units and axes are those of `table.Coefficients`.
"""

import csv
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.files import read_csv, read_toml, replace_file, toml_value
from boatsim.physics.coefficients.memory_fit import SETS, MemoryModel
from boatsim.physics.coefficients.pair_files import NAME as PAIRS
from boatsim.physics.coefficients.pair_files import read_drift_pairs, write_drift_pairs
from boatsim.physics.coefficients.table import Coefficients, DriftPairs, WaveLoads
from boatsim.physics.signals import AXES, Array

HEADER = "coefficients.toml"
RADIATION, EXCITATION = "radiation.csv", "excitation.csv"
MEMORY, DRIFT = "memory.csv", "drift.csv"
UNUSED = ".old"  # end of the name of a file that is no longer read
FILES = (HEADER, RADIATION, EXCITATION, MEMORY, DRIFT, PAIRS)
AXES_TEXT = "SNAME: x forward, y starboard, z down"
PHASE_TEXT = (
    "force = amplitude Re(X exp(i omega t)) for the elevation amplitude "
    "cos(omega t - k (x cos heading + y sin heading)), positive upward"
)
UPPER = [f"{i}{j}" for i in range(1, 4) for j in range(i, 4)]
RADIATION_COLUMNS = (
    "omega_radps",
    "axis",
    *(f"added_mass_{axis}" for axis in AXES),
    *(f"damping_{axis}" for axis in AXES),
)
EXCITATION_COLUMNS = (
    "omega_radps",
    "heading_rad",
    *(f"{axis}_{part}" for axis in AXES for part in ("real", "imaginary")),
)
MEMORY_COLUMNS = (
    "axes",
    "b_radps2",
    "a_radps",
    *(f"M{entry}" for entry in UPPER),
    *(f"N{entry}" for entry in UPPER),
)
DRIFT_COLUMNS = ("omega_radps", "heading_rad", "surge_Npm2", "sway_Npm2", "yaw_Npm")
SET_NAMES = tuple("_".join(AXES[i] for i in axes) for axes in SETS)
SPEED_COMMENT = "[m/s] forward speed of excitation.csv; without it 0"
DIGITS = 9  # significant digits of the numbers
MODEL_DIGITS = 13  # of the memory, whose sum of N / b is zero
MOST_ROWS = 200_000  # of a table; a hull needs some hundred


def write_coefficients(folder: Path, found: Coefficients) -> list[str]:
    """Write hydrodynamic coefficients to a folder, which is made if necessary.

    Args:
        folder: The folder.
        found: The coefficients.

    Returns:
        Names of the files of drift that the folder had and these coefficients have not. They are
        kept, with the end `.old` to their name.
    """
    folder.mkdir(parents=True, exist_ok=True)
    header = {
        "source": found.source,
        "axes": AXES_TEXT,
        "phase": PHASE_TEXT,
        "density": found.density,
        "depth": found.depth,
        "draught": found.draught,
        "volume": found.volume,
        "buoyancy": _rounded(found.buoyancy),
    }
    comments = {
        "density": "[kg/m^3] of the water",
        "depth": "[m] of the water; 0: deep water",
        "draught": "[m]",
        "speed": SPEED_COMMENT,
        "volume": "[m^3] displaced",
        "buoyancy": "[m] centre of buoyancy",
    }
    if found.speed > 0.0:
        header["speed"] = found.speed
    lines = []
    for key, value in header.items():
        line = f"{key} = {toml_value(value)}"
        if key in comments:
            line += f"  # {comments[key]}"
        lines.append(line)
    matrices = {
        "added mass at infinite frequency [kg, kg m, kg m^2]": (
            "infinite_added_mass",
            found.infinite_added_mass,
        ),
        "stiffness of waterplane and buoyancy, without the moment of the weight": (
            "restoring",
            found.restoring,
        ),
    }
    for words, (key, matrix) in matrices.items():
        rows = ",\n".join(f"    {toml_value(_rounded(row))}" for row in matrix)
        lines += [f"# {words}; rows and columns: {', '.join(AXES)}", f"{key} = [\n{rows},\n]"]
    if found.drift is not None:
        lines.append(f"drift_of = {toml_value(found.drift_of)}  # the hull of drift.csv")
    if found.memory is not None:
        error = toml_value(_rounded(np.array(found.memory.error)))
        lines.append(f"memory_error = {error}  # rms of the model of memory.csv over that of K")
    with replace_file(folder / HEADER) as path:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    _write_table(folder / RADIATION, RADIATION_COLUMNS, _radiation_rows(found))
    _write_table(folder / EXCITATION, EXCITATION_COLUMNS, _excitation_rows(found))
    if found.memory is not None:
        _write_table(folder / MEMORY, MEMORY_COLUMNS, _memory_rows(found.memory))
    return _write_drift(folder, found)


def write_wave_loads(folder: Path, found: WaveLoads) -> list[str]:
    """Write wave loads alone to a folder, which is made if necessary.

    Args:
        folder: The folder.
        found: The loads.

    Returns:
        Names of the files of drift that the folder had, as `write_coefficients` does.

    Raises:
        BadInput: The folder contains the coefficients of a hull.
    """
    if (folder / RADIATION).is_file():
        raise BadInput(
            f"{folder}: contains the coefficients of a hull ({RADIATION}); choose another folder "
            "with --out"
        )
    folder.mkdir(parents=True, exist_ok=True)
    lines = [
        f"source = {toml_value(found.source)}",
        f"axes = {toml_value(AXES_TEXT)}",
        f"phase = {toml_value(PHASE_TEXT)}",
        f"depth = {toml_value(found.depth)}  # [m] of the water; 0: deep water",
    ]
    if found.speed > 0.0:
        lines.append(f"speed = {toml_value(found.speed)}  # {SPEED_COMMENT}")
    with replace_file(folder / HEADER) as path:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    _write_table(folder / EXCITATION, EXCITATION_COLUMNS, _excitation_rows(found))
    return _write_drift(folder, found)


def _write_drift(folder: Path, found: Coefficients | WaveLoads) -> list[str]:
    """Write the drift, and rename a file of other coefficients if there is none.

    Returns:
        Names of the files that were renamed.
    """
    renamed = []
    for name, values in ((DRIFT, found.drift), (PAIRS, found.drift_pairs)):
        if values is None and (folder / name).is_file():
            (folder / name).replace(folder / f"{name}{UNUSED}")
            renamed.append(name)
    if found.drift is not None:
        _write_table(folder / DRIFT, DRIFT_COLUMNS, _drift_rows(found, found.drift))
    if found.drift_pairs is not None:
        write_drift_pairs(folder / PAIRS, found.drift_pairs)
    return renamed


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in np.asarray(values).tolist()]


def _radiation_rows(found: Coefficients) -> Iterable[Sequence[object]]:
    for k, frequency in enumerate(found.frequency):
        for i, axis in enumerate(AXES):
            yield [frequency, axis, *found.added_mass[k, i], *found.damping[k, i]]


def _excitation_rows(found: Coefficients | WaveLoads) -> Iterable[Sequence[object]]:
    for k, frequency in enumerate(found.frequency):
        for h, heading in enumerate(found.heading):
            parts: list[float] = []
            for value in found.excitation[k, h]:
                parts += [value.real, value.imag]
            yield [frequency, heading, *parts]


def _memory_rows(memory: MemoryModel) -> Iterable[Sequence[object]]:
    for name, sections in zip(SET_NAMES, memory.sections, strict=True):
        for one in sections:
            yield [name, *(f"{value:.{MODEL_DIGITS}g}" for value in one)]


def _drift_rows(found: Coefficients | WaveLoads, drift: Array) -> Iterable[Sequence[object]]:
    for k, frequency in enumerate(found.frequency):
        for h, heading in enumerate(found.heading):
            yield [frequency, heading, *drift[k, h]]


def _write_table(path: Path, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    with replace_file(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in rows:
            writer.writerow([_cell(value) for value in row])


def _cell(value: object) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.{DIGITS}g}"


def read_coefficients(folder: str | Path) -> Coefficients:
    """Read hydrodynamic coefficients from a folder; a second call returns the same object.

    Args:
        folder: The folder.

    Raises:
        BadInput: A file is missing, or a value is not what the format requires.
    """
    path = Path(folder)
    return _read_coefficients(path.resolve(), _times_of_change(path))


def read_wave_loads(folder: str | Path) -> WaveLoads:
    """Read the wave loads of a folder, with or without other coefficients of the hull.

    A second call returns the same object.

    Args:
        folder: The folder.

    Raises:
        BadInput: A file is missing, or a value is not what the format requires.
    """
    path = Path(folder)
    return _read_wave_loads(path.resolve(), _times_of_change(path))


def _times_of_change(path: Path) -> tuple[int, ...]:
    """Return the times of change of all files of a folder, by which an edited one is read again."""
    if not (path / HEADER).is_file():
        raise BadInput(f"{path}: there is no {HEADER}; boatsim hydrodynamics writes such a folder")
    return tuple((path / name).stat().st_mtime_ns for name in FILES if (path / name).is_file())


@lru_cache(maxsize=8)
def _read_wave_loads(folder: Path, _: tuple[int, ...]) -> WaveLoads:
    """Read the wave loads of a folder whose files have the given times of change."""
    header = read_toml(folder / HEADER)
    frequency, heading, excitation = _read_excitation(folder / EXCITATION)
    drift = None
    if (folder / DRIFT).is_file():
        drift = _read_drift(folder / DRIFT, frequency, heading)
    return WaveLoads(
        source=str(header.get("source", "")),
        depth=_number(header, "depth", folder / HEADER),
        frequency=frequency,
        heading=heading,
        excitation=excitation,
        drift=drift,
        drift_pairs=_read_pairs(folder),
        speed=_speed(header, folder / HEADER),
    )


def _read_pairs(folder: Path) -> DriftPairs | None:
    """Read the slow drift of pairs of waves, None without its file."""
    if not (folder / PAIRS).is_file():
        return None
    return read_drift_pairs(folder / PAIRS)


@lru_cache(maxsize=8)
def _read_coefficients(folder: Path, _: tuple[int, ...]) -> Coefficients:
    """Read a folder whose files have the given times of change."""
    header = read_toml(folder / HEADER)
    label = folder / HEADER
    frequency, added_mass, damping = _read_radiation(folder / RADIATION)
    waves, heading, excitation = _read_excitation(folder / EXCITATION)
    if len(waves) != len(frequency) or not np.allclose(waves, frequency):
        raise BadInput(f"{folder / EXCITATION}: the frequencies differ from those of {RADIATION}")
    memory = None
    if (folder / MEMORY).is_file():
        memory = _read_memory(folder / MEMORY, header.get("memory_error", [0.0, 0.0]), label)
    drift = None
    if (folder / DRIFT).is_file():
        drift = _read_drift(folder / DRIFT, frequency, heading)
    return Coefficients(
        source=str(header.get("source", "")),
        density=_number(header, "density", label),
        depth=_number(header, "depth", label),
        draught=_number(header, "draught", label),
        volume=_number(header, "volume", label),
        buoyancy=_array(header, "buoyancy", (3,), label),
        restoring=_array(header, "restoring", (6, 6), label),
        frequency=frequency,
        added_mass=added_mass,
        damping=damping,
        infinite_added_mass=_array(header, "infinite_added_mass", (6, 6), label),
        heading=heading,
        excitation=excitation,
        memory=memory,
        drift=drift,
        drift_of=str(header.get("drift_of", "")),
        drift_pairs=_read_pairs(folder),
        speed=_speed(header, label),
    )


def _speed(header: Mapping[str, object], label: Path) -> float:
    """Return the forward speed of the excitation [m/s], 0 in files that do not give it."""
    if "speed" not in header:
        return 0.0
    speed = _number(header, "speed", label)
    if speed < 0.0:
        raise BadInput(f"{label}: speed = {speed:g} m/s; allowed is 0 or more")
    return speed


def _number(header: Mapping[str, object], key: str, label: Path) -> float:
    value = header.get(key)
    if not isinstance(value, int | float) or isinstance(value, bool) or not np.isfinite(value):
        raise BadInput(f"{label}: {key} = {value!r}; a number is required")
    return float(value)


def _array(header: Mapping[str, object], key: str, shape: tuple[int, ...], label: Path) -> Array:
    try:
        found = np.array(header.get(key), dtype=float)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.shape != shape or not np.isfinite(found).all():
        size = " x ".join(map(str, shape))
        raise BadInput(f"{label}: {key}: {size} numbers are required")
    return found


def _read_table(path: Path, columns: Sequence[str]) -> list[list[str]]:
    """Return the rows of a table with the given columns."""
    if not path.is_file():
        raise BadInput(f"{path}: the file is missing")
    rows = read_csv(path)
    if not rows or tuple(rows[0]) != tuple(columns):
        raise BadInput(f"{path}: the first line must be {','.join(columns)}")
    if len(rows) > MOST_ROWS:
        raise BadInput(f"{path}: more than {MOST_ROWS} rows")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(columns):
            raise BadInput(f"{path}:{number}: {len(row)} columns; {len(columns)} are required")
    return rows[1:]


def _numbers(rows: Sequence[Sequence[str]], first: int, path: Path) -> Array:
    """Return the numbers of a table from a column on."""
    found = []
    for number, row in enumerate(rows, 2):
        try:
            found.append([float(cell) for cell in row[first:]])
        except ValueError:
            raise BadInput(f"{path}:{number}: a cell is not a number") from None
    values = np.array(found)
    if not np.isfinite(values).all():
        raise BadInput(f"{path}: a number is not finite")
    return values


def _read_radiation(path: Path) -> tuple[Array, Array, Array]:
    rows = _read_table(path, RADIATION_COLUMNS)
    frequency = _numbers([[row[0]] for row in rows], 0, path)[:, 0]
    axes = [row[1] for row in rows]
    if len(rows) < 18 or len(rows) % 6 or axes != [*AXES] * (len(rows) // 6):
        raise BadInput(
            f"{path}: each frequency needs the six rows {', '.join(AXES)}, and there are at least "
            "three frequencies"
        )
    values = _numbers(rows, 2, path).reshape(-1, 6, 2, 6)
    return _increasing(frequency[::6], path), values[:, :, 0], values[:, :, 1]


def _increasing(values: Array, path: Path) -> Array:
    if not np.all(np.diff(values) > 0.0) or values[0] <= 0.0:
        raise BadInput(f"{path}: frequencies must be positive and increase")
    return values


def _read_excitation(path: Path) -> tuple[Array, Array, Array]:
    """Return frequencies (N,), headings (H,) and excitation (N, H, 6)."""
    rows = _numbers(_read_table(path, EXCITATION_COLUMNS), 0, path)
    if len(rows) == 0:
        raise BadInput(f"{path}: there are no rows")
    headings = int(np.argmax(np.append(rows[:, 0] != rows[0, 0], True)))
    if len(rows) % headings:
        raise BadInput(f"{path}: every frequency needs the same headings")
    table = rows.reshape(-1, headings, rows.shape[1])
    heading, frequency = table[0, :, 1], table[:, 0, 0]
    if not np.allclose(table[:, :, 0], frequency[:, None]):
        raise BadInput(f"{path}: every frequency needs the same headings")
    if not np.allclose(table[:, :, 1], heading) or not np.all(np.diff(heading) > 0.0):
        raise BadInput(f"{path}: headings must increase and be the same at every frequency")
    if len(frequency) < 2:
        raise BadInput(f"{path}: there is one frequency; at least two are required")
    excitation = table[:, :, 2::2] + 1j * table[:, :, 3::2]
    return _increasing(frequency, path), heading, excitation


def _read_drift(path: Path, frequency: Array, heading: Array) -> Array:
    rows = _numbers(_read_table(path, DRIFT_COLUMNS), 0, path)
    waves = np.stack(np.meshgrid(frequency, heading, indexing="ij"), axis=-1).reshape(-1, 2)
    if rows.shape[0] != len(waves) or not np.allclose(rows[:, :2], waves):
        raise BadInput(f"{path}: frequencies and headings must be those of {EXCITATION}")
    return rows[:, 2:].reshape(len(frequency), len(heading), 3)


def _read_memory(path: Path, error: object, label: Path) -> MemoryModel:
    rows = _read_table(path, MEMORY_COLUMNS)
    sections = []
    for name in SET_NAMES:
        own = [row for row in rows if row[0] == name]
        values = np.zeros((0, len(MEMORY_COLUMNS) - 1))
        if own:
            values = _numbers(own, 1, path)
        if np.any(values[:, :2] <= 0.0):
            raise BadInput(f"{path}: b_radps2 and a_radps must be positive")
        sections.append(values)
    if sum(map(len, sections)) != len(rows):
        raise BadInput(f"{path}: axes must be {' or '.join(SET_NAMES)}")
    errors = _array({"memory_error": error}, "memory_error", (2,), label)
    return MemoryModel((sections[0], sections[1]), (float(errors[0]), float(errors[1])))
