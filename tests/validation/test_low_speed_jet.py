"""What a diagnosis says of the water-jet craft at low speed: the concealed cases of its
specification, its own runs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from low_speed_boat import Real, recorded

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.recordings import table as recording
from boatsim.simulate import scenario
from boatsim.simulate.run_files import run_into_folder

pytestmark = pytest.mark.slow

NOTES = """vessel = "jet_ski"
load = ["low_speed"]
noise = { position_sd_m = 0.3, heading_sd_rad = 0.01, yaw_rate_sd_radps = 0.00873 }
ambient = { axes = ["surge", "sway", "roll", "yaw"], force_rms = { surge = 20.0, sway = 20.0, roll = 5.0, yaw = 10.0 } }
"""
YAW_RATE = 7  # of the channels of a free run: x, y, phi, psi, u, v, p, r


def diagnosed(
    folder: Path, real: Real, held_out: Real | None = None, without: tuple[str, ...] = ()
) -> Diagnosis:
    """Two runs of the real craft fitted, a third held out."""
    runs = [recorded(real, 1), recorded(real, 2), recorded(held_out or real, 3)]
    files = [folder / f"{r.name}.csv" for r in runs]
    for file, r in zip(files, runs, strict=True):
        recording.write_csv(r, file)
    (folder / "recording.toml").write_text(NOTES)
    return pipeline.diagnose(files[:2], files[2:], without=without)


def named(found: Diagnosis) -> dict[str, Any]:
    return {e["name"]: e["parameters"] for e in found.findings.answer["effects"]}


def yaw_rate_error(found: Diagnosis, seed: int, real: Real, patched: bool) -> float:
    """Rms yaw rate error [deg/s] of one free run over a whole recording."""
    laid = map_recording(recorded(real, seed), found.problem.program)
    fit = found.ranking.best if patched else found.ranking.nominal
    values = found.problem.parameter_vector(laid, fit.free, fit.theta)
    on = found.problem.program.effect_switches(fit.effects)
    ((_, run),) = laid.free_runs(values, on, fit.levels, float(np.ptp(laid.times)))
    column = laid.signals.index("r_radps")
    return float(np.degrees(np.std(run[:, YAW_RATE] - laid.measured[: len(run), column])))


@pytest.mark.long
def test_leak_and_delay_are_named_together_and_recovered(tmp_path: Path) -> None:
    real = Real(leak=0.25, late=0.4)
    found = diagnosed(
        tmp_path, real, without=("clock_offset",)
    )  # which is the same data in open loop
    effects = named(found)
    assert found.findings.answer["verdict"] == "named" and set(effects) == {
        "jet_leak",
        "command_delay",
    }
    # a raised bucket leaks nothing, so that less of the whole jet is left for the steering; a
    # lowered one leaks 0.25
    best = found.ranking.best
    (jet,) = (
        x
        for f, x in zip(best.free, best.theta, strict=True)
        if (f.effect, f.name) == ("reversing_jet", "yaw")
    )
    assert jet * effects["jet_leak"]["fraction"]["value"] == pytest.approx(0.25, abs=0.02)
    assert effects["command_delay"]["delay_s"]["value"] == pytest.approx(0.40, abs=0.02)
    for seed in (1, 3):  # fitted and held out
        before, after = (yaw_rate_error(found, seed, real, patched) for patched in (False, True))
        assert before > 1.5
        assert after**2 - 0.5**2 < 0.1 * (
            before**2 - 0.5**2
        )  # of its power beyond the gyro's noise [deg/s]


@pytest.mark.long
def test_another_time_constant_astern_is_named(tmp_path: Path) -> None:
    effects = named(diagnosed(tmp_path, Real(astern_time=1.2)))
    assert set(effects) == {"astern_time_constant"}
    assert effects["astern_time_constant"]["factor"]["value"] == pytest.approx(1.2 / 1.67, abs=0.06)


@pytest.mark.long
def test_waves_are_not_taken_for_a_disturbance(tmp_path: Path) -> None:
    found = diagnosed(tmp_path, Real(sea=0.054))
    assert set(named(found)) == {"wave_forcing"}
    assert named(found)["wave_forcing"]["frequency_radps"]["value"] == pytest.approx(2.5, rel=0.25)


@pytest.mark.long
def test_waves_without_their_entry_are_unknown_rather_than_a_yaw_moment(tmp_path: Path) -> None:
    other_sea = Real(sea=0.04, sea_frequency=1.5)
    found = diagnosed(tmp_path, Real(sea=0.054), other_sea, without=("wave_forcing",))
    answer = found.findings.answer
    assert answer["unknown"]["flag"] and not answer["effects"]
    assert next(c["gain_nats"] for c in answer["candidates"] if c["name"] == "steady_force") < 0.0


@pytest.mark.long
def test_a_steady_push_is_named_as_one(tmp_path: Path) -> None:
    effects = named(diagnosed(tmp_path, Real(pushed=0.02)))
    assert set(effects) == {"steady_force"}
    assert effects["steady_force"]["yaw_Nm"]["value"] == pytest.approx(460.0 * 0.02, rel=0.1)


def test_craft_as_modelled_has_nothing_missing(tmp_path: Path) -> None:
    assert diagnosed(tmp_path, Real()).findings.answer["verdict"] == "nothing_missing"


@pytest.mark.long
def test_own_run_has_nothing_missing(tmp_path: Path) -> None:
    run_into_folder(tmp_path / "own", scenario.load("jet_ski/low_turns_l1"))
    assert (
        pipeline.diagnose([tmp_path / "own" / "camera.csv"]).findings.answer["verdict"]
        == "nothing_missing"
    )
