"""Groups of recordings: what differs in one group is found there, with its size, and nothing where
nothing differs. The recordings come from an integrator that shares no code with the tool."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pushed_boat import push, sail

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.loading import vessel_of_recording_file
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.pipeline import diagnose
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.groups import group_of, name_in_group, without_group
from boatsim.physics.program import Program
from boatsim.recordings.notes import notes_for
from boatsim.recordings.table import Recording, write_csv

BOAT = vessel.load_vessel("trial_boat")
WEAK = 0.8  # thrust of the odd group over that of the others
EASTWARD = 0.15  # [N] of the force that acts in one group
TESTED = ("thrust_gain_error", "damping_error", "thrust_imbalance", "steady_force")


def weaker(_: float, __: Array, commands: Array) -> Array:
    return (WEAK - 1.0) * push(commands[:2], commands[2:])


def pushed_aside(_: float, __: Array, ___: Array) -> Array:
    return np.array([0.0, EASTWARD, 0.0])


def undisturbed(_: float, __: Array, ___: Array) -> Array:
    return np.zeros(3)


def sailed(odd) -> list[Recording]:
    """Two runs of each of three groups; in "yellow" something else acts."""
    runs = []
    for seed, group in enumerate(("blue", "blue", "red", "red", "yellow", "yellow")):
        missing = odd if group == "yellow" else undisturbed
        run, _ = sail(f"{group}_{seed}", seed, missing)
        runs.append(replace(run, notes=replace(run.notes, groups=(group,))))
    return runs


def ranked(recordings: list[Recording]) -> tuple[Problem, Ranking]:
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    levels = prior_noise_levels(BOAT, recordings)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, levels, {"damping": 0.05, "thrust": 0.05})
    return problem, select_and_rank_candidates(
        problem, (*TESTED, *problem.candidates_in_single_groups(TESTED))
    )


def test_names_of_groups_are_taken_apart_as_they_were_put_together():
    name = name_in_group("wind", "monday")
    assert (without_group(name), group_of(name)) == ("wind", "monday")
    assert (without_group("wind"), group_of("wind")) == ("wind", "")


@pytest.mark.slow
def test_a_weaker_thrust_is_found_in_the_group_that_has_it_with_its_size():
    problem, ranking = ranked(sailed(weaker))
    assert [one.name for one in ranking.named] == ["thrust_gain_error@yellow"]
    value, sd = ranking.best.value("thrust_gain_error@yellow", "factor")
    assert abs(value - WEAK) < 3.0 * sd < 0.1
    assert not ranking.named[0].tied_with
    gain = problem.program.parameter_index("port", "gain")
    for mapped in problem.recordings:
        values = problem.parameter_vector(mapped, ranking.best.free, ranking.best.theta)
        assert values[gain] == pytest.approx(WEAK if "yellow" in mapped.groups else 1.0, abs=0.05)


@pytest.mark.slow
def test_a_force_that_acts_on_one_day_is_found_on_that_day():
    _, ranking = ranked(sailed(pushed_aside))
    assert [one.name for one in ranking.named] == ["steady_force@yellow"]
    value, sd = ranking.best.value("steady_force@yellow", "sway")
    assert abs(value - EASTWARD) < 3.0 * sd


def test_groups_without_a_difference_are_not_told_apart():
    problem, ranking = ranked(sailed(undisturbed))
    assert problem.groups == ("blue", "red", "yellow")
    assert ranking.named == ()


def test_what_acts_in_all_groups_is_not_called_a_difference():
    runs = []
    for seed, group in enumerate(("blue", "red", "yellow")):
        run, _ = sail(f"{group}_{seed}", seed, pushed_aside)
        runs.append(replace(run, notes=replace(run.notes, groups=(group,))))
    _, ranking = ranked(runs)
    assert [one.name for one in ranking.named] == ["steady_force"]


def test_one_group_alone_gives_no_further_candidates():
    run, _ = sail("only", 1, undisturbed)
    problem, _ = ranked([replace(run, notes=replace(run.notes, groups=("blue",)))])
    assert problem.groups == ()
    assert problem.candidates_in_single_groups(TESTED) == ()


@pytest.mark.slow
def test_the_answer_states_the_group_and_the_patched_file_has_it_as_a_load(tmp_path: Path):
    lines = ['vessel = "trial_boat"']
    files = []
    for run in sailed(weaker):
        files.append(tmp_path / f"{run.name}.csv")
        write_csv(run, files[-1])
        lines.append(f'[runs.{run.name}]\ngroup = "{run.notes.groups[0]}"')
    (tmp_path / "recording.toml").write_text("\n".join(lines))
    found = diagnose(files[:-1], files[-1:])
    [effect] = found.findings.answer["effects"]
    assert effect["group"] == "yellow"
    assert effect["words"].startswith("in group yellow, ")
    [parameter] = effect["parameters"].values()
    assert parameter["statement"].startswith("in group yellow, all thrust is 80 %")
    write_diagnosis(found, tmp_path / "out")
    patched = str(tmp_path / "out" / "patched.toml")
    assert vessel.load_vessel(patched).effect("port").gain == pytest.approx(1.0, abs=0.05)
    loaded = vessel.load_vessel(patched, ["yellow"])
    assert loaded.effect("port").gain == pytest.approx(WEAK, abs=0.05)
    assert vessel_of_recording_file(files[-1], patched, ()).load == ("yellow",)
    assert vessel_of_recording_file(files[0], patched, ()).load == ()


def test_a_run_may_belong_to_a_build_and_to_a_day():
    runs = []
    for seed, groups in enumerate((("blue", "may"), ("blue", "june"), ("red", "may"), ("red",))):
        run, _ = sail(f"run_{seed}", seed, undisturbed)
        runs.append(replace(run, notes=replace(run.notes, groups=groups)))
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    mapped = [map_recording(run, program) for run in runs]
    problem = Problem(mapped, prior_noise_levels(BOAT, runs), {"thrust": 0.05})
    assert problem.groups == ("blue", "june", "may", "red")
    assert problem.with_recordings(mapped[:1]).groups == problem.groups
    alike = Problem(mapped[:2], prior_noise_levels(BOAT, runs), {"thrust": 0.05})
    assert alike.groups == ("june", "may")  # both are of one build


def test_a_group_with_a_sign_of_names_is_refused(tmp_path: Path):
    (tmp_path / "recording.toml").write_text('group = "a@b"\n')
    (tmp_path / "run.csv").write_text("t_s\n")
    with pytest.raises(BadInput, match="group = 'a@b'; allowed is a name without @"):
        notes_for(tmp_path / "run.csv")
