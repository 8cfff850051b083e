"""Tables of currents: what is read, the mean over a depth, values in between, and refusals."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import RegularGridInterpolator

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.current_file import mean_weights, read_current
from boatsim.physics.current_grid import (
    EMPTY,
    current_grid,
    grid_change,
    grid_displacement,
    grid_velocity,
    mean_path,
)

FIRST = np.int64(0)
TABLE = Path(__file__).parents[1] / "data" / "current.csv"


def written(folder: Path, text: str) -> Path:
    path = folder / "tide.csv"
    path.write_text(text, encoding="utf-8")
    return path


def random_points(seed: int, count: int = 40) -> Array:
    """Times and places inside the table of the tests."""
    return np.random.default_rng(seed).uniform([0, -20, -10], [30, 20, 30], (count, 3))


def test_values_in_between_are_linear_in_time_and_place() -> None:
    found = read_current(TABLE)
    numbers = np.array(current_grid(found, 0.3))
    grid = RegularGridInterpolator(
        (found.time, found.north, found.east), found.mean_over_draught(0.3)
    )
    for t, x, y in random_points(0):
        expected = grid([[t, x, y]])[0]
        assert grid_velocity(t, x, y, numbers, FIRST) == pytest.approx(expected, abs=1e-12)


def test_outside_the_table_the_velocity_is_that_of_its_edge_and_does_not_change() -> None:
    numbers = np.array(current_grid(read_current(TABLE), 0.3))
    corner = grid_velocity(0.0, 20.0, -10.0, numbers, FIRST)
    assert grid_velocity(-1e6, 1e4, -10.01, numbers, FIRST) == pytest.approx(corner)
    assert grid_change(-1e6, 1e4, -10.01, numbers, FIRST) == (0.0,) * 6
    last = grid_velocity(30.0, 5.0, 2.0, numbers, FIRST)
    assert grid_velocity(99.0, 5.0, 2.0, numbers, FIRST) == pytest.approx(last)
    change = grid_change(99.0, 5.0, 2.0, numbers, FIRST)
    assert change[0] == change[3] == 0.0 and change[1] != 0.0


def test_the_change_is_the_derivative_of_the_velocity() -> None:
    numbers = np.array(current_grid(read_current(TABLE), 0.3))
    step = 1e-6
    for t, x, y in random_points(1):
        change = np.array(grid_change(t, x, y, numbers, FIRST)).reshape(2, 3)
        for i, (dt, dx, dy) in enumerate(step * np.eye(3)):
            ahead = grid_velocity(t + dt, x + dx, y + dy, numbers, FIRST)
            behind = grid_velocity(t - dt, x - dx, y - dy, numbers, FIRST)
            slope = (np.array(ahead) - behind) / (2 * step)
            assert change[:, i] == pytest.approx(slope, abs=1e-7)


def test_at_a_point_of_the_table_the_change_is_that_after_it(tmp_path: Path) -> None:
    path = written(tmp_path, "t_s,north_mps,east_mps\n0,0.0,0\n2,0.4,0\n3,0.3,0\n")
    numbers = np.array(current_grid(read_current(path), 0.0))
    rates = [grid_change(t, 0.0, 0.0, numbers, FIRST)[0] for t in (0.0, 1.0, 2.0, 3.0)]
    assert rates == pytest.approx([0.2, 0.2, -0.1, 0.0])


def test_the_mean_over_the_draught_is_that_of_straight_lines_between_the_depths() -> None:
    depths = np.array([0.2, 0.5, 1.5])
    values = np.array([0.3, 0.8, -0.4])
    for draught in (0.1, 0.2, 0.3, 0.5, 1.1, 1.5, 4.0):
        inside = depths[depths < draught]
        area, _ = quad(lambda z: np.interp(z, depths, values), 0.0, draught, points=inside)
        assert mean_weights(depths, draught) @ values == pytest.approx(area / draught)
        assert mean_weights(depths, draught).sum() == pytest.approx(1.0)
    assert mean_weights(np.array([0.0, 1.0]), 0.6) == pytest.approx([0.7, 0.3])  # a + b T / 2
    assert mean_weights(depths, 0.0) == pytest.approx([1.0, 0.0, 0.0])


def test_water_moves_by_the_integral_of_the_mean_velocity_over_the_area() -> None:
    found = read_current(TABLE)
    numbers, path = np.array(current_grid(found, 0.3)), mean_path(found, 0.3, 4.0)
    velocity = found.mean_over_draught(0.3)
    # the area is uneven: 10 m to port of y = 0, 30 m to starboard of it
    along = velocity.mean(axis=1)
    mean = (10.0 * (along[:, 0] + along[:, 1]) + 30.0 * (along[:, 1] + along[:, 2])) / 80.0
    for t in (-3.0, 0.0, 2.5, 17.0, 26.0, 50.0):
        moved = np.array(grid_displacement(t + 4.0, numbers, FIRST))
        moved -= grid_displacement(4.0, numbers, FIRST)
        fine = np.linspace(0.0, t, 20001)
        for c in range(2):
            speed = np.interp(fine + 4.0, found.time, mean[:, c])
            assert moved[c] == pytest.approx(np.trapezoid(speed, fine), abs=1e-6)
            assert path.displacement(t)[c] == pytest.approx(moved[c], abs=1e-12)
    assert path.displacement(np.array([1.0, 2.0]))[0].shape == (2,)


def test_water_without_a_table_is_at_rest() -> None:
    numbers = np.array(EMPTY)
    assert grid_velocity(1.0, 2.0, 3.0, numbers, FIRST) == (0.0, 0.0)
    assert grid_displacement(5.0, numbers, FIRST) == (0.0, 0.0)


def test_columns_may_be_left_out_and_stand_in_any_order(tmp_path: Path) -> None:
    path = written(tmp_path, "\ufeffeast_mps, y_m,north_mps\n0.1,-5,0.3\n0.2,5,0.4\n")
    found = read_current(path)
    assert found.velocity.shape == (1, 1, 2, 1, 2)
    assert found.east.tolist() == [-5.0, 5.0]
    assert found.velocity[0, 0, :, 0].tolist() == [[0.3, 0.1], [0.4, 0.2]]


def test_a_changed_file_is_read_again(tmp_path: Path) -> None:
    path = written(tmp_path, "north_mps,east_mps\n0.1,0.2\n")
    assert read_current(path) is read_current(path)
    path.write_text("north_mps,east_mps\n0.30,0.2\n")
    path.touch()
    assert read_current(path).velocity[0, 0, 0, 0, 0] == 0.3


HEAD = "t_s,north_mps,east_mps\n"
PLACES = "x_m,y_m,north_mps,east_mps\n"
REFUSED = {
    "empty": ("", "no column north_mps"),
    "no rows": (HEAD, "0 rows of numbers; allowed are 1 to"),
    "wrong column": ("time_s,north_mps,east_mps\n0,0,0\n", "column.*time_s.*t_s"),
    "misspelt": ("t_s,north_mp,east_mps\n0,0,0\n", "north_mp.*did you mean 'north_mps'"),
    "missing": ("t_s,north_mps\n0,0\n", "no column east_mps"),
    "twice": ("t_s,t_s,north_mps,east_mps\n0,0,0,0\n", "column t_s appears twice"),
    "short row": (HEAD + "0,0.1\n", ":2: 2 cells; 3 are required"),
    "text": (HEAD + "0,fast,0\n", ":2: north_mps = 'fast'; a number is required"),
    "empty cell": (HEAD + "0,,0\n", ":2: north_mps = ''; a number is required"),
    "nan": (HEAD + "0,0,0\n1,nan,0\n", ":3: north_mps = nan; a finite number is required"),
    "infinite": (HEAD + "inf,0,0\n", ":2: t_s = inf; a finite number"),
    "centimetres": (HEAD + "0,35,0\n", ":2: north_mps = 35 m/s; allowed is -20 to 20 m/s"),
    "above water": ("depth_m,north_mps,east_mps\n-1,0,0\n", "depth_m = -1 m; allowed is 0 or more"),
    "unsorted": (
        HEAD + "0,0,0\n2,0,0\n1,0,0\n",
        ":4: t_s = 1 after t_s = 2: rows must be sorted by",
    ),
    "repeated": (HEAD + "0,0,0\n0,0,0\n", ":3: t_s = 0 after t_s = 0: .*one row for every"),
    "hole": (PLACES + "0,0,0,0\n0,1,0,0\n1,1,0,0\n", ":4: x_m = 1, y_m = 1; expected x_m = 1, y_m"),
    "end": (PLACES + "0,0,0,0\n0,1,0,0\n1,0,0,0\n", "3 rows; 4 are required"),
    "two velocities": ("north_mps,east_mps\n0,0\n1,1\n", "2 rows without t_s, x_m, y_m, depth_m"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_table_that_cannot_be_used_is_refused_in_one_line(name: str, tmp_path: Path) -> None:
    text, message = REFUSED[name]
    with pytest.raises(BadInput, match=message) as refused:
        read_current(written(tmp_path, text))
    assert "\n" not in str(refused.value) and "tide.csv" in str(refused.value)


def test_a_missing_file_and_a_binary_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="none.csv: no such file; a table of a current is a CSV"):
        read_current(tmp_path / "none.csv")
    (tmp_path / "tide.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(BadInput, match="no CSV file in UTF-8"):
        read_current(tmp_path / "tide.csv")


def test_a_track_is_no_grid_however_long_it_is(tmp_path: Path) -> None:
    rows = "".join(f"{t},{2 * t},{3 * t},{t},0,0\n" for t in range(5_000))
    with pytest.raises(BadInput, match=":3: t_s = 1, .* expected t_s = 0, x_m = 0, y_m = 0, depth"):
        read_current(written(tmp_path, "t_s,x_m,y_m,depth_m,north_mps,east_mps\n" + rows))


def test_a_table_with_too_many_points_is_refused(tmp_path: Path) -> None:
    rows = "".join(f"{t},0,0\n" for t in range(20_001))
    with pytest.raises(BadInput, match="20001 points of time and place; allowed are at most 20000"):
        read_current(written(tmp_path, HEAD + rows))
