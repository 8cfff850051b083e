"""Shapes of the 3D scene: the convex hull of points in a plane."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from boatsim.view.scene import convex_hull


@pytest.mark.parametrize("count", [3, 4, 10, 1000])
def test_the_convex_hull_has_the_corners_that_qhull_finds(count: int) -> None:
    rng = np.random.default_rng(count)
    points = rng.normal(size=(count, 2))
    found = convex_hull(points)
    expected = points[ConvexHull(points).vertices]  # counterclockwise too
    first = found.tolist().index(expected[0].tolist())
    assert np.array_equal(np.roll(found, -first, axis=0), expected)


def test_points_on_an_edge_are_no_corners() -> None:
    across, along = np.meshgrid(np.linspace(0.0, 0.3, 7), np.linspace(-0.1, 0.2, 9))
    corners = convex_hull(np.stack([across.ravel(), along.ravel()], axis=1))
    assert corners.tolist() == [[0.0, -0.1], [0.3, -0.1], [0.3, 0.2], [0.0, 0.2]]
