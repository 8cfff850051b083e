"""A spring to the ground, or a drift force, that alone acts on a section in measured waves."""

from dataclasses import replace
from pathlib import Path

import pytest

from tests.wave_rig import SWAY, Rig, diagnosed

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
    answer = diagnosed(rig, tmp_path)
    assert answer["verdict"] == "named" and not answer["unknown"]["flag"], answer["sentence"]
    (effect,) = answer["effects"]
    assert effect["name"] == name and not effect["tied_with"] and not answer["also_possible"]
    assert effect["parameters"][parameter]["value"] == pytest.approx(size, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("regular", [True, False])
def test_nothing_is_named_on_a_section_as_in_the_vessel_file(regular: bool, tmp_path: Path) -> None:
    answer = diagnosed(replace(RIG, regular=regular), tmp_path)
    assert answer["verdict"] == "nothing_missing" and not answer["effects"], answer["sentence"]
