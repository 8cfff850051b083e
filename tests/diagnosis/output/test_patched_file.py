"""A patched file gives back the boat that was fitted: nothing that it states is overwritten on
loading."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from alike import few

from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import (
    MappedRecording,
    NoiseLevels,
    dof_in_state_order,
    rigid_body_values,
)
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.errors import BadInput
from boatsim.physics import content, vessel
from boatsim.physics.base import Array, CoefficientRelease
from boatsim.physics.content import load_class
from boatsim.physics.effects.linear_hull import LinearHull
from boatsim.physics.kernel.records import Inputs, VesselNumbers
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel

ROWS, ROW = 61, 0.1  # 6 s
OFF = 0.1  # relative, of every coefficient that a diagnosis recalibrates


def problem_of(boat: Vessel) -> Problem:
    """A made-up run of a vessel, to fit nothing with: commands in steps, no measurements."""
    releases = tuple(
        e for e in diagnosis_program(boat)[0].candidates if isinstance(e, CoefficientRelease)
    )
    program = Program(boat, releases)  # a law that does not act would only be compiled for nothing
    rng = np.random.default_rng(7)
    low, high = (np.array([getattr(c, a) for c in boat.commands.values()]) for a in ("low", "high"))
    commands = np.zeros((ROWS, 1))
    if boat.commands:
        steps = rng.uniform(0.25, 0.75, (ROWS // 10 + 1, len(low)))
        commands = np.repeat(low + steps * (high - low), 10, axis=0)[:ROWS]
    nq = len(dof_in_state_order(boat))
    measured, scale = np.full((ROWS, 1), np.nan), {"heading_sd_rad": 1.0}
    track = MappedRecording(
        "made_up",
        program,
        ROW * np.arange(ROWS),
        measured,
        ("heading_sd_rad",),
        ("psi_rad",),
        np.array([nq - 1]),
        np.ascontiguousarray(commands),
        np.append(program.values(), program.body),
        scale,
    )
    levels = NoiseLevels(np.ones(nq), 1.0, {"heading_sd_rad": 0.01})
    return Problem([track], levels, {"damping": OFF, "thrust": OFF, "restoring": OFF})


def free_run(problem: Problem, values: Array, acting: tuple[str, ...]) -> Array:
    """Channels of a free run from a slow, turning, heeled start, (ROWS, 2 NQ)."""
    track, nq = problem.recordings[0], problem.program.module.NQ
    out, start = np.full((1, ROWS, 2 * nq), np.nan), np.zeros((1, 2 * nq))
    start[0, nq - 1 :] = 0.02
    start[0, nq] = getattr(problem.program.vessel.effect("speed_hold"), "speed", 0.5)
    problem.program.estimation_functions.simulate_intervals(
        Inputs(track.times, track.command_times, track.command_values),
        DEFAULT.filter.free_run_step,
        VesselNumbers(rigid_body_values(values), values, problem.program.effect_switches(acting)),
        np.array([0]),
        np.array([ROWS - 1]),
        start,
        out,
    )
    return out[0]


def recalibrated(problem: Problem, by: float) -> Fit:
    """Every coefficient that may be off, off by about so much, and differently."""
    nominal = problem.nominal_hypothesis()
    return replace(
        nominal,
        theta=1.0
        + by * np.linspace(0.5, 1.5, len(nominal.free)) * (-1.0) ** np.arange(len(nominal.free)),
    )


@pytest.mark.parametrize("name", few(content.shipped_content_names("vessel"), 1, 3))
def test_replay_of_the_patched_file_is_the_free_run_in_memory(name: str, tmp_path: Path) -> None:
    boat = vessel.load_vessel(name)
    problem = problem_of(boat)
    found = recalibrated(problem, OFF)
    fitted = free_run(
        problem, problem.parameter_vector(problem.recordings[0], found.free, found.theta), ()
    )
    patched_vessel.write_patched_vessel(problem, boat, found, tmp_path / "patched.toml")
    again = problem_of(vessel.load_vessel(str(tmp_path / "patched.toml")))
    replayed = free_run(again, again.recordings[0].values, ())
    assert np.isfinite(fitted).all()
    np.testing.assert_allclose(replayed, fitted, rtol=1e-7, atol=1e-7)
    if found.free:
        assert (
            np.abs(fitted - free_run(problem, problem.recordings[0].values, ())).max() > 1e-5
        )  # something was patched


def test_a_patched_file_states_what_a_rule_would_fill_in_otherwise(tmp_path: Path) -> None:
    boat = vessel.load_vessel("eastward_ho", ["condition_1"])
    problem = problem_of(boat)
    found = recalibrated(problem, OFF)
    patched_vessel.write_patched_vessel(problem, boat, found, tmp_path / "patched.toml")
    again = vessel.load_vessel(str(tmp_path / "patched.toml"), ["condition_1"])
    fitted = problem.parameter_vector(problem.recordings[0], found.free, found.theta)
    np.testing.assert_allclose(
        Program(again).values(), fitted[: len(Program(again).values())], rtol=1e-9
    )


def test_a_patched_boat_has_the_program_of_its_diagnosis_and_is_not_compiled_anew(
    tmp_path: Path,
) -> None:
    boat = vessel.load_vessel("trial_boat")
    problem = problem_of(boat)
    patched_vessel.write_patched_vessel(
        problem, boat, recalibrated(problem, OFF), tmp_path / "patched.toml"
    )
    again = vessel.load_vessel(str(tmp_path / "patched.toml"))
    assert again.name != boat.name
    assert (
        diagnosis_program(again)[0].composition.source_text()
        == diagnosis_program(boat)[0].composition.source_text()
    )


def test_what_is_stated_wins_and_zero_is_a_value() -> None:
    boat = vessel.load_vessel("eastward_ho", ["condition_1"])
    own = LinearHull(speed=4.0).with_all_parameters(boat)
    stated = LinearHull(speed=4.0, sway=0.0, yaw=7.0).with_all_parameters(boat)
    assert (stated.sway, stated.yaw) == (0.0, 7.0)
    assert stated.yaw_by_sway == own.yaw_by_sway != 0.0
    assert (
        load_class("effect", "cross_flow_drag")(length=0.0).with_all_parameters(boat).length == 0.0
    )
    with pytest.raises(BadInput, match="LinearHull.sway = nan"):
        LinearHull.from_settings({"sway": float("nan")})


def test_a_folder_with_vessel_and_patched_file_can_move(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    shutil.copytree(content.find_content_file("vessel", "trial_boat").parent, here / "boat")
    (here / "out").mkdir()
    boat = vessel.load_vessel(str(here / "boat" / "vessel.toml"))
    problem = problem_of(boat)
    patched_vessel.write_patched_vessel(
        problem, boat, recalibrated(problem, OFF), here / "out" / "patched.toml"
    )
    here.rename(there)
    moved = vessel.load_vessel(str(there / "out" / "patched.toml"))
    assert moved.path == (there / "boat").resolve()
    assert (moved.path / moved.hull).is_file()


def test_a_patched_patch_still_finds_the_hull(tmp_path: Path) -> None:
    boat = vessel.load_vessel("trial_boat")
    for _ in range(2):
        problem = problem_of(boat)
        patched_vessel.write_patched_vessel(
            problem, boat, recalibrated(problem, OFF), tmp_path / "patched.toml"
        )
        boat = vessel.load_vessel(str(tmp_path / "patched.toml"))
        assert boat.path == content.find_content_file("vessel", "trial_boat").parent


RELEASED = {
    "trial_boat": {
        "damping_error": [1.4, 0.7, 1.2],
        "thrust_gain_error": [0.8],
        "lateral_centre_shift": [0.1],
    },
    "catamaran": {
        "payload": [2.0],
        "added_mass_error": [1.3, 1.2, 0.8],
        "added_mass_coriolis": [-0.4],
    },
    "eastward_ho": {
        "metacentric_height_error": [1.3],
        "righting_arm_stiffening": [-1.0],
        "rudder_stall": [0.05],
    },
}


@pytest.mark.parametrize("name", RELEASED)
def test_a_release_is_written_as_the_coefficients_it_found_to_be_off(
    name: str, tmp_path: Path
) -> None:
    boat = vessel.load_vessel(name)
    problem = problem_of(boat)
    found = recalibrated(problem, 0.5 * OFF)
    free = problem.free_parameters(tuple(RELEASED[name]))
    off = [x for values in RELEASED[name].values() for x in values]
    covariance = 1e-4 * np.eye(len(free))
    found = Fit(
        tuple(RELEASED[name]),
        free,
        np.append(found.theta, off),
        covariance,
        found.levels,
        found.evidence,
    )
    assert len(free) == len(found.theta)
    fitted = free_run(
        problem, problem.parameter_vector(problem.recordings[0], free, found.theta), found.effects
    )
    patched_vessel.write_patched_vessel(problem, boat, found, tmp_path / "patched.toml")
    patched = vessel.load_vessel(str(tmp_path / "patched.toml"))
    assert [e.name for e in patched.effects] == [e.name for e in boat.effects]  # no further law
    again = problem_of(patched)
    np.testing.assert_allclose(
        free_run(again, again.recordings[0].values, ()), fitted, rtol=1e-7, atol=1e-7
    )
    text = (tmp_path / "patched.toml").read_text()
    assert all(f"{entry}, " in text for entry in RELEASED[name])


def test_a_patched_file_says_how_far_off_its_numbers_may_be_and_the_next_one_says_it_anew(
    tmp_path: Path,
) -> None:
    boat = vessel.load_vessel("trial_boat")
    problem = problem_of(boat)
    free = problem.free_parameters(("thrust_gain_error",))
    theta = np.array([1.05] * len(free))
    sd = 0.01 * np.arange(1.0, len(free) + 1.0)
    covariance = np.outer(sd, sd) * np.where(np.eye(len(free)), 1.0, 0.3)
    found = Fit(("thrust_gain_error",), free, theta, covariance, problem.ambient, 0.0)
    patched_vessel.write_patched_vessel(problem, boat, found, tmp_path / "patched.toml")
    told = vessel.load_vessel(str(tmp_path / "patched.toml")).spread
    assert told is not None and boat.spread is None
    by_name = {one.fitted: one for one in told.of}
    surge, gain = by_name["linear_damping.surge"], by_name["thrust_gain_error.factor"]
    assert surge.scales == ["linear_damping.surge"] and surge.sd == pytest.approx(
        0.01 / 1.05, rel=1e-5
    )
    assert gain.scales == ["port.gain", "starboard.gain"]
    assert told.root @ told.root.T == pytest.approx(np.where(np.eye(len(free)), 1.0, 0.3), abs=1e-5)
    again = vessel.load_vessel(str(tmp_path / "patched.toml"))
    patched_vessel.write_patched_vessel(
        problem_of(again), again, problem_of(again).nominal_hypothesis(), tmp_path / "again.toml"
    )
    assert (
        vessel.load_vessel(str(tmp_path / "again.toml")).spread is None
    )  # nothing of it was fitted there


def test_a_release_costs_nothing_to_compile_and_acts_in_a_file() -> None:
    boat = vessel.load_vessel("trial_boat")
    program = Program(boat, (load_class("effect", "damping_error")().with_all_parameters(boat),))
    assert program.effects == boat.effects and program.module is Program(boat).module
    table = {"use": "damping_error", "sway_factor": 0.5}
    off, own = (
        vessel.load_vessel("trial_boat", extra=[table]).effect("linear_damping"),
        boat.effect("linear_damping"),
    )
    assert off == replace(own, sway=0.5 * own.sway)  # type: ignore[attr-defined, call-arg, type-var]
