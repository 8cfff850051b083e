"""Fixes that are repeated until the next one: found by their rhythm, left out, and the diagnosis
stays what it was."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed
from real_boat import Real, recorded

from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.diagnosis.checks.repeated_values import drop_repeated_values, repeated_rows
from boatsim.recordings.table import Recording


def held(run: Recording, rows: int) -> Recording:
    """A fix in every so many rows, repeated in between."""
    last = np.arange(len(run)) // rows * rows
    return replace(
        run, signals={n: v[last] if n in ("x_m", "y_m") else v for n, v in run.signals.items()}
    )


def test_repetitions_are_found_and_nothing_else() -> None:
    run = recorded(Real(), 1)
    assert not repeated_rows(np.column_stack([run["x_m"], run["y_m"]])).any()
    found = drop_repeated_values(held(run, 4))
    assert np.flatnonzero(np.isfinite(found["x_m"])).tolist() == list(range(0, len(run), 4))
    assert np.isfinite(found["psi_rad"]).all() and "x_m, y_m repeat each fix" in found.remarks[-1]


def test_a_held_gyro_is_found_and_the_finding_names_its_channel() -> None:
    run = recorded(Real(), 1, gyro=0.01)
    last = np.arange(len(run)) // 3 * 3
    gyro = replace(run, signals=run.signals | {"r_radps": run["r_radps"][last]})
    found = drop_repeated_values(gyro)
    assert np.flatnonzero(np.isfinite(found["r_radps"])).tolist() == list(range(0, len(run), 3))
    for name in ("x_m", "y_m", "psi_rad"):
        assert np.array_equal(found[name], run[name])
    (finding,) = cleaning_findings(found)
    assert finding.name == "channel_held" and finding.kind == "mended"
    assert "the recorded yaw rate (r_radps) repeats each value" in finding.evidence
    assert not drop_repeated_values(run).remarks


def test_a_boat_that_lies_still_between_moves_repeats_nothing() -> None:
    """Rows alike without a rhythm: a coarse instrument, or a boat at rest."""
    rng = np.random.default_rng(0)
    steps = np.cumsum(rng.random(400) < 0.2).astype(float)
    assert not repeated_rows(np.column_stack([steps, steps])).any()
    assert not repeated_rows(np.zeros((100, 2))).any()


def decaying_swing(n: int = 1200) -> np.ndarray:
    """An angle read in steps of 1 mrad that dry friction stops after a third of the rows."""
    t = np.arange(n) / 30.0
    return np.round(np.clip(1.0 - t / 13.5, 0.0, t) * np.sin(3.0 * t), 3)


def test_a_body_that_comes_to_rest_repeats_nothing_however_long_it_rests() -> None:
    swing = decaying_swing()
    assert np.mean(np.diff(swing) == 0.0) > 0.6
    assert not repeated_rows(swing[:, None]).any()
    assert not repeated_rows(np.append(np.zeros(900), swing)[:, None]).any()


def test_messages_in_bursts_are_found_beside_a_long_rest() -> None:
    swing = decaying_swing()
    last = np.arange(len(swing)) // 5 * 5
    single = np.random.default_rng(1).integers(0, 300, 30)
    last[single] = single
    held_swing = swing[np.maximum.accumulate(last)]
    found = np.flatnonzero(repeated_rows(held_swing[:, None]))
    moving = np.flatnonzero(np.diff(held_swing[:250]) == 0.0) + 1
    assert len(np.setdiff1d(moving, found)) < 0.1 * len(moving)
    assert len(found[found > 500]) == 0


def test_a_sensor_that_dies_while_the_body_moves_holds_its_value() -> None:
    swing = decaying_swing()
    last = np.minimum(np.arange(600) // 6 * 6, 96)
    last[::7] = np.minimum(np.arange(600)[::7], 96)
    dead = swing[np.maximum.accumulate(last)]
    assert repeated_rows(dead[:, None])[110:].all()


@pytest.mark.slow
def test_a_diagnosis_of_repeated_fixes_is_that_of_the_fixes(tmp_path: Path) -> None:
    runs = [held(recorded(Real(power=(1.15, 0.85)), s), 4) for s in (1, 2, 3)]
    said = diagnosed(runs, tmp_path, "trial_boat")
    (effect,) = said["effects"]
    assert said["verdict"] == "named" and effect["name"] == "thrust_imbalance", said["sentence"]
    fraction = effect["parameters"]["fraction"]
    assert abs(fraction["value"] - 0.15) < 3.0 * fraction["sd"]
    assert (
        said["fit"]["position_rms_m"]["patched"]
        < 0.5 * said["fit"]["position_rms_m"]["recalibrated"]
    )
