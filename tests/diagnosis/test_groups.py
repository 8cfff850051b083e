"""Groups of recordings: what differs in one group is found there, with its size, and nothing where
nothing differs. The recordings come from an integrator that shares no code with the tool."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pushed_boat import A11, A22, A66, DAMPING, IZ, M, Missing, push, sail

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
LOAD = 1.2  # [kg] carried in the runs of one group
FORWARD = 0.3  # [m] of a point load ahead of the origin
WINDS = {"monday": (0.15, 0.0), "tuesday": (0.0, -0.2), "wednesday": (-0.12, 0.12)}  # [N] N, E
CREWS = ("crew_a", "hull_new"), ("crew_b", "hull_old")  # each crew had one of the hulls
INERTIAL = ("thrust_gain_error", "damping_error", "payload", "extra_mass", "added_mass_error")
TESTED = ("thrust_gain_error", "damping_error", "thrust_imbalance", "steady_force")


def weaker(_: float, __: Array, commands: Array) -> Array:
    return (WEAK - 1.0) * push(commands[:2], commands[2:])


def pushed_aside(_: float, __: Array, ___: Array) -> Array:
    return np.array([0.0, EASTWARD, 0.0])


def undisturbed(_: float, __: Array, ___: Array) -> Array:
    return np.zeros(3)


def blown(north: float, east: float) -> Missing:
    """A wind of one force on the hull, at half the force from ahead [N]."""

    def missing(_: float, y: Array, __: Array) -> Array:
        c, s = np.cos(y[2]), np.sin(y[2])
        return np.array([0.5 * (north * c + east * s), -north * s + east * c, 0.0])

    return missing


def laden(mass: float, x: float, inertia: float) -> Missing:
    """What moves the hull like one with a load: its mass [kg], place [m], own inertia [kg m^2]."""
    bare = np.diag([M + A11, M + A22, IZ + A66])
    point = mass * np.array([[1.0, 0.0, 0.0], [0.0, 1.0, x], [0.0, x, x * x]])
    whole = bare + point + np.diag([0.0, 0.0, inertia])

    def missing(_: float, y: Array, commands: Array) -> Array:
        u, v, r = y[3:6]
        bare_force = push(commands[:2], commands[2:]) - DAMPING * y[3:6]
        bare_force += np.array([M * v * r, -M * u * r, 0.0])
        load_force = mass * np.array([(v + x * r) * r, -u * r, -x * u * r])
        return np.asarray(bare @ np.linalg.solve(whole, bare_force + load_force) - bare_force)

    return missing


def written(folder: Path, runs: Sequence[Recording]) -> list[Path]:
    """Files of recordings, with notes that state their groups."""
    lines, files = ['vessel = "trial_boat"'], []
    for run in runs:
        files.append(folder / f"{run.name}.csv")
        write_csv(run, files[-1])
        lines.append(f"[runs.{run.name}]\ngroup = {list(run.notes.groups)}")
    (folder / "recording.toml").write_text("\n".join(lines))
    return files


def in_groups(run: Recording, *groups: str) -> Recording:
    return replace(run, notes=replace(run.notes, groups=groups))


def sailed(odd) -> list[Recording]:
    """Two runs of each of three groups; in "yellow" something else acts."""
    runs = []
    for seed, group in enumerate(("blue", "blue", "red", "red", "yellow", "yellow")):
        missing = odd if group == "yellow" else undisturbed
        run, _ = sail(f"{group}_{seed}", seed, missing)
        runs.append(replace(run, notes=replace(run.notes, groups=(group,))))
    return runs


def ranked(recordings: list[Recording], names: Sequence[str] = TESTED) -> tuple[Problem, Ranking]:
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    levels = prior_noise_levels(BOAT, recordings)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, levels, {"damping": 0.05, "thrust": 0.05})
    return problem, select_and_rank_candidates(
        problem, (*names, *problem.candidates_in_single_groups(names))
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
    files = written(tmp_path, sailed(weaker))
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


@pytest.mark.slow
def test_three_days_with_three_winds_have_none_in_common(tmp_path: Path):
    runs = []
    for day, force in WINDS.items():
        for _ in range(3):
            run, _ = sail(f"{day}_{len(runs)}", len(runs) + 1, blown(*force))
            runs.append(in_groups(run, day))
    files = written(tmp_path, runs)
    found = diagnose([f for i, f in enumerate(files) if i % 3 < 2], files[2::3])
    effects = {effect.get("group"): effect for effect in found.findings.answer["effects"]}
    assert set(effects) == set(WINDS)
    write_diagnosis(found, tmp_path / "out")
    patched = str(tmp_path / "out" / "patched.toml")
    for day, (north, east) in WINDS.items():
        force, toward = np.hypot(north, east), np.arctan2(east, north)
        assert effects[day]["name"] == f"wind@{day}"
        stated = effects[day]["parameters"]
        assert abs(stated["force_N"]["value"] - force) < 3.0 * stated["force_N"]["sd"] < 0.05
        assert abs(stated["toward_rad"]["value"] - toward) < 3.0 * stated["toward_rad"]["sd"]
        assert f"in group {day}, a steady wind" in found.findings.answer["sentence"]
        of_day = vessel.load_vessel(patched, [day]).effect("wind")
        assert of_day.force == pytest.approx(stated["force_N"]["value"])
    assert vessel.load_vessel(patched).effect("wind").force == 0.0  # of a day that was not fitted
    for mapped in found.problem.recordings:
        values = found.problem.parameter_vector(
            mapped, found.ranking.best.free, found.ranking.best.theta
        )
        [day] = mapped.groups
        at = found.problem.program.parameter_index("wind", "force")
        assert values[at] == effects[day]["parameters"]["force_N"]["value"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "x", "inertia"),
    [
        pytest.param("payload", 0.0, LOAD * IZ / M, id="distributed like the hull"),
        pytest.param("extra_mass", FORWARD, 0.0, id="at one place"),
    ],
)
def test_a_load_of_one_group_is_found_there_with_its_mass(effect: str, x: float, inertia: float):
    runs = []
    for seed, group in enumerate(("empty", "empty", "loaded", "loaded")):
        missing = laden(LOAD, x, inertia) if group == "loaded" else undisturbed
        runs.append(in_groups(sail(f"{group}_{seed}", seed, missing)[0], group))
    _, ranking = ranked(runs, INERTIAL)
    [one] = ranking.named
    assert one.name == f"{effect}@loaded" and not one.tied_with and not one.tied_groups
    mass, sd = ranking.best.value(one.name, "mass")
    assert abs(mass - LOAD) < 3.0 * sd < 0.1 * LOAD
    if effect == "extra_mass":
        place, sd = ranking.best.value(one.name, "x")
        assert abs(place - FORWARD) < 3.0 * sd < 0.1


@pytest.mark.slow
def test_groups_of_the_same_recordings_are_stated_together(tmp_path: Path):
    runs = []
    for groups in CREWS:
        missing = weaker if "hull_old" in groups else undisturbed
        for _ in range(3):
            run, _ = sail(f"{groups[1]}_{len(runs)}", len(runs), missing)
            runs.append(in_groups(run, *groups))
    files = written(tmp_path, runs)
    found = diagnose([*files[:2], *files[3:5]], [files[2], files[5]])
    [effect] = found.findings.answer["effects"]
    assert (effect["group"], effect["same_recordings"]) == ("crew_b", ["hull_old"])
    words = "in group crew_b (the same recordings as hull_old), "
    assert effect["words"].startswith(words)
    assert words in found.findings.answer["sentence"]
    write_diagnosis(found, tmp_path / "out")
    assert words[1:] in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert words[:-2] in (tmp_path / "out" / "patched.toml").read_text(encoding="utf-8")


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
    assert not any(problem.same_recordings.values())
    alike = Problem(mapped[:2], prior_noise_levels(BOAT, runs), {"thrust": 0.05})
    assert alike.groups == ("june", "may")  # both are of one build


def test_one_name_stands_for_groups_of_the_same_recordings():
    runs = []
    for seed, groups in enumerate((*CREWS, (*CREWS[1], "june"))):
        runs.append(in_groups(sail(f"run_{seed}", seed, undisturbed)[0], *groups))
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    mapped = [map_recording(run, program) for run in runs]
    problem = Problem(mapped, prior_noise_levels(BOAT, runs), {"thrust": 0.05})
    assert problem.groups == ("crew_a", "crew_b", "june")
    assert problem.same_recordings["crew_a"] == ("hull_new",)
    assert problem.same_recordings["crew_b"] == ("hull_old",)
    assert problem.same_recordings["june"] == ()


def test_a_group_with_a_sign_of_names_is_refused(tmp_path: Path):
    (tmp_path / "recording.toml").write_text('group = "a@b"\n')
    (tmp_path / "run.csv").write_text("t_s\n")
    with pytest.raises(BadInput, match="group = 'a@b'; allowed is a name without @"):
        notes_for(tmp_path / "run.csv")
