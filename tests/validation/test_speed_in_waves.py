"""Forward speed in waves: a ship's published coefficients, and a hull against model tests."""

from pathlib import Path

import numpy as np
import pytest

from validation.waves import wigley_speed
from validation.waves.ship_speed import (
    HEAVE,
    PITCH,
    ROLL,
    SWAY,
    YAW,
    radiation,
    speed_terms,
)
from validation.waves.speed_diffraction import MovingHull

# The S-175 by VERES 4.02, MSS toolbox (T. I. Fossen, MIT License), s175.mat of July 2026: added
# mass and damping at this frequency [rad/s], at rest and at this speed [m/s]; SI units
FREQUENCY, SPEED = 0.6613879, 10.28889
ENTRIES = (
    ((HEAVE, HEAVE), (2.1416e7, 1.4894e7), (2.1375e7, 1.4924e7)),
    ((HEAVE, PITCH), (1.7884e8, 1.5342e8), (-1.7584e8, 3.7599e8)),
    ((PITCH, HEAVE), (1.7884e8, 1.5342e8), (5.2552e8, -6.4288e7)),
    ((PITCH, PITCH), (2.5426e10, 2.2519e10), (3.0221e10, 2.6321e10)),
    ((SWAY, SWAY), (3.0630e7, 1.3440e7), (3.0630e7, 1.3443e7)),
    ((SWAY, ROLL), (-2.2847e7, -3.1634e6), (-2.2847e7, -3.1618e6)),
    ((ROLL, SWAY), (-2.2847e7, -3.1634e6), (-2.2847e7, -3.1618e6)),
    ((SWAY, YAW), (2.5638e8, 9.5941e7), (5.7256e8, -2.1945e8)),
    ((YAW, SWAY), (2.5638e8, 9.5941e7), (-5.9744e7, 4.1085e8)),
    ((ROLL, ROLL), (3.1014e8, 3.9644e7), (3.1014e8, 3.9645e7)),
    ((ROLL, YAW), (-1.9624e9, -7.1155e8), (-2.0367e9, -4.7662e8)),
    ((YAW, ROLL), (-1.9624e9, -7.1155e8), (-1.8879e9, -9.4676e8)),
    ((YAW, YAW), (7.4729e10, 2.3389e10), (8.2136e10, 2.6663e10)),
)


def published() -> tuple[np.ndarray, np.ndarray]:
    """Added mass and damping (2, 6, 6) at rest and at speed."""
    rest, moving = np.zeros((2, 6, 6)), np.zeros((2, 6, 6))
    for (i, j), at_rest, at_speed in ENTRIES:
        rest[:, i, j], moving[:, i, j] = at_rest, at_speed
    return rest, moving


def test_terms_of_forward_speed_are_those_of_a_published_table() -> None:
    rest, moving = published()
    found = speed_terms(rest[0], rest[1], FREQUENCY, SPEED)
    for own, exact, before in zip(found, moving, rest, strict=True):
        size = np.sqrt(np.abs(np.diag(exact)))
        size[size == 0.0] = 1.0
        error = np.abs(own - exact) / (size[:, None] * size)
        # small end terms of the stern in heave and pitch, rounding of the table in the others
        upright, sideways = np.ix_([HEAVE, PITCH], [HEAVE, PITCH]), np.ix_([1, 3, 5], [1, 3, 5])
        assert error[upright].max() < 0.02
        assert error[sideways].max() < 1e-3
        without = np.abs(before - exact) / (size[:, None] * size)
        assert min(without[upright].max(), without[sideways].max()) > 0.15


def test_radiation_in_body_axes_is_that_of_the_coefficients_at_speed() -> None:
    """B(w, U) + i w A(w, U) per velocity in moving axes, from impedances in body axes."""
    rest, _ = published()
    rest = 0.5 * (rest + np.swapaxes(rest, 1, 2))
    block = np.ix_([HEAVE, PITCH], [HEAVE, PITCH])
    w = FREQUENCY
    added, damping = speed_terms(rest[0], rest[1], w, SPEED)
    expected = 1j * w * damping[block] - w * w * added[block]
    limit = np.eye(2)  # not used by the terms of forward speed
    found = radiation(rest[0][block], rest[1][block], limit, w, SPEED, "forward speed")
    assert found == pytest.approx(expected, rel=1e-12)
    for method in ("none", "body axes", "forward speed"):
        still = radiation(rest[0][block], rest[1][block], limit, w, 0.0, method)
        assert still == pytest.approx(1j * w * rest[1][block] - w * w * rest[0][block], rel=1e-12)


def test_undisturbed_long_wave_lifts_the_hull_by_its_waterplane() -> None:
    x = 0.5 * wigley_speed.LENGTH * np.linspace(-1.0, 1.0, 4001)
    breadth = 2.0 * wigley_speed.half_breadth(wigley_speed.HULL, x, np.zeros_like(x))
    expected = wigley_speed.DENSITY * wigley_speed.GRAVITY * np.trapezoid(breadth, x)
    assert wigley_speed.undisturbed_heave(1e-6) == pytest.approx(expected, rel=1e-5)
    assert wigley_speed.undisturbed_heave(2.0) < 0.6 * expected


@pytest.mark.slow
def test_heave_at_speed_is_near_that_of_model_tests(tmp_path: Path) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    table = wigley_speed.slow_table(tmp_path)
    hull = MovingHull(wigley_speed.write_mesh(tmp_path))
    rows = wigley_speed.heave_at_speed(table, hull)
    none, body, terms = (
        wigley_speed.mean_error([(row.measured, row.found[k]) for row in rows]) for k in range(3)
    )
    assert body < 0.05 and terms < 0.05 and none > 0.08
    for row in rows:
        assert row.found[1] == pytest.approx(row.measured, rel=0.1)
        assert row.found[2] == pytest.approx(row.measured, rel=0.1)
    # what is not improved: measured damping in pitch does not grow with the speed, computed does
    damping = wigley_speed.pitch_damping(table)
    assert damping[0][2][2] < damping[1][2][2] < damping[2][2][2]
    assert damping[0][2][2] == pytest.approx(damping[0][1], rel=0.15)
    assert damping[2][1] < damping[0][1]
