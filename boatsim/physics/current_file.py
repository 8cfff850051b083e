"""Table of a current: a CSV file with its velocity over time, place and depth.

The first line names the columns, each other line is a point. `north_mps` and `east_mps` are the
velocity of the water over the ground; `t_s`, `x_m`, `y_m` and `depth_m` may each be left out. The
points form a grid: every combination of the values of these columns has one row, and rows are
sorted by time, then x, y and depth.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import prod
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import read_csv
from boatsim.physics.signals import Array

GRID = ("t_s", "x_m", "y_m", "depth_m")
VELOCITY = ("north_mps", "east_mps")
MOST_ROWS = 200_000  # of the file, to be read within a second
# Points of time and place, each of which is held in memory for each boat of a batch
MOST_POINTS = 20_000
LARGE = 2**62  # more than the number of rows, and an integer of numpy
FASTEST = 20.0  # [m/s] twice the fastest tidal streams; a larger number has another unit


@dataclass(frozen=True, eq=False)
class CurrentTable:
    """Velocity of a current over the ground on a grid of time, place and depth.

    Attributes:
        time: Times (T,) [s], increasing; zero if the file has none.
        north: Places (X,) along x [m], increasing; zero if the file has none.
        east: Places (Y,) along y [m], increasing; zero if the file has none.
        depth: Depths (D,) below the surface [m], increasing; zero if the file has none.
        velocity: Velocity to north and east (T, X, Y, D, 2) [m/s].
    """

    time: Array
    north: Array
    east: Array
    depth: Array
    velocity: Array

    def mean_over_draught(self, draught: float) -> Array:
        """Return the mean velocity from the surface to a depth (T, X, Y, 2) [m/s].

        The velocity is linear between the depths of the table, and constant beyond them.

        Args:
            draught: The depth [m]; 0 for the velocity at the surface.
        """
        weights = mean_weights(self.depth, draught)
        return np.asarray(np.einsum("d,txydc->txyc", weights, self.velocity))

    def mean_over_places(self, velocity: Array) -> Array:
        """Return the mean over the area of the table (T, 2) of a velocity (T, X, Y, 2) [m/s].

        Args:
            velocity: Velocity at the points of time and place [m/s].
        """
        along, across = trapezoid_weights(self.north), trapezoid_weights(self.east)
        return np.asarray(np.einsum("x,y,txyc->tc", along, across, velocity))


def trapezoid_weights(points: Array) -> Array:
    """Return the weights (N,) of the mean of a function that is linear between points.

    Args:
        points: Points (N,), increasing.
    """
    if len(points) == 1:
        return np.ones(1)
    widths = np.diff(points)
    weights = np.zeros(len(points))
    weights[:-1] += 0.5 * widths
    weights[1:] += 0.5 * widths
    return np.asarray(weights / weights.sum())


def mean_weights(depths: Array, draught: float) -> Array:
    """Return the weights (D,) of the values at some depths in the mean from the surface to another.

    Args:
        depths: Depths (D,) [m], increasing.
        draught: Depth to which the mean extends [m]; 0 for the value at the surface.
    """
    each = np.eye(len(depths))
    inside = depths[(depths > 0.0) & (depths < draught)]
    levels = np.concatenate([[0.0], inside, [draught]])
    values = np.array([np.interp(levels, depths, one) for one in each])  # (D, levels)
    if draught <= 0.0:
        return np.asarray(values[:, 0])
    return np.asarray(np.trapezoid(values, levels, axis=1) / draught)


def read_current(file: str | Path) -> CurrentTable:
    """Read the table of a current from a CSV file; a second call returns the same object.

    Args:
        file: The file.

    Raises:
        BadInput: The file is missing, or its content is not what the format requires.
    """
    path = Path(file)
    if not path.is_file():
        raise BadInput(f"{path}: no such file; a table of a current is a CSV file")
    return _read_current(path.resolve(), path.stat().st_mtime_ns)


@lru_cache(maxsize=8)
def _read_current(path: Path, _: int) -> CurrentTable:
    """Read a file that has the given time of change."""
    rows = read_csv(path)
    columns = [cell.strip() for cell in rows[0]] if rows else []
    _check_columns(columns, path)
    values = _numbers(rows[1:], columns, path)
    time, north, east, depth = (_points(values, columns, column) for column in GRID)
    _check_grid(values, columns, (time, north, east, depth), path)
    count = len(time) * len(north) * len(east)
    if count > MOST_POINTS:
        raise BadInput(
            f"{path}: {count} points of time and place; allowed are at most {MOST_POINTS}"
        )
    velocity = values[:, [columns.index(column) for column in VELOCITY]]
    shape = (len(time), len(north), len(east), len(depth), 2)
    return CurrentTable(time, north, east, depth, velocity.reshape(shape))


def _points(values: Array, columns: Sequence[str], column: str) -> Array:
    """Values (N,) of one axis of the grid, increasing; zero if the file lacks its column."""
    if column not in columns:
        return np.zeros(1)
    return np.asarray(np.unique(values[:, columns.index(column)]))


def _check_columns(columns: Sequence[str], path: Path) -> None:
    for column in columns:
        if column not in (*GRID, *VELOCITY):
            raise BadInput(unknown_name_message(f"{path}: column", column, [*GRID, *VELOCITY]))
        if columns.count(column) > 1:
            raise BadInput(f"{path}: column {column} appears twice")
    for column in VELOCITY:
        if column not in columns:
            raise BadInput(
                f"{path}: no column {column}; {' and '.join(VELOCITY)} are required, "
                f"{', '.join(GRID)} may be left out"
            )


def _numbers(rows: Sequence[Sequence[str]], columns: Sequence[str], path: Path) -> Array:
    """Return the numbers of the rows (N, columns), checked."""
    if not 0 < len(rows) <= MOST_ROWS:
        raise BadInput(f"{path}: {len(rows)} rows of numbers; allowed are 1 to {MOST_ROWS}")
    found = np.zeros((len(rows), len(columns)))
    for i, row in enumerate(rows):
        if len(row) != len(columns):
            raise BadInput(f"{path}:{i + 2}: {len(row)} cells; {len(columns)} are required")
        for j, cell in enumerate(row):
            found[i, j] = _number(cell, columns[j], f"{path}:{i + 2}")
    return found


def _number(cell: str, column: str, label: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        raise BadInput(f"{label}: {column} = {cell!r}; a number is required") from None
    if not np.isfinite(value):
        raise BadInput(f"{label}: {column} = {cell.strip()}; a finite number is required")
    if column in VELOCITY and abs(value) > FASTEST:
        raise BadInput(
            f"{label}: {column} = {value:g} m/s; allowed is {-FASTEST:g} to {FASTEST:g} m/s"
        )
    if column == "depth_m" and value < 0.0:
        raise BadInput(f"{label}: depth_m = {value:g} m; allowed is 0 or more, positive downward")
    return value


def _check_grid(values: Array, columns: Sequence[str], axes: Sequence[Array], path: Path) -> None:
    """Raise BadInput at the first row that is not after the one before, or not on the grid."""
    expected = _first_points(axes, len(values))
    points = np.zeros((len(values), len(GRID)))
    for i, column in enumerate(GRID):
        if column in columns:
            points[:, i] = values[:, columns.index(column)]
    given = [column for column in GRID if column in columns]
    rule = (
        f"rows must be sorted by {', then '.join(given)}, with one row for every combination of "
        "their values"
    )
    if not given and len(values) > 1:
        raise BadInput(f"{path}: {len(values)} rows without {', '.join(GRID)}; one is required")
    for i in range(1, len(points)):
        if points[i].tolist() <= points[i - 1].tolist():
            found, before = _point_text(points[i], given), _point_text(points[i - 1], given)
            raise BadInput(f"{path}:{i + 2}: {found} after {before}: {rule}")
    wrong = np.flatnonzero(np.any(points != expected, axis=1))
    if len(wrong):
        i = int(wrong[0])
        found, wanted = _point_text(points[i], given), _point_text(expected[i], given)
        raise BadInput(f"{path}:{i + 2}: {found}; expected {wanted}: {rule}")
    required = prod(len(axis) for axis in axes)
    if len(points) != required:
        raise BadInput(f"{path}: {len(points)} rows; {required} are required: {rule}")


def _first_points(axes: Sequence[Array], count: int) -> Array:
    """First points (count, axes) of a grid, without those after them: a wrong one may be huge."""
    points = np.zeros((count, len(axes)))
    for i, axis in enumerate(axes):
        stride = min(prod(len(later) for later in axes[i + 1 :]), LARGE)
        points[:, i] = axis[np.arange(count) // stride % len(axis)]
    return points


def _point_text(point: Array, given: Sequence[str]) -> str:
    """Text of the coordinates of a point that a file has."""
    pairs = zip(GRID, point.tolist(), strict=True)
    return ", ".join(f"{column} = {value:g}" for column, value in pairs if column in given)
