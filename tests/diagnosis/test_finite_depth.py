"""Water of a known depth: the increase of added mass and damping is named, and not in deep water."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from alike import long, slow
from answers import diagnosed, named, nothing_missing
from simulated_runs import simulated

COMMANDS: dict[str, Mapping[str, tuple[float, float]]] = {
    "trial_boat": {
        "thrust_port_N": (-0.9, 0.9),
        "thrust_starboard_N": (-0.9, 0.9),
        "steer_port_rad": (-0.6, 0.6),
        "steer_starboard_rad": (-0.6, 0.6),
    },
    "catamaran": {"thrust_N": (0.0, 20.0), "azimuth_rad": (-1.2, 1.2)},
}
DEPTH = {"trial_boat": 0.09, "catamaran": 0.06}  # [m] 1.3 draughts


def answer_for(boat: str, folder: Path, effects: list[dict[str, Any]]) -> dict[str, Any]:
    """The diagnosis of runs with these effects, where the depth is stated."""
    runs = [simulated(boat, COMMANDS[boat], seed, effects) for seed in (1, 2, 3)]
    (folder / "recording.toml").write_text(f"[facts]\nwater_depth_m = {DEPTH[boat]}\n")
    return diagnosed(runs, folder, boat)


@pytest.mark.parametrize("boat", [slow("trial_boat"), long("catamaran")])
def test_shallow_water_is_named_with_the_increase_of_theory(tmp_path: Path, boat: str) -> None:
    answer = answer_for(boat, tmp_path, [{"use": "finite_depth", "depth": DEPTH[boat]}])
    named(answer, "finite_depth", {"share": 1.0})


@pytest.mark.slow
def test_nothing_is_named_where_the_bottom_has_no_influence(tmp_path: Path) -> None:
    answer = answer_for("trial_boat", tmp_path, [])
    assert "finite_depth" in answer["tried"]
    nothing_missing(answer)


@pytest.mark.slow
def test_added_mass_in_sway_alone_is_not_taken_for_shallow_water(tmp_path: Path) -> None:
    wrong = {"use": "added_mass_error", "sway_factor": 1.6}
    answer = answer_for("trial_boat", tmp_path, [wrong])
    assert [one["name"] for one in answer["effects"]] == ["added_mass_error"]
