"""Boatsim for Python: examples run as written, types are told, and all that a user imports stays
light and in place."""

import doctest
import inspect
import json
import pydoc
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import boatsim
from boatsim import api
from boatsim.cli import diagnosis
from boatsim.errors import BadInput
from boatsim.physics import content
from boatsim.physics.effects.current import Current

OFFERED = (
    *("diagnose", "export", "linearise", "load_scenario", "load_vessel", "read", "replay", "run"),
    *("sweep", "wave_field"),
)
NOUNS = (
    "Batch",
    "Diagnosis",
    "Fleet",
    "LinearModel",
    "Recording",
    "Run",
    "Scenario",
    "Sweep",
    "Vessel",
    "WaveField",
)
ROOT = Path(__file__).parents[1]
USER = """
from typing import reveal_type
import boatsim
import boatsim.diagnosis.pipeline

done: boatsim.Run = boatsim.run("joystick_boat/sway_1", seed=3)
found: boatsim.Diagnosis = boatsim.diagnose(["a.csv"], hold_out=["b.csv"])
value, sd = found.parameters["weak_reverse"]["astern_factor"]
reveal_type(boatsim.load_vessel("otter"))
reveal_type(boatsim.replay("a.csv").t)
reveal_type(value)
reveal_type(found)
"""


@pytest.mark.parametrize("name", [*OFFERED, "Vessel"])
def test_the_example_of_each_function_runs_as_it_is_written(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (test,) = doctest.DocTestFinder(recurse=False).find(getattr(api, name), name, api)
    assert test.examples
    result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test)
    assert result.failed == 0


@pytest.mark.parametrize(
    "first", ["", "import boatsim.diagnosis.priors", "from boatsim import diagnose"]
)
def test_the_functions_are_there_whatever_was_imported_before(first: str) -> None:
    code = f"import boatsim\n{first}\nprint(*(callable(getattr(boatsim, n)) for n in {OFFERED}))"
    said = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert said.split() == ["True"] * len(OFFERED)


def test_a_diagnosis_is_asked_for_by_the_name_of_its_folder_too(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="nowhere.csv"):
        boatsim.diagnose(tmp_path / "nowhere.csv", vessel="joystick_boat")


def test_one_name_is_as_good_as_a_sequence_of_it(tmp_path: Path) -> None:
    assert boatsim.load_vessel("joystick_boat", "heavy") == boatsim.load_vessel(
        "joystick_boat", ("heavy",)
    )
    log = tmp_path / "out" / "camera.csv"
    boatsim.run("joystick_boat/sway_1", out=log.parent)
    with pytest.raises(BadInput, match="load 'heav' does not exist"):
        boatsim.read(log, vessel="joystick_boat", load="heav")
    with pytest.raises(BadInput, match="load 'heav' does not exist"):
        boatsim.replay(log, load="heav")
    for option in ("load", "library", "without"):
        for given in ("nothing_such", Path("nothing_such")):
            with pytest.raises(BadInput, match="'nothing_such'"):
                boatsim.diagnose(log, **{option: given})


def test_replay_is_the_file_of_the_command_with_each_time_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    boatsim.run("joystick_boat/sway_1", out=tmp_path)
    assert diagnosis.replay(tmp_path / "camera.csv", None, [], 6.0, tmp_path) == 0, (
        capsys.readouterr().err
    )
    header, *lines = (tmp_path / "replay.csv").read_text().splitlines()
    written = np.array([[float(cell) for cell in line.split(",")] for line in lines])
    assert header == "t_s,segment,x_m,y_m,psi_rad"
    shared = np.append(False, np.diff(written[:, 0]) == 0.0)
    assert shared.sum() == written[-1, 1] > 0  # each run but the first begins where one ends
    told = boatsim.replay(tmp_path / "camera.csv")
    assert np.allclose(
        np.column_stack([told.t, *(told[n] for n in header.split(",")[1:])]),
        written[~shared],
        atol=1e-8,
    )


