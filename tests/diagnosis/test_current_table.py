"""A diagnosis finds how strong the current of a table was in a recording."""

from dataclasses import replace
from pathlib import Path

import answers
import boats
import numpy as np
import pytest

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline, select_effects
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.open_water import OpenWater

PLAIN = boats.PLANAR.replace('[[effect]]\nuse = "current"\n', "")
SECONDS, RATE = 80.0, 5.0  # [s], [Hz]
# A stream that turns within the recording and is stronger to starboard; it depends on all three
TIDE = "t_s,x_m,y_m,north_mps,east_mps\n" + "".join(
    f"{t},{x},{y},{0.12 * side * (1.0 + 0.02 * y)},{-0.08 * side + 0.002 * x}\n"
    for t, side in ((100.0, 1.0), (140.0, -1.0), (180.0, 0.5))
    for x in (-20.0, 20.0)
    for y in (-20.0, 20.0)
)
TABLE = '\n[[effect]]\nuse = "current_table"\nfile = "tide.csv"\nstart = 100.0\n'
REQUESTED = '\n[diagnosis]\nalso = [{ use = "current_table", file = "tide.csv", start = 100.0 }]\n'


def vessel_in(folder: Path, text: str) -> Vessel:
    """Vessel with the table of the tide next to its file."""
    place = boats.written(folder, "tidal", PLAIN + text)
    (place / "tide.csv").write_text(TIDE)
    return load_vessel(str(place))


def sailed(vessel: Vessel, seed: int, scale: float, name: str) -> Recording:
    """Recording of a boat in a stream that is `scale` times that of its table."""
    table = {"use": "current_table", "file": str(vessel.path / "tide.csv"), "start": 100.0}
    own = [effect for effect in vessel.effects if effect.name != "current_table"]
    true = replace(vessel, effects=tuple(own)).with_effect(table | {"scale": scale})
    rng, engine, rows = np.random.default_rng(seed), OpenWater(true, step=0.02), []
    count = round(SECONDS * RATE)
    thrusts = np.repeat(rng.uniform(-0.5, 2.0, (count // 20, 2)), 20, axis=0)
    for port, starboard in thrusts:
        state = engine.state
        rows.append([state.x, state.y, state.psi])
        engine.command({"thrust_port_N": port, "thrust_starboard_N": starboard})
        engine.advance(round(1.0 / RATE / engine.step))
    seen = np.array(rows) + rng.standard_normal((count, 3)) * [0.005, 0.005, 0.005]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    signals |= {"thrust_port_N": thrusts[:, 0], "thrust_starboard_N": thrusts[:, 1]}
    signals |= {"steer_port_rad": np.zeros(count), "steer_starboard_rad": np.zeros(count)}
    return Recording(name, np.arange(count) / RATE, signals, Notes(vessel=str(vessel.path)))


def problem_of(vessel: Vessel, recording: Recording, uncertainty: dict[str, float]) -> Problem:
    program = Program(vessel, candidate_library(vessel).compiled_effects)
    return Problem(
        [map_recording(recording, program)],
        prior_noise_levels(vessel, [recording]),
        uncertainty,
    )


def test_the_scale_of_the_table_of_a_vessel_is_a_coefficient_of_it(tmp_path: Path) -> None:
    vessel = vessel_in(tmp_path, TABLE)
    assert "current" in priors.coefficient_uncertainty(vessel)
    problem = problem_of(vessel, sailed(vessel, 1, 0.6, "run"), {"damping": 0.1, "current": 0.5})
    refitted = fit_baseline(problem)[1]
    value, sd = refitted.value("", "scale")
    assert abs(value - 0.6) < 3.5 * sd and sd < 0.05


@pytest.mark.parametrize("scale", [0.6, 0.0])
def test_a_table_that_a_vessel_proposes_is_a_candidate(scale: float, tmp_path: Path) -> None:
    vessel = vessel_in(tmp_path, REQUESTED)
    recording = sailed(vessel, 2, scale, "run")
    problem = problem_of(vessel, recording, {"damping": 0.05, "thrust": 0.05})
    chosen = select_effects(problem, ("current", "current_table", "wind", "steady_force"))[1]
    if scale == 0.0:
        assert "current_table" not in chosen.effects
        return
    assert chosen.effects == ("current_table",)
    value, sd = chosen.value("current_table", "scale")
    assert abs(value - scale) < 3.5 * sd and sd < 0.05


def test_a_vessel_without_a_table_has_no_candidate_of_one() -> None:
    library = candidate_library(load_vessel("trial_boat"))
    assert "current_table" not in library.tested_names
    assert "current_table" not in library.excluded
    assert "needs file = a CSV file" in library.inapplicable["current_table"]


@pytest.mark.slow
def test_a_whole_diagnosis_names_the_table_and_its_scale(tmp_path: Path) -> None:
    vessel = vessel_in(tmp_path, REQUESTED)
    runs = [sailed(vessel, seed, 0.6, f"run_{seed}") for seed in (3, 4, 5)]
    answer = answers.diagnosed(runs, tmp_path, str(vessel.path))
    answers.named(answer, "current_table", {"scale": 0.6})
