"""What a diagnosis finds on a section in measured waves: wave forces, drift forces and springs."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.wave_rig import HEAVE, PARTS, SEEDS, SWAY, Axis, Rig, diagnosed, frequencies

STIFFNESS, DRIFT = 50.0, -3000.0  # [N/m], [N/m^2]
RIG = Rig(SWAY)
CASES = (
    ("ground_spring", "stiffness_east_Npm", STIFFNESS, replace(RIG, stiffness=STIFFNESS)),
    (
        "ground_spring",
        "stiffness_east_Npm",
        STIFFNESS,
        replace(RIG, stiffness=STIFFNESS, released=0.1, regular=True),
    ),
    ("wave_drift", "sway_Npm2", DRIFT, replace(RIG, drift=DRIFT)),
    ("wave_drift", "sway_Npm2", DRIFT, replace(RIG, drift=DRIFT, regular=True)),
)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "parameter", "size", "rig"), CASES)
def test_a_spring_or_a_drift_force_alone_is_named_with_its_size(
    name: str, parameter: str, size: float, rig: Rig, tmp_path: Path
) -> None:
    answer = diagnosed(rig, tmp_path).findings.answer
    assert answer["verdict"] == "named" and not answer["unknown"]["flag"], answer["sentence"]
    (effect,) = answer["effects"]
    assert effect["name"] == name and not effect["tied_with"] and not answer["also_possible"]
    assert effect["parameters"][parameter]["value"] == pytest.approx(size, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("regular", [True, False])
def test_nothing_is_named_on_a_section_as_in_the_vessel_file(regular: bool, tmp_path: Path) -> None:
    answer = diagnosed(replace(RIG, regular=regular), tmp_path).findings.answer
    assert answer["verdict"] == "nothing_missing" and not answer["effects"], answer["sentence"]


def assert_forces_of_waves(rig: Rig, found: Sequence[float], share: float) -> None:
    """At the frequencies of the recorded waves the force has its true amplitude and phase."""
    for seed in SEEDS:
        s = 1j * frequencies(seed, rig)
        powers = np.array([s**0, s, s**2])
        true = rig.axis.excitation @ powers
        off = np.array(found) @ powers - true
        assert np.sqrt(np.mean(abs(off) ** 2)) < share * np.sqrt(np.mean(abs(true) ** 2))


@pytest.mark.slow
@pytest.mark.parametrize("axis", [HEAVE, SWAY])
@pytest.mark.parametrize("regular", [True, False])
def test_wave_forces_that_the_file_lacks_are_named_with_their_size(
    axis: Axis, regular: bool, tmp_path: Path
) -> None:
    rig = Rig(axis, regular=regular)
    answer = diagnosed(rig, tmp_path, excited=0.0).findings.answer
    (effect,) = answer["effects"]
    assert effect["name"] == "wave_excitation" and not effect["tied_with"], answer["sentence"]
    assert not answer["also_possible"]
    parameters = effect["parameters"]
    found = []
    for part, unit in zip(PARTS, ("Npm", "Nspm", "kg"), strict=True):
        found.append(parameters[f"{axis.name}_{part}_{unit}"]["value"])
    assert_forces_of_waves(rig, found, 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("axis", [HEAVE, SWAY])
@pytest.mark.parametrize("regular", [True, False])
def test_uncertain_wave_forces_that_are_too_small_are_refitted_and_nothing_else_is_named(
    axis: Axis, regular: bool, tmp_path: Path
) -> None:
    rig = Rig(axis, regular=regular)
    diagnosis = diagnosed(rig, tmp_path, excited=0.7, uncertain=0.5)
    answer = diagnosis.findings.answer
    assert not answer["effects"] and not answer["also_possible"], answer["sentence"]
    assert answer["recalibration"]["adopted"]
    values = diagnosis.ranking.best.values()
    found = []
    for part, true in zip(PARTS, axis.excitation, strict=True):
        found.append(0.7 * true * values["wave_excitation", f"{axis.name}_{part}"])
    assert_forces_of_waves(rig, found, 0.1)
