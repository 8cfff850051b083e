"""Truncated cylinder by eigenfunctions: reciprocity, energy, long waves, and the limit of a pile."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.special import h1vp

from boatsim.physics.particulars import GRAVITY
from validation.waves.truncated_cylinder import (
    HEAVE,
    MODES,
    PITCH,
    SURGE,
    Cylinder,
    cylinder_coefficients,
    wave_numbers,
)

CASES = [(Cylinder(1.0, 0.5, depth), number) for depth in (1.5, 6.0) for number in (0.2, 0.6, 1.0)]
AXES = (SURGE, HEAVE, PITCH)


def frequency(cylinder: Cylinder, number: float) -> float:
    """Frequency at a wave number [rad/m]."""
    return float(np.sqrt(GRAVITY * number * np.tanh(number * cylinder.depth)))


def test_wave_numbers_solve_the_dispersion_relation() -> None:
    wave, decay = wave_numbers(3.0, 1.5, 40)
    assert GRAVITY * wave * np.tanh(1.5 * wave) == pytest.approx(9.0, rel=1e-12)
    assert -GRAVITY * decay * np.tan(1.5 * decay) == pytest.approx(np.full(40, 9.0), rel=1e-9)
    assert np.all(np.diff(decay) > 0.0)


@pytest.mark.parametrize(("cylinder", "number"), CASES)
def test_damping_is_the_energy_of_the_waves_that_the_excitation_implies(
    cylinder: Cylinder, number: float
) -> None:
    """J. N. Newman, Marine Hydrodynamics, 1977, section 6.18, with the group velocity of the depth:
    excitation and damping are computed from different problems."""
    found = cylinder_coefficients(cylinder, frequency(cylinder, number))
    deep = 2.0 * number * cylinder.depth
    group = 0.5 * frequency(cylinder, number) / number * (1.0 + deep / np.sinh(deep))
    factor = number / (8.0 * np.pi * cylinder.density * GRAVITY * group)
    around = {SURGE: np.pi, HEAVE: 2.0 * np.pi, PITCH: np.pi}  # integrals of cos^2(m theta)
    for axis in AXES:
        force = abs(found.excitation[axis]) ** 2
        assert found.damping[axis, axis] == pytest.approx(factor * around[axis] * force, rel=1e-9)


@pytest.mark.parametrize(("cylinder", "number"), CASES)
def test_coupling_of_surge_and_pitch_is_reciprocal(cylinder: Cylinder, number: float) -> None:
    found = cylinder_coefficients(cylinder, frequency(cylinder, number))
    for matrix in (found.added_mass, found.damping):
        assert matrix == pytest.approx(matrix.T, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("cylinder", "number"), CASES)
def test_coefficients_converge_with_the_number_of_modes(cylinder: Cylinder, number: float) -> None:
    w = frequency(cylinder, number)
    coarse, fine = (cylinder_coefficients(cylinder, w, n) for n in (MODES // 2, MODES))
    for axis in AXES:
        limit = 0.005 if axis == PITCH else 3e-4
        for name in ("added_mass", "damping"):
            before, after = (getattr(one, name)[axis, axis] for one in (coarse, fine))
            assert before == pytest.approx(after, rel=limit)
        force = abs(fine.excitation[axis])
        assert abs(coarse.excitation[axis]) == pytest.approx(force, rel=limit)


def test_long_waves_lift_the_cylinder_with_its_stiffness() -> None:
    cylinder = Cylinder(1.0, 0.5, 6.0)
    found = cylinder_coefficients(cylinder, frequency(cylinder, 1e-3))
    # downward, against the crest; the wave pushes surge a quarter of a period later
    stiffness = cylinder.density * GRAVITY * np.pi
    assert found.excitation[HEAVE] == pytest.approx(-stiffness, rel=0.01)
    assert found.excitation[SURGE].imag > 100.0 * abs(found.excitation[SURGE].real)


@pytest.mark.parametrize("number", [0.3, 1.0, 2.0])
def test_a_cylinder_down_to_the_bed_has_the_force_of_a_pile(number: float) -> None:
    """R. C. MacCamy, R. A. Fuchs, Beach Erosion Board, technical memorandum 69, 1954."""
    cylinder = Cylinder(1.0, 1.4999, 1.5)
    found = cylinder_coefficients(cylinder, frequency(cylinder, number))
    pile = 4.0 * cylinder.density * GRAVITY * np.tanh(number * 1.5)
    pile /= number**2 * abs(h1vp(1, number))
    assert abs(found.excitation[SURGE]) == pytest.approx(pile, rel=2e-3)


def test_added_mass_and_damping_obey_the_relations_of_kramers_and_kronig() -> None:
    """Added mass less 2 / pi P int b(s) / (s^2 - w^2) ds is that at infinite frequency for all w.

    Source: T. F. Ogilvie, Recent progress toward the understanding and prediction of ship motions,
    5th Symposium on Naval Hydrodynamics, 1964.
    """
    cylinder, modes = Cylinder(1.0, 0.5, 1.5), 20
    w = frequency(cylinder, 1.0) / 3.0 * np.linspace(0.01, 12.0, 201)
    diagonals = []
    for one in w:
        found = cylinder_coefficients(cylinder, float(one), modes)
        diagonals.append([found.damping[axis, axis] for axis in AXES])
    damping = CubicSpline(np.append(0.0, w), np.vstack([np.zeros(3), diagonals]))
    infinite = []
    for number in (0.2, 0.6, 1.0):
        own = frequency(cylinder, number)
        s = np.linspace(0.0, w[-1], 20001) + 1e-6
        # the principal value of the integral of 1 / (s^2 - w^2) over all s is zero
        excess = (damping(s) - damping(own)) / (s**2 - own**2)[:, None]
        rest = 0.5 / own * np.log((w[-1] + own) / (w[-1] - own))  # beyond, where damping is zero
        integral = np.trapezoid(excess, s, axis=0) - damping(own) * rest
        found = cylinder_coefficients(cylinder, own, modes)
        added = np.array([found.added_mass[axis, axis] for axis in AXES])
        infinite.append(added - 2.0 / np.pi * integral)
    for one in infinite[1:]:
        assert one == pytest.approx(infinite[0], rel=1e-3)