@pytest.mark.slow
def test_a_strict_type_checker_knows_what_comes_back(tmp_path: Path) -> None:
    (tmp_path / "user.py").write_text(USER)
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--cache-dir",
        str(tmp_path / "cache"),
        str(tmp_path / "user.py"),
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    for told in (
        "boatsim.physics.vessel.model.Vessel",
        "ndarray",
        '"float"',
        "boatsim.api.Diagnosis",
    ):
        assert told in done.stdout.replace("builtins.", "")


def test_a_run_with_files_says_the_same_as_one_without(tmp_path: Path) -> None:
    kept, free = (
        boatsim.run("joystick_boat/sway_1", seed=2, out=out) for out in (tmp_path / "out", None)
    )
    assert kept.metrics == free.metrics and kept.seed == free.seed == 2 and free.folder is None
    assert set(kept.metrics) == set(
        json.loads((tmp_path / "out" / "norms.json").read_text())["norms"]
    )
    assert kept.camera is not None and free.camera is not None
    for mine, other in ((kept.recording, free.recording), (kept.camera, free.camera)):
        assert mine.signals.keys() == other.signals.keys() and (mine.t == other.t).all()
        for name, values in mine.signals.items():
            np.testing.assert_array_equal(values, other.signals[name], err_msg=name)


def test_a_run_of_five_rows_with_files_comes_back(tmp_path: Path) -> None:
    text = """vessel = "joystick_boat"
duration = 0.08
controller = { use = "open_loop", period = 0.02 }
"""
    (tmp_path / "short.toml").write_text(text)
    done = boatsim.run(tmp_path / "short.toml", out=tmp_path / "out")
    assert len(done.recording) == 5 and done.complete
    assert done.camera is not None and len(done.camera) == 1
    assert (tmp_path / "out" / "recording.csv").read_text().count("\n") == 6


def test_another_controller_steers(tmp_path: Path) -> None:
    own, other = (
        boatsim.run("joystick_boat/sway_1", controller=c) for c in (None, "pid_autopilot")
    )
    assert own.metrics["yaw_rate_rms"].value != other.metrics["yaw_rate_rms"].value
    with pytest.raises(BadInput, match="controller pd_heading does not fit"):
        boatsim.run("joystick_boat/sway_1", controller="pd_heading")


def test_what_is_not_offered_is_an_attribute_error_and_what_is_is_listed() -> None:
    assert set(OFFERED) <= set(dir(boatsim)) and set(OFFERED) <= set(boatsim.__all__)
    with pytest.raises(AttributeError, match="nothing_such"):
        boatsim.nothing_such  # noqa: B018


def test_the_interface_is_documented_and_has_real_signatures() -> None:
    assert set(dir(boatsim)) == {*OFFERED, *NOUNS, "Body", "CommandChannel", "Parameter"} | {
        "__version__"
    }
    for name in (*OFFERED, *NOUNS):
        assert inspect.getdoc(getattr(boatsim, name)), name
    for name in OFFERED:
        assert "given" not in inspect.signature(getattr(boatsim, name)).parameters
    assert "settings" in inspect.signature(boatsim.diagnose).parameters
    assert "hold_out" in pydoc.render_doc(boatsim.diagnose)


EFFECTS = [
    {"use": "added_mass", "surge": 10.0, "sway": 90.0, "yaw": 15.0},
    {"use": "linear_damping", "surge": 12.0, "sway": 60.0, "yaw": 30.0},
    {"use": "thruster", "x": -1.0, "on": {"thrust": "thrust_N", "angle": "angle_rad"}},
]


def barge(**more: Any) -> boatsim.Vessel:
    given: dict[str, Any] = {
        "name": "barge",
        "dof": ("surge", "sway", "yaw"),
        "length": 2.0,
        "beam": 0.8,
        "draught": 0.2,
        "body": boatsim.Body(mass=120.0, roll_inertia=8.0, yaw_inertia=40.0),
        "channels": {
            "thrust_N": boatsim.CommandChannel(low=-50.0, high=50.0),
            "angle_rad": {"low": -0.6, "high": 0.6},
        },
        "effects": EFFECTS,
    }
    return boatsim.Vessel.from_effects(**(given | more))


