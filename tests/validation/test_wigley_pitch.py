"""Pitch of the Wigley hulls in long waves: closed forms, and a body that follows the surface."""

from pathlib import Path

import numpy as np
import pytest

from validation.waves import wigley
from validation.waves.hulls import closed_hull
from validation.waves.wigley_pitch import VERY_LONG, pitch_study, undisturbed_pitch


@pytest.mark.parametrize("hull", wigley.HULLS, ids=lambda hull: hull.name)
def test_moment_of_the_undisturbed_wave_tends_to_the_slope_from_below(hull: wigley.Hull) -> None:
    pitch = [undisturbed_pitch(hull, ratio) for ratio in (1.0, 1.5, 2.0, 4.0, 10.0, 40.0, 1e4)]
    assert np.all(np.diff(pitch) > 0.0)
    # the moment acts about the waterline: a weight below it adds stiffness
    depth = wigley.DRAUGHT - hull.centre
    x = 0.5 * wigley.LENGTH * np.linspace(-1.0, 1.0, 4001)
    z = wigley.DRAUGHT * np.linspace(-1.0, 0.0, 1001)
    breadth = 2.0 * wigley.half_breadth(hull, x[:, None], z[None, :])
    areas, moments = np.trapezoid(breadth, z, axis=1), np.trapezoid(breadth * z, z, axis=1)
    volume, buoyancy = np.trapezoid(areas, x), np.trapezoid(moments, x)
    own = np.trapezoid(x**2 * breadth[:, -1], x) + buoyancy
    assert pitch[-1] == pytest.approx(own / (own + volume * depth), abs=2e-4)
    assert pitch[-1] <= 1.0


@pytest.mark.parametrize("ratio", [1.0, 2.0, 10.0])
def test_moment_of_the_undisturbed_wave_is_that_of_the_pressure_on_panels(ratio: float) -> None:
    hull = wigley.HULLS[1]  # its mass centre is in the waterplane
    x = 0.5 * wigley.LENGTH * np.linspace(0.0, 1.0, 121)
    z = np.append(np.linspace(-wigley.DRAUGHT, 0.0, 61), 0.25 * wigley.DRAUGHT)
    corners = closed_hull(x, z, lambda along, up: wigley.half_breadth(hull, along, up))
    corners = corners[corners[..., 2].max(axis=1) <= 1e-9]
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = corners.mean(axis=1)
    k = 2.0 * np.pi / (ratio * wigley.LENGTH)
    # part of the pressure that is odd along the hull, over rho g and the amplitude of the wave
    pressure = np.sin(k * middle[:, 0]) * np.exp(k * middle[:, 2])
    force = -pressure[:, None] * areas
    moment = np.sum(middle[:, 0] * force[:, 2] - middle[:, 2] * force[:, 0])
    # hydrostatic stiffness: waterplane, and the buoyancy by the same panels
    buoyancy = 0.5 * np.sum(middle[:, 2] ** 2 * areas[:, 2])
    along = np.linspace(-0.5, 0.5, 4001) * wigley.LENGTH
    breadth = 2.0 * wigley.half_breadth(hull, along, np.zeros_like(along))
    waterplane = np.trapezoid(along**2 * breadth, along)
    expected = abs(moment) / (k * (waterplane + buoyancy))
    assert undisturbed_pitch(hull, ratio) == pytest.approx(expected, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("hull", wigley.HULLS, ids=lambda hull: hull.name)
def test_a_free_hull_follows_very_long_waves_and_the_mesh_is_fine_enough(
    hull: wigley.Hull, tmp_path: Path
) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    rows = pitch_study(tmp_path, hull)
    assert rows[-1].ratio == VERY_LONG
    assert rows[-1].surging == pytest.approx(1.0, abs=0.005)
    for row in rows:
        assert row.fine == pytest.approx(row.panels, rel=0.005)
        assert row.surging < row.panels  # held in surge, the hull pitches more
