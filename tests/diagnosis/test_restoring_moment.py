"""A restoring moment other than in the vessel file, found by a whole diagnosis at any angle."""

from typing import Any

import numpy as np
import pytest

from tests.driven_pendulum import MOMENT, Pendulum, diagnosed, recording

SECONDS = 12.0
SHAPES = ({"second": 0.15, "third": -0.1}, {"third": 0.2})


def only_effect(answer: dict[str, Any]) -> dict[str, Any]:
    """The effect that an answer names alone, without a look-alike or an unknown cause."""
    (effect,) = answer["effects"]
    assert answer["verdict"] == "named" and not answer["unknown"]["flag"], answer["sentence"]
    assert not answer["also_possible"] and not effect["tied_with"]
    return dict(effect)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.8, 1.2])
def test_a_restoring_moment_of_another_size_is_named_with_its_factor(factor: float) -> None:
    effect = only_effect(diagnosed(Pendulum(moment=factor * MOMENT), SECONDS))
    assert effect["name"] == "righting_moment_error"
    assert effect["parameters"]["factor"]["value"] == pytest.approx(factor, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_a_restoring_moment_of_another_shape_is_named_with_its_terms(
    shape: dict[str, float],
) -> None:
    effect = only_effect(diagnosed(Pendulum(**shape), SECONDS))
    assert effect["name"] == "righting_moment_shape"
    for name in ("second", "third"):
        found = effect["parameters"][name]["value"]
        assert found == pytest.approx(shape.get(name, 0.0), rel=0.05, abs=0.005)


@pytest.mark.slow
def test_nothing_is_named_on_a_pendulum_as_in_the_vessel_file() -> None:
    answer = diagnosed(Pendulum(), SECONDS)
    assert answer["verdict"] == "nothing_missing" and not answer["effects"], answer["sentence"]


def test_the_pendulum_of_these_tests_turns_over_the_top() -> None:
    angles = recording(1, SECONDS, Pendulum(moment=0.8 * MOMENT))["phi_rad"]
    assert np.ptp(angles) > 2.0 * np.pi
