"""Comparison of a ship with published numbers, checked on a box in the place of its mesh."""

from math import cosh, radians, sin, sqrt, tan
from pathlib import Path

import numpy as np
import pytest

from boatsim.physics.particulars import GRAVITY
from validation.waves import dtmb5415
from validation.waves.hulls import write_stl

# A box around the mass centre of the ship, whose bottom is the lowest point of the mesh
BREADTH, TOP = 20.0, 13.0  # [m]
FORWARD = dtmb5415.LENGTH - dtmb5415.CENTRE  # [m] mass centre ahead of the aft perpendicular


@pytest.fixture
def box(tmp_path: Path) -> Path:
    """Folder with the mesh of a box."""
    half = 0.5 * dtmb5415.LENGTH
    corners = []
    for x in (FORWARD - half, FORWARD + half):
        for y in (-0.5 * BREADTH, 0.5 * BREADTH):
            corners += [(x, y, -dtmb5415.DOME), (x, y, TOP)]
    points = np.array(corners)
    # many panels along the box, so that the pressure of a wave is resolved
    number = 60
    triangles = []
    for start in range(number):
        shares = (start / number, (start + 1) / number)
        ends = []
        for share in shares:
            ends.append(points[:4] + share * (points[4:] - points[:4]))
        ring = (0, 1, 3, 2)
        for k in range(4):
            i, j = ring[k], ring[(k + 1) % 4]
            a, b, c, d = ends[0][i], ends[0][j], ends[1][j], ends[1][i]
            triangles += [(a, b, c), (a, c, d)]
    for end, order in ((points[:4], 1), (points[4:], -1)):
        a, b, c, d = end[[0, 2, 3, 1]][::order]
        triangles += [(a, b, c), (a, c, d)]
    path = tmp_path / dtmb5415.MESH
    path.parent.mkdir(parents=True)
    write_stl(path, np.array(triangles))
    return tmp_path


def test_box_in_the_place_of_the_ship_has_the_wall_sided_righting_arm(box: Path) -> None:
    hull = dtmb5415.loaded_hull(box)
    depth = dtmb5415.DISPLACEMENT / dtmb5415.DENSITY / (dtmb5415.LENGTH * BREADTH)
    radius = BREADTH**2 / (12.0 * depth)
    height = 0.5 * depth - dtmb5415.DOME + radius - dtmb5415.HEIGHT
    volume, found = dtmb5415.upright(hull)
    assert volume == pytest.approx(
        dtmb5415.LENGTH * BREADTH * (dtmb5415.DRAUGHT + dtmb5415.DOME), rel=1e-6
    )
    assert found == pytest.approx(height, rel=1e-6)
    rows = [row for row in dtmb5415.arms(hull) if row.heel <= 15.0]
    assert len(rows) == 4
    for row in rows:
        heel = radians(row.heel)
        expected = sin(heel) * (height + 0.5 * radius * tan(heel) ** 2)
        assert row.arm[1] == pytest.approx(expected, abs=1e-5)
        assert row.trim[1] == pytest.approx(0.0, abs=1e-6)


def test_undisturbed_wave_lifts_a_box_as_its_pressure_integrated_along_it(box: Path) -> None:
    force = dtmb5415.undisturbed_wave(box)
    length, breadth = dtmb5415.MODEL_LENGTH, BREADTH * dtmb5415.SCALE
    bottom = (dtmb5415.DRAUGHT + dtmb5415.DOME) * dtmb5415.SCALE
    for number in (1e-6, 1.0, 3.0):
        decay = cosh(number * (dtmb5415.TANK_DEPTH - bottom)) / cosh(number * dtmb5415.TANK_DEPTH)
        along = 2.0 * sin(0.5 * number * length) / number
        expected = dtmb5415.FRESH * GRAVITY * breadth * along * decay
        assert force(number).real == pytest.approx(expected, rel=1e-4)
        assert abs(force(number).imag) < 1e-4 * abs(expected)


@pytest.mark.parametrize("speed", [0.0, 1.0, 2.2])
def test_wave_met_at_a_frequency_obeys_dispersion_and_the_speed(speed: float) -> None:
    for encounter in (2.5, 6.0, 12.0):
        wave = dtmb5415.met_wave(encounter, speed)
        k = wave.number
        assert wave.encounter == pytest.approx(encounter, rel=1e-12)
        assert wave.frequency == pytest.approx(
            sqrt(GRAVITY * k * np.tanh(k * dtmb5415.TANK_DEPTH)), rel=1e-9
        )
    # waves of the depth of the tank and less are those of deep water
    assert dtmb5415.met_wave(12.0, 0.0).number == pytest.approx(12.0**2 / GRAVITY, rel=1e-6)


def motion(froude: float, ratio: float, error: float) -> dtmb5415.Motion:
    """Motion whose computed heave and pitch have an error and twice that error."""
    found = (0.5 * (1.0 + error), 0.4 * (1.0 + 2.0 * error))
    return dtmb5415.Motion(froude, 1.0, ratio, (0.5, 0.4), (found,) * len(dtmb5415.NAMES))


def test_errors_are_counted_by_speed_and_wavelength() -> None:
    rows = [
        motion(0.0, 1.0, 0.3),
        motion(0.28, 0.5, 0.9),
        motion(0.28, 1.0, -0.08),
        motion(0.28, 1.5, 0.04),
        motion(0.28, 3.0, 0.2),
    ]
    heave = dtmb5415.errors(rows, 0, 0, dtmb5415.RESONANT)
    assert heave[:2] == (2, 2) and heave.largest == pytest.approx(-0.08)
    assert heave.mean == pytest.approx(0.06)
    pitch = dtmb5415.errors(rows, 1, 0, dtmb5415.RESONANT)
    assert pitch[:2] == (1, 2) and pitch.largest == pytest.approx(-0.16)
    assert dtmb5415.errors(rows, 0, 0, np.inf)[:2] == (2, 3)
    still = dtmb5415.errors(rows, 0, 0, np.inf, moving=False)
    assert still == pytest.approx((0, 1, 0.3, 0.3))


def test_limits_of_wavelength_keep_away_from_measured_waves() -> None:
    """A frequency is read to 0.005 Hz, and must not decide what is counted."""
    for froude, points in dtmb5415.MEASURED.items():
        speed = froude * sqrt(GRAVITY * dtmb5415.MODEL_LENGTH)
        for hertz, *_ in points:
            counted = []
            for read in (hertz - 0.005, hertz + 0.005):
                wave = dtmb5415.met_wave(2.0 * np.pi * read, speed)
                ratio = 2.0 * np.pi / wave.number / dtmb5415.MODEL_LENGTH
                counted.append((ratio >= dtmb5415.LONG, ratio <= dtmb5415.RESONANT))
            assert counted[0] == counted[1]
