"""The false-name campaign tries all effects that a diagnosis tries, and its bodies are no boatsim."""

import ast
from pathlib import Path

import pytest

from validation.calibration import bodies, tried_effects
from validation.calibration.abilities import BODIES
from validation.calibration.vessels import BOATS

ALLOWED = "boatsim.physics.vessel"  # of which a body's vessel file is made


@pytest.mark.filterwarnings("ignore:.*exert no force")  # the long wave of heaving_drives
def test_bodies_try_every_effect_except_those_with_a_stated_reason() -> None:
    tried = set[str]()
    for make in BODIES.values():
        tried |= tried_effects.effects_tried_on(make())
    excepted = set(tried_effects.ON_REQUEST) | set(tried_effects.OTHER_CAMPAIGN)
    assert tried_effects.candidate_effects() - tried == excepted


@pytest.mark.parametrize("name", tried_effects.OTHER_CAMPAIGN)
def test_the_vessel_that_is_said_to_try_an_effect_tries_it(name: str) -> None:
    vessel = tried_effects.OTHER_CAMPAIGN[name]
    assert vessel in BOATS
    assert name in tried_effects.effects_tried_on_vessel(vessel)


@pytest.mark.parametrize("name", tried_effects.ON_REQUEST)
def test_no_shipped_vessel_tries_what_is_tried_on_request_only(name: str) -> None:
    for vessel in BOATS:
        assert name not in tried_effects.effects_tried_on_vessel(vessel)


def test_bodies_are_simulated_without_the_laws_of_boatsim() -> None:
    for file in Path(bodies.__path__[0]).glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("boatsim"):
                assert node.module == ALLOWED
                assert [alias.name for alias in node.names] == ["Vessel"]
            if isinstance(node, ast.Import):
                assert not any(alias.name.startswith("boatsim") for alias in node.names)
