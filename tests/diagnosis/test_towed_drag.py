"""Drag of something towed is named with its size and place, and not where nothing is towed."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from pushed_boat import sail
from simulated_runs import simulated

from boatsim.physics.base import Array

DRAG, STERN = 4.0, -0.6  # [N s^2/m^2], [m] of the trial boat, as large as its own drag at 0.7 m/s
PUSHED = {"thrust_N": (0.0, 20.0), "azimuth_rad": (-1.2, 1.2)}
DINGHY = {"use": "towed_drag", "drag": 8.0, "x": -0.5}


def towing(_: float, y: Array, __: Array) -> Array:
    """X, Y, N of an object on a line from the stern."""
    u, v, r = y[3:6]
    attached = np.array([u, v + STERN * r])
    X, Y = -DRAG * np.hypot(*attached) * attached
    return np.array([X, Y, STERN * Y])


def square_damping(_: float, y: Array, __: Array) -> Array:
    return -np.array([DRAG, 20.0, 1.0]) * abs(y[3:6]) * y[3:6]


def alone(_: float, __: Array, ___: Array) -> Array:
    return np.zeros(3)


def answer_for(force: Any, folder: Path, straight: bool = False) -> dict[str, Any]:
    runs = [sail(f"run_{seed}", seed, force, straight=straight)[0] for seed in (1, 2, 3)]
    return diagnosed(runs, folder, "trial_boat")


@pytest.mark.slow
def test_a_towed_dinghy_is_named_with_its_drag_and_its_place(tmp_path: Path) -> None:
    named(answer_for(towing, tmp_path), "towed_drag", {"drag_Ns2pm2": DRAG, "x_m": STERN})


@pytest.mark.slow
def test_nothing_is_named_where_nothing_is_towed(tmp_path: Path) -> None:
    nothing_missing(answer_for(alone, tmp_path))


@pytest.mark.slow
def test_quadratic_damping_of_the_hull_is_not_taken_for_a_towed_dinghy(tmp_path: Path) -> None:
    answer = answer_for(square_damping, tmp_path)
    assert [one["name"] for one in answer["effects"]] == ["quadratic_damping"]


@pytest.mark.slow
def test_straight_tracks_do_not_distinguish_a_towed_dinghy_from_damping(tmp_path: Path) -> None:
    answer = answer_for(towing, tmp_path, straight=True)
    [one] = answer["effects"]
    assert answer["verdict"] == "ambiguous"
    assert {"towed_drag", "quadratic_damping"} <= {one["name"], *one["tied_with"]}


@pytest.mark.parametrize("towed", [long(True), long(False)])
def test_on_another_vessel_it_is_named_only_where_it_is_towed(tmp_path: Path, towed: bool) -> None:
    more = [DINGHY] if towed else []
    runs = [simulated("catamaran", PUSHED, seed, more) for seed in (1, 2, 3)]
    answer = diagnosed(runs, tmp_path, "catamaran")
    entries = {one["name"]: one["parameters"] for one in answer["effects"]}
    assert ("towed_drag" in entries) == towed
    if towed:
        drag, place = (entries["towed_drag"][key] for key in ("drag_Ns2pm2", "x_m"))
        assert abs(drag["value"] - DINGHY["drag"]) < 3.5 * drag["sd"] < 2.4
        assert abs(place["value"] - DINGHY["x"]) < 3.5 * place["sd"] < 0.1
