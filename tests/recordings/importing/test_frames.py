"""Latitudes to metres and quaternions to angles, against formulas that the package does not use."""

import math

import make_logs
import numpy as np
import pytest
from make_logs import geodetic, quaternion
from scipy.spatial.transform import Rotation

from boatsim.recordings.importing.frames import (
    curvature_radii,
    local_position,
    quaternions_to_euler_angles,
    with_euler_angles,
)
from boatsim.recordings.importing.log import Signal


@pytest.mark.parametrize("distance, most", [(100.0, 0.002), (1000.0, 0.2)])
@pytest.mark.parametrize("latitude", [-60.0, -33.0, 0.0, 30.0, 45.0, 60.0])
def test_a_local_place_is_that_of_the_exact_tangent_plane_within_what_is_stated(
    monkeypatch, latitude, distance, most
):
    origin = (math.radians(latitude), math.radians(-71.0))
    monkeypatch.setattr(make_logs, "ORIGIN", origin)
    for course in np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False):
        north, east = distance * math.cos(course), distance * math.sin(course)
        lat, lon = geodetic(north, east)
        x, y = local_position(np.radians([lat]), np.radians([lon]), origin)
        assert math.hypot(x[0] - north, y[0] - east) < most


def test_radii_of_curvature_are_those_of_the_ellipsoid_at_equator_and_pole():
    meridian, across = curvature_radii(0.0)
    assert across == 6378137.0 and meridian == pytest.approx(6335439.327, abs=1e-3)  # a (1 - e^2)
    assert curvature_radii(math.pi / 2) == (
        pytest.approx(6399593.626, abs=1e-3),
        pytest.approx(6399593.626, abs=1e-3),
    )  # a^2 / b


def test_a_boat_that_crosses_the_date_line_does_not_go_round_the_world():
    x, y = local_position(
        np.zeros(2), np.radians([179.9999, -179.9999]), (0.0, math.radians(179.9999))
    )
    assert y[1] == pytest.approx(22.26, abs=0.01) and x[1] == 0.0


@pytest.mark.parametrize("roll, pitch, yaw", [(0.1, -0.2, 0.3), (-0.4, 0.5, 3.0), (0.0, 0.0, -2.5)])
def test_angles_of_a_quaternion_are_those_it_was_made_of(roll, pitch, yaw):
    found = quaternions_to_euler_angles(
        *(np.array([part]) for part in quaternion(roll, pitch, yaw))
    )
    np.testing.assert_allclose([a[0] for a in found], (roll, pitch, yaw), atol=1e-12)
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat()
    np.testing.assert_allclose(
        [a[0] for a in quaternions_to_euler_angles(*(np.array([p]) for p in (w, x, y, z)))],
        (roll, pitch, yaw),
        atol=1e-12,
    )


def test_what_is_no_rotation_gets_no_angle():
    t = np.arange(3.0)
    good = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]])
    found = with_euler_angles(
        {f"/imu.orientation.{k}": Signal(t, good[:, i]) for i, k in enumerate("wxyz")}
    )
    np.testing.assert_array_equal(found["/imu.orientation.yaw"].values, [0.0, np.nan, 0.0])
    assert "/imu.velocity.yaw" not in with_euler_angles(
        {f"/imu.velocity.{k}": Signal(t, t) for k in "wxyz"}
    )
