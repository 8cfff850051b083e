"""Excitation of waves from a table: values between its points, and long waves."""

from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from boatsim.errors import BadInput
from boatsim.physics.base import Array, make_motion
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.vessel import load_vessel

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"


def complex_loads(frequency: float, toward: float) -> Array:
    """Complex amplitudes (6,) of the wrench of a wave of unit amplitude."""
    own = PanelWaveLoads(
        coefficients=str(OTTER),
        spectrum="regular",
        significant_height=2.0,
        modal_period=2.0 * pi / frequency,
        toward=toward,
        depth=0.0,
    )
    start = np.array(own.wrench(make_motion(t=0.0)))
    later = np.array(own.wrench(make_motion(t=0.5 * pi / frequency)))
    return np.asarray(start - 1j * later)


@pytest.mark.slow
def test_loads_between_the_points_of_the_table_are_those_of_a_spline() -> None:
    found = read_coefficients(OTTER)
    largest = np.abs(found.excitation).max(axis=(0, 1))
    spline = CubicSpline(found.frequency, found.excitation)
    for frequency in (1.9, 3.3, 5.05):
        for heading in (0.31, 1.0, 1.83, 2.7):
            exact = CubicSpline(found.heading, spline(frequency))(heading)
            error = np.abs(complex_loads(frequency, heading) - exact)
            assert np.all(error < 0.01 * largest)


def test_heave_force_of_long_waves_is_the_buoyancy_of_the_elevation() -> None:
    found = read_coefficients(OTTER)
    force = complex_loads(0.6 * found.frequency[0], 0.5 * pi)
    assert force[2].real == pytest.approx(-found.restoring[2, 2], rel=0.1)


def test_waves_shorter_than_those_of_the_table_exert_no_force() -> None:
    assert not complex_loads(12.0, 1.0).any()


def test_sea_of_another_depth_is_refused() -> None:
    table = {"use": "panel_wave_loads", "coefficients": str(OTTER), "depth": 5.0}
    with pytest.raises(BadInput, match="the coefficients hold for 0 m"):
        load_vessel("otter").with_effect(table)
