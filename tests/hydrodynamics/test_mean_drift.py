"""Mean drift by the far-field method against the waves that a circular cylinder scatters."""

from pathlib import Path

import numpy as np
import pytest
from scipy.special import h1vp, jvp

from boatsim.errors import BadInput
from boatsim.hydrodynamics.mean_drift import drift_of_kochin, energy_error, far_field
from boatsim.hydrodynamics.response import Ballast, floating_response
from boatsim.physics.base import Array
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.waves.dispersion import wave_number
from validation.waves.drift import cylinder_force, maruo

OTTER = Path(__file__).parents[2] / "models" / "otter" / "hydrodynamics"
DENSITY, G, RADIUS, ANGLES = 1000.0, 9.81, 0.7, 96
HEADING = np.array([0.0, 0.4, 2.0, -1.3])


def cylinder_kochin(frequency: float, depth: float, place: tuple[float, float]) -> Array:
    """Kochin functions (H, T) of a held cylinder to the bottom, by the series of MacCamy and Fuchs.

    Args:
        frequency: Frequency of the waves [rad/s].
        depth: Depth of the water [m]; 0 for deep water.
        place: Centre of the cylinder [m].
    """
    k, deep = float(wave_number(frequency, depth)), frequency**2 / G
    order = np.arange(40)
    factor = np.where(order == 0, 1.0, 2.0) * -jvp(order, k * RADIUS) / h1vp(order, k * RADIUS)
    theta = 2.0 * np.pi / ANGLES * np.arange(ANGLES)
    wave = k
    if depth > 0.0:
        wave = k * k / ((k * k - deep * deep) * depth + deep)
    rows = []
    for beta in HEADING:
        scattered = np.cos(np.outer(theta - beta, order)) @ factor
        x, y = place
        ahead = k * (x * np.cos(beta) + y * np.sin(beta))
        back = k * (x * np.cos(theta) + y * np.sin(theta))
        rows.append(G / (2.0 * np.pi * wave * frequency) * scattered * np.exp(1j * (ahead - back)))
    return np.array(rows)


def cylinder_drift(frequency: float, depth: float, place: tuple[float, float]) -> Array:
    """Mean drift (H, 3) of the cylinder."""
    kochin = cylinder_kochin(frequency, depth, place)
    waves = far_field(frequency, depth, DENSITY)
    return drift_of_kochin(kochin, HEADING, waves, np.zeros(len(HEADING)))


@pytest.mark.parametrize("frequency", [2.0, 4.0, 6.0])
def test_drift_of_a_cylinder_is_that_of_havelock_along_the_waves(frequency: float) -> None:
    exact = cylinder_force(frequency**2 / G * RADIUS) * DENSITY * G * RADIUS
    found = cylinder_drift(frequency, 0.0, (0.0, 0.0))
    ahead = np.column_stack([np.cos(HEADING), np.sin(HEADING), 0.0 * HEADING])
    assert found == pytest.approx(exact * ahead, abs=1e-9 * exact)


def test_drift_of_a_cylinder_in_short_waves_is_two_thirds() -> None:
    assert cylinder_force(15.0) == pytest.approx(2.0 / 3.0, rel=0.02)


@pytest.mark.parametrize("depth", [0.0, 0.3, 2.0])
@pytest.mark.parametrize("place", [(0.0, 0.0), (1.1, -0.6)])
def test_energy_is_conserved(depth: float, place: tuple[float, float]) -> None:
    kochin = cylinder_kochin(3.0, depth, place)
    error = energy_error(kochin, HEADING, far_field(3.0, depth, DENSITY))
    assert error == pytest.approx(0.0 * HEADING, abs=1e-9)


@pytest.mark.parametrize("depth", [0.0, 0.5])
def test_moment_is_that_of_the_force_at_the_centre_of_the_cylinder(depth: float) -> None:
    x, y = 1.1, -0.6
    central = cylinder_drift(3.0, depth, (0.0, 0.0))
    found = cylinder_drift(3.0, depth, (x, y))
    assert found[:, :2] == pytest.approx(central[:, :2], rel=1e-9, abs=1e-9)
    moment = x * central[:, 1] - y * central[:, 0]
    assert found[:, 2] == pytest.approx(moment, rel=1e-7, abs=1e-7)


def test_drift_in_shallow_water_has_the_factor_of_the_group_velocity() -> None:
    depth, w = 0.4, 3.0
    k = float(wave_number(w, depth))
    factor = 1.0 + 2.0 * k * depth / np.sinh(2.0 * k * depth)
    found = cylinder_drift(w, depth, (0.0, 0.0))
    exact = cylinder_force(k * RADIUS) * DENSITY * G * RADIUS * factor
    assert found[0, 0] == pytest.approx(exact, rel=1e-9)


def test_absorbed_waves_push_along_their_direction() -> None:
    waves = far_field(3.0, 0.0, DENSITY)
    kochin = np.zeros((len(HEADING), ANGLES), dtype=complex)
    found = drift_of_kochin(kochin, HEADING, waves, np.full(len(HEADING), 5.0))
    assert found[:, 0] == pytest.approx(5.0 * np.cos(HEADING))
    assert found[:, 1] == pytest.approx(5.0 * np.sin(HEADING))


def test_section_that_reflects_all_waves_has_maruos_force() -> None:
    assert maruo(1.0, DENSITY) == pytest.approx(0.5 * DENSITY * G)
    assert maruo(0.5, DENSITY) == pytest.approx(0.125 * DENSITY * G)


BALLAST = Ballast(-0.2, (0.432, 0.5, 0.5), 0.0)


def test_hull_follows_the_surface_of_long_waves() -> None:
    found = read_coefficients(OTTER)
    motion, _ = floating_response(found, BALLAST)
    assert np.abs(motion[0, :, 2]) == pytest.approx(np.ones(len(found.heading)), abs=0.01)
    k = found.frequency[0] ** 2 / G
    slope = k * np.abs(np.sin(found.heading))
    assert np.abs(motion[0, :, 3]) == pytest.approx(slope, abs=0.05 * k)


def test_roll_damping_is_a_share_of_the_critical_damping() -> None:
    found = read_coefficients(OTTER)
    motion, extra = floating_response(found, Ballast(-0.2, (0.432, 0.5, 0.5), 0.3))
    free, none = floating_response(found, BALLAST)
    assert not none.any() and extra[3, 3] > 0.0
    assert np.count_nonzero(extra) == 1
    assert np.abs(motion[:, :, 3]).max() < np.abs(free[:, :, 3]).max()


def test_hull_that_capsizes_is_refused() -> None:
    with pytest.raises(
        BadInput, match="capsizes: its stiffness in roll is .* --centre-depth = -9 m"
    ):
        floating_response(read_coefficients(OTTER), Ballast(-9.0, (0.4, 0.5, 0.5)))


def test_drift_of_a_symmetric_hull_has_its_symmetry() -> None:
    found = read_coefficients(OTTER)
    assert found.drift is not None
    size = np.abs(found.drift).max(axis=(0, 1))
    ends = found.drift[:, [0, -1]]  # waves along the plane of symmetry
    assert np.abs(ends[:, :, 1:]).max(axis=(0, 1)) == pytest.approx(
        np.zeros(2), abs=0.002 * size.max()
    )
    assert np.all(found.drift[-5:, 0, 0] > 0.0)  # short waves push along their direction
    assert np.all(found.drift[-5:, -1, 0] < 0.0)
    beam = len(found.heading) // 2
    assert np.all(found.drift[-5:, beam, 1] > 0.0)