def test_a_vessel_without_a_file_is_run_saved_and_run_again(tmp_path: Path) -> None:
    settings: dict[str, Any] = {
        "duration": 3.0,
        "controller": {"use": "open_loop"},
        "goal": [{"thrust_N": 20.0, "angle_rad": 0.1}],
    }
    scenario = boatsim.Scenario.from_settings(vessel=barge(), name="ahead", **settings)
    first = boatsim.run(scenario)
    assert first.scenario == "ahead" and first.recording["x_m"][-1] > 0.1
    saved = barge().save(tmp_path / "barge")
    again = boatsim.run(boatsim.Scenario.from_settings(vessel=saved, **settings))
    assert np.array_equal(first.recording["x_m"], again.recording["x_m"])
    assert boatsim.load_vessel(saved.file) == saved


def test_a_vessel_takes_the_place_of_that_of_a_scenario(tmp_path: Path) -> None:
    heavy = boatsim.load_vessel("joystick_boat").with_parameters({"body": {"mass": 9.0}})
    own, other = (boatsim.run("joystick_boat/sway_1", vessel=v) for v in (None, heavy))
    assert len(own.recording) < len(other.recording)  # the heavy boat needs longer for the distance
    with pytest.raises(
        BadInput, match="sway_1: controller l1_joystick sets pwm_port; barge: command"
    ):
        boatsim.load_scenario("joystick_boat/sway_1", vessel=barge())
    with pytest.raises(BadInput, match="a Scenario has its own"):
        boatsim.run(boatsim.load_scenario("joystick_boat/sway_1"), controller="pid_autopilot")


def test_changes_of_a_vessel(tmp_path: Path) -> None:
    vessel = barge()
    windy = vessel.with_effect(Current(north=0.1))
    assert [e.name for e in windy.effects][-1] == "current" and len(vessel.effects) == 3
    assert windy.without_effect("current") == vessel
    assert vessel.replace(length=3.0).length == 3.0
    for wrong, message in (
        (lambda: vessel.without_effect("curent"), "barge: effect 'curent' does not exist"),
        (lambda: windy.with_effect(Current()), "effect current occurs 2 times"),
        (
            lambda: vessel.with_parameters({"thruster": {"gian": 1.0}}),
            "barge: thruster 'gian' does not exist; did you mean 'gain'",
        ),
        (lambda: vessel.with_parameters({"body": {"mass": -1.0}}), "barge: body: mass = -1.0"),
        (lambda: barge(lenght=1.0), "barge: key 'lenght' does not exist; did you mean 'length'"),
        (lambda: barge(channels={}), "effect thruster: on.thrust channel 'thrust_N' does not"),
        (lambda: barge(channels={"psi_rad": {"low": 0, "high": 1}}), "reserved for a column"),
    ):
        with pytest.raises(BadInput, match=message):
            wrong()


@pytest.mark.parametrize("name", content.shipped_content_names("vessel"))
def test_every_vessel_is_the_same_after_saving(name: str, tmp_path: Path) -> None:
    vessel = boatsim.load_vessel(name)
    for load in ((), *((one,) for one in vessel.loads)):
        vessel = boatsim.load_vessel(name, load)
        saved = vessel.save(tmp_path / name)
        again = boatsim.load_vessel(tmp_path / name)
        assert again == saved == replace(vessel, file=saved.file, load=(), loads=())
        assert [e.filled for e in again.effects] == [e.filled for e in vessel.effects]


def test_the_recording_of_a_changed_vessel_names_the_vessel_that_moved(tmp_path: Path) -> None:
    changed = boatsim.load_vessel("joystick_boat").with_parameters({"body": {"mass": 6.0}})
    out = tmp_path / "out"
    boatsim.run("joystick_boat/sway_1", vessel=changed, out=out)
    named = boatsim.read(out / "camera.csv").notes.vessel
    assert boatsim.load_vessel(out / named).body.mass == 6.0
    boatsim.run(
        "joystick_boat/sway_1", vessel=boatsim.load_vessel("joystick_boat"), out=tmp_path / "other"
    )
    assert not (tmp_path / "other_vessel").exists()
