"""Trials of the second practice set: the same seed gives the same files, the tool reads them, the
oracle is sound."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from alike import few

from boatsim.diagnosis.loading import open_recording
from validation.calibration.campaign import Job, causes_of
from validation.practice import hulls
from validation.practice.boats import BOATS
from validation.practice.make import Trial, evidence_gains, make_trial, simulate_trial, trials
from validation.practice.plans import PLANS

CHEAP = Trial(
    "T001_martin_tank_model",
    "martin_tank_model",
    "single",
    False,
    False,
    (hulls.quadratic_damping,),
    PLANS["martin_tank_model"],
    BOATS["martin_tank_model"],
)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_files(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        make_trial(CHEAP, 3, tmp_path / folder)
    files = sorted(p.name for p in (tmp_path / "one" / CHEAP.name).iterdir())
    assert files == ["answer.json", "recording.toml", "run_1.csv", "run_2.csv", "run_3.csv"]
    for name in files:
        one, two = (
            (tmp_path / folder / CHEAP.name / name).read_bytes() for folder in ("one", "two")
        )
        assert one == two


def test_a_set_has_all_kinds_for_every_vessel_and_conceals_half_of_the_single_effects() -> None:
    made = list(trials(1, 12))
    for vessel, plan in PLANS.items():
        kinds = [t.kind for t in made if t.vessel == vessel]
        assert [kinds.count(k) for k in ("none", "single", "pair", "unknown")] == [2, 6, 2, 2]
        hidden = [t for t in made if t.vessel == vessel and t.kind == "single" and t.concealed]
        assert len(hidden) == (3 if plan.kept else 0)


@pytest.mark.parametrize("vessel", few(PLANS, 2))
def test_the_tool_reads_a_trial_of_every_vessel_by_its_recording_toml(
    tmp_path: Path, vessel: str
) -> None:
    made = make_trial(
        Trial("T002_" + vessel, vessel, "none", False, True, (), PLANS[vessel], BOATS[vessel]),
        5,
        tmp_path,
    )
    recording, boat = open_recording(tmp_path / f"T002_{vessel}" / "run_3.csv", None, ())
    assert boat.name == vessel and len(recording) >= 240 and not recording.remarks
    assert json.loads((tmp_path / f"T002_{vessel}" / "answer.json").read_text()) == made
    if rms := made.get(
        "reference_position_rms_m"
    ):  # nothing is missing but the boat's own coefficients
        assert rms["recalibrated"] == pytest.approx(rms["true_structure"], rel=0.1)


@pytest.mark.slow
def test_a_stronger_effect_gives_more_evidence_and_none_gives_none() -> None:
    gains = [
        float(evidence_gains(simulate_trial(CHEAP, (3, 1), np.array([s])), [False])[0])
        for s in (1e-6, 0.05, 0.1)
    ]
    assert (
        gains[0] == pytest.approx(0.0, abs=1e-3)
        and 1.0 < gains[1] < gains[2] < 4.0 * gains[1] + 1.0
    )


@pytest.mark.slow
def test_a_stronger_disturbance_pushes_more_and_its_level_may_be_kept_back(tmp_path: Path) -> None:
    rough = replace(CHEAP, disturbance=3.0, level_stated=False)
    assert rough.nominal().ambient() == pytest.approx(3.0 * CHEAP.nominal().ambient())
    for trial in (CHEAP, rough):
        make_trial(trial, 3, tmp_path)
        notes = (tmp_path / trial.name / "recording.toml").read_text(encoding="utf-8")
        assert ("[ambient]" in notes) == trial.level_stated


def test_causes_of_the_background_are_outside_the_library_and_no_causes_of_the_answer() -> None:
    kinds = set()
    for number in range(1, 60):
        job = Job(20, number, unstated=True)
        trial, stated = job.trial(), replace(job, unstated=False).trial()
        main = len(trial.makers) - trial.background
        assert trial.makers[:main] == stated.makers
        assert all(trial.strange[main:]) and trial.strange[:main] == stated.strange
        kinds.add(trial.background)
        effects = [{"name": maker.__name__} for maker in trial.makers]
        names = causes_of({"effects": effects}, trial.background)
        assert names == [maker.__name__ for maker in stated.makers]
    assert kinds == {0, 1, 2}
