"""Diagnoses of recordings that no fit can follow end with an unknown cause, its time and axis."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pushed_boat import BOAT, laid, sail

from boatsim.diagnosis import loading, pipeline
from boatsim.diagnosis.divergence import (
    cannot_follow_recordings,
    find_divergences,
    raise_latent_force_level,
)
from boatsim.diagnosis.loading import LoadedRecordings, Request
from boatsim.diagnosis.locate.missing_force import residual_force
from boatsim.diagnosis.without_fit import results_without_fit
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording, write_csv

SINCE = 15.0  # [s] begin of a yaw moment that spins the boat
MOMENT = 12.0  # [N m] 60 times that of full thrust on one side
AT_ONCE = 2.0  # [s] within which the begin is found


def nothing(t: float, y: Array, command: Array) -> Array:
    return np.zeros(3)


def spin(t: float, y: Array, command: Array) -> Array:
    return np.array([0.0, 0.0, MOMENT * (t >= SINCE)])


def wrapped(recording: Recording) -> Recording:
    psi = np.remainder(recording["psi_rad"] + np.pi, 2.0 * np.pi) - np.pi
    return replace(recording, signals={**recording.signals, "psi_rad": psi})


def loaded(folder: Path, recordings: list[Recording]) -> LoadedRecordings:
    paths = []
    for recording in recordings:
        paths.append(folder / f"{recording.name}.csv")
        write_csv(recording, paths[-1])
    return loading.load_recordings(Request(paths[:-1], paths[-1:], vessel=BOAT.name))


def test_a_moment_too_large_for_any_fit_is_an_unknown_cause_in_yaw_from_its_begin_on(
    tmp_path: Path,
) -> None:
    runs = [wrapped(sail(f"run_{seed}", seed, spin)[0]) for seed in (1, 2, 3)]
    answer = pipeline.diagnose_loaded(loaded(tmp_path, runs)).findings.answer
    assert answer["verdict"] == "unknown" and answer["unknown"]["flag"]
    places = answer["unknown"]["diverges"]
    assert [place["run"] for place in places] == ["run_1", "run_2", "run_3"]
    for place in places:
        assert place["axis"] == "yaw"
        assert SINCE <= place["from_s"] <= SINCE + AT_ONCE
        assert place["rms"] == pytest.approx(MOMENT, rel=0.1)
    assert f"unknown from t = {places[0]['from_s']:.4g} s of run_1, in yaw" in answer["sentence"]
    assert not answer["effects"] and not answer["tried"]
    flagged = set()
    for each in answer["where"]["intervals"]:
        if each["axis"] == "yaw" and each["from_s"] < SINCE + AT_ONCE and each["to_s"] > 39.0:
            assert each["from_s"] > SINCE - 3.0  # an average over 1 s of smoothed forces
            flagged.add(each["run"])
    assert flagged == {"run_1", "run_2", "run_3"}
    json.dumps(answer, allow_nan=False)


def test_a_good_fit_is_not_lost_and_its_disturbance_is_not_raised() -> None:
    problem, recalibrated = laid(sail("run", 3, nothing)[0])
    assert not cannot_follow_recordings(problem, recalibrated)
    assert cannot_follow_recordings(problem, replace(recalibrated, evidence=-np.inf))
    followed = raise_latent_force_level(problem, problem.recordings)
    np.testing.assert_array_equal(followed.levels.force, problem.ambient.force)
    forces = residual_force(problem, followed, problem.recordings)
    assert len(find_divergences(problem, problem.recordings, forces)) == 1


def test_a_failure_of_linear_algebra_becomes_an_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> None:
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(pipeline, "fit_baseline_models", fail)
    runs = [sail(f"run_{seed}", seed, nothing)[0] for seed in (1, 2)]
    found = pipeline.diagnose_loaded(loaded(tmp_path, runs))
    assert found.findings.answer["verdict"] == "unknown"
    assert found.findings.free_runs


def test_forces_that_are_never_finite_are_refused_in_one_line() -> None:
    problem, _ = laid(sail("run", 3, nothing)[0])
    [mapped] = problem.recordings
    broken = replace(mapped, values=np.full_like(mapped.values, np.nan))
    with pytest.raises(BadInput, match=r"run.csv: the forces of trial_boat are not finite"):
        results_without_fit(problem.with_recordings([broken]), [broken], "run.csv")


def test_a_jump_of_the_position_is_a_fault_of_the_log_and_not_of_its_unit(tmp_path: Path) -> None:
    runs = []
    for seed in (1, 2):
        recording = sail(f"run_{seed}", seed, nothing)[0]
        x = recording["x_m"] + 500.0 * (recording.t > 20.0)
        runs.append(replace(recording, signals={**recording.signals, "x_m": x}))
    answer = pipeline.diagnose_loaded(loaded(tmp_path, runs)).findings.answer
    assert answer["verdict"] == "unknown"
    assert answer["sentence"].startswith("Probably your log, not your boat: position leaps")
    assert [entry["name"] for entry in answer["log"]][:2] == ["position_leaps"] * 2
