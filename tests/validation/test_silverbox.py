"""An exam of others, the Silverbox: a circuit read as a hull that only rolls, where its recordings
are."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording
from validation.real import silverbox
from validation.real.common import RECORDINGS

RUNS = RECORDINGS / silverbox.NAME / "runs"
there = pytest.mark.skipif(not RUNS.is_dir(), reason="no ../shared/recordings/silverbox")
CUBIC = 7.35e5 / 1.844e5  # [1/V^2] of a least-squares fit of simulations, by the README of the data
RATE = 1.0 / silverbox.ROW  # [Hz]


def tones(t: Array) -> Array:
    """A signal (N,) with nothing beyond 190 Hz at times of the circuit [s]."""
    hertz = (11.0, 73.0, 128.0, 190.0)
    return np.asarray(sum(np.sin(2.0 * np.pi * f * t + k) for k, f in enumerate(hertz)))


def taken(folder: Path, between: str) -> tuple[Recording, Array]:
    """A made-up recording as it is opened, and the input as it is at the middle of every course."""
    t = np.arange(400) / RATE
    file = folder / "made.csv"
    table = np.column_stack([t, tones(t), 0.0 * t])
    np.savetxt(file, table, delimiter=",", header="t_s,force_V,displacement_V", comments="")
    recording = silverbox.open_set(file, between)
    middle = (np.arange(400 * silverbox.FINER) + 0.5) / silverbox.FINER / RATE
    return recording, tones(middle)


def test_the_input_between_its_rows_is_the_band_limited_signal_through_them(tmp_path: Path) -> None:
    """Away from its ends, where nobody knows what came before."""
    inner, off = slice(15 * silverbox.FINER, -15 * silverbox.FINER), {}
    for between in silverbox.INTERPOLATIONS:
        recording, true = taken(tmp_path, between)
        assert recording.orders is not None
        off[between] = float(
            np.std((recording.orders.signals["force_V"] - true)[inner]) / np.std(true)
        )
    assert off["band"] < 0.005 and off["lines"] > 0.1 and off["held"] > 0.3


def test_a_row_holds_the_mean_of_the_courses_until_the_next(tmp_path: Path) -> None:
    recording, _ = taken(tmp_path, "band")
    assert (
        recording.orders is not None
        and len(recording) == 400
        and recording.t[-1] == pytest.approx(399 / 20)
    )
    courses = recording.orders.signals["force_V"].reshape(400, -1)
    assert recording["force_V"] == pytest.approx(courses.mean(axis=1))


def test_the_vessel_swings_as_the_circuit_on_a_slower_clock(tmp_path: Path) -> None:
    boat = silverbox.write_vessel(tmp_path)
    arm, thruster = boat.effect("righting_arm"), boat.effect("thruster")
    assert arm is not None and thruster is not None and boat.dof == ("roll",)
    stiffness, lever = getattr(arm, "stiffness"), getattr(thruster, "z")  # noqa: B009
    pulsation = np.sqrt(stiffness / boat.body.roll_inertia)  # [rad/s]
    assert pulsation / (2.0 * np.pi) == pytest.approx(
        silverbox.NATURAL_FREQUENCY * silverbox.SECOND / RATE, rel=1e-4
    )
    assert -lever == pytest.approx(stiffness)  # a steady V heels it by a V


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Diagnosis:
    boat = silverbox.write_vessel(tmp_path_factory.mktemp(silverbox.NAME))
    return silverbox.diagnose(silverbox.open_set(RUNS / "train.csv"), boat)


@there
@pytest.mark.slow
def test_the_cubic_spring_is_named_before_all_else(found: Diagnosis) -> None:
    """Offsets of input and output are there, too; the damping is what the circuit's makers do not
    state."""
    effects = found.findings.answer["effects"]
    names = [e["name"] for e in effects]
    assert names[0] == "righting_arm_stiffening" and not effects[0]["tied_with"]
    allowed = {"righting_arm_stiffening", "steady_force", "roll_offset", "quadratic_damping"}
    assert {"steady_force", "roll_offset"} < set(names) <= allowed
    cubic = effects[0]["parameters"]["cubic_perrad2"]
    assert (
        cubic["value"] == pytest.approx(CUBIC, rel=0.03)
        and abs(cubic["value"] - CUBIC) < 2.0 * cubic["sd"]
    )


@there
@pytest.mark.slow
def test_a_zero_of_the_output_that_is_off_is_told_by_the_square_that_it_makes_of_the_cube(
    found: Diagnosis,
) -> None:
    """Without its entry the same is described as a spring that is stronger to one side."""
    (offset,) = (e for e in found.findings.answer["effects"] if e["name"] == "roll_offset")
    assert offset["gain_nats"] > 100.0
    assert not found.findings.answer["unknown"]["flag"] and not found.findings.answer["described"]


@there
@pytest.mark.slow
def test_both_test_sets_are_simulated_to_far_less_than_a_millivolt(found: Diagnosis) -> None:
    ranking = found.ranking
    models = {"recalibrated": ranking.recalibrated, "patched": ranking.best}
    most = {silverbox.MULTISINE: 0.3, silverbox.ARROW: 0.4}  # [mV]
    for name, limit in most.items():
        off = silverbox.simulation_errors(found, silverbox.open_set(RUNS / f"{name}.csv"), models)
        rms = {model: silverbox.rms(e) for model, e in off.items()}
        assert rms["patched"] < limit < silverbox.GOAL and rms["recalibrated"] > 7.0, rms
