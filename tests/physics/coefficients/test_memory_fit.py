"""The state-space model of the memory of the radiation force against the coefficients it models."""

from pathlib import Path

import numpy as np
import pytest

from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.coefficients.memory_fit import (
    MemoryModel,
    estimated_infinite_added_mass,
    fit_memory,
    lowest_damping,
    memory_response,
)

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
WIDE = np.geomspace(1e-3, 1e3, 3000)  # [rad/s]
# Two oscillators, of which one returns energy at some frequencies; their sum does not
KNOWN = MemoryModel(
    (
        np.array(
            [
                [9.0, 2.0, 8.0, 0.0, 1.0, 20.0, 0.0, 3.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.2],
                [36.0, 4.0, 5.0, 0.0, 0.5, 15.0, 0.0, 2.0, -2.0, 0.0, 0.0, -4.0, 0.0, -0.8],
            ]
        ),
        np.zeros((0, 14)),
    ),
    (0.0, 0.0),
)


def test_model_of_two_sections_is_found_again() -> None:
    w = np.linspace(0.3, 12.0, 40)
    found = fit_memory(w, KNOWN.response(w))
    assert len(found.sections[0]) == 2
    assert len(found.sections[1]) == 0
    expected = KNOWN.response(w)
    assert np.abs(found.response(w) - expected).max() < 0.01 * np.abs(expected).max()


def test_model_of_the_catamaran_agrees_with_its_coefficients() -> None:
    own = read_coefficients(OTTER)
    assert own.memory is not None
    exact = memory_response(own.frequency, own.added_mass, own.damping, own.infinite_added_mass)
    model = own.memory.response(own.frequency)
    for i in range(6):
        largest = np.abs(exact[:, i, i]).max()
        assert np.abs(model[:, i, i] - exact[:, i, i]).max() < 0.02 * largest


def test_memory_has_no_force_at_zero_frequency_and_at_infinite_frequency() -> None:
    memory = read_coefficients(OTTER).memory
    assert memory is not None
    response = np.abs(memory.response(np.array([1e-6, 4.0, 1e6])))
    assert response[0].max() < 1e-5 * response[1].max()
    assert response[2].max() < 1e-4 * response[1].max()


def test_model_is_passive_at_all_frequencies() -> None:
    memory = read_coefficients(OTTER).memory
    assert memory is not None
    assert lowest_damping(memory, WIDE) > -1e-7


@pytest.mark.slow
def test_model_is_passive_although_the_data_are_not() -> None:
    own = read_coefficients(OTTER)
    damping = own.damping.copy()
    damping[:, 2, 2] -= 0.05 * damping[:, 2, 2].max()
    response = memory_response(own.frequency, own.added_mass, damping, own.infinite_added_mass)
    found = fit_memory(own.frequency, response)
    assert lowest_damping(found, WIDE) > -1e-7
    assert found.error[0] < 0.15


@pytest.mark.slow
def test_added_mass_at_infinite_frequency_is_extrapolated() -> None:
    own = read_coefficients(OTTER)
    found = estimated_infinite_added_mass(own.frequency, own.added_mass, own.damping)
    exact = own.infinite_added_mass
    for i in (1, 2, 3, 4):  # surge and yaw have most of their damping beyond the data
        assert found[i, i] == pytest.approx(exact[i, i], rel=0.25)
