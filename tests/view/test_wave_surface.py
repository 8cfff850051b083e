"""The drawn surface of the sea is the field of waves that act on the boat."""

from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

from boatsim.physics.waves.field import WaveField
from boatsim.recordings.table import Recording
from boatsim.view.rerun_log import RerunLog
from boatsim.view.scene import plain_scene
from boatsim.view.wave_surface import POINTS, WaveSurface

WAVES = WaveField(
    np.array([0.2, 0.1]),
    np.array([pi, 5.0]),
    np.array([1.0, 2.5]),
    np.array([0.4, -1.0]),
    np.array([0.0, 2.0]),
)
TANK = plain_scene(1.2, 0.3, (6.0, 4.0, 1.0, -2.0))
OPEN = replace(TANK, open=True)


@pytest.mark.parametrize(("scene", "middle"), [(OPEN, (30.0, -8.0)), (TANK, (1.0, -2.0))])
def test_points_lie_on_the_field_and_normals_stand_on_it(
    scene: object, middle: tuple[float, float]
) -> None:
    surface = WaveSurface.for_scene(WAVES, scene)  # type: ignore[arg-type]
    points, normals = surface.vertices(30.0, -8.0, 3.3)
    x, y = points[:, 0], -points[:, 1]
    assert points[:, 2] == pytest.approx(WAVES.elevation(x, y, 3.3), abs=1e-12)
    assert (x.mean(), y.mean()) == pytest.approx(middle)
    assert (np.ptp(x), np.ptp(y)) == pytest.approx((6.0, 4.0))
    corners = points[surface.triangles()]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (faces[:, 2] > 0.0).all() and len(faces) == 2 * (POINTS - 1) ** 2
    faces /= np.linalg.norm(faces, axis=1, keepdims=True)
    assert np.abs(np.sum(faces * normals[surface.triangles()[:, 0]], axis=1) - 1.0).max() < 0.05


def test_frames_have_their_step_however_the_rows_arrive(tmp_path: Path) -> None:
    t = np.round(0.02 * np.arange(251), 10)
    surface = WaveSurface.for_scene(WAVES, OPEN)
    assert surface.step == pytest.approx(1 / 6)
    whole = surface.rows_of_frames(t)
    assert np.diff(t[whole]) == pytest.approx(1 / 6, abs=0.02) and len(whole) == 31
    found, last = [], -np.inf
    for row in range(len(t)):
        if len(surface.rows_of_frames(t[row : row + 1], last)):
            found.append(row)
            last = t[row]
    assert found == whole.tolist()


def test_a_log_of_a_run_in_waves_has_the_surface_and_no_still_water(tmp_path: Path) -> None:
    t = np.round(0.02 * np.arange(251), 10)
    rows = Recording("run", t, {"x_m": 0.1 * t, "y_m": 0.0 * t, "psi_rad": 0.0 * t})
    frames = {}
    for name, waves in (("sea", WAVES), ("calm", WaveField.calm())):
        with RerunLog(tmp_path / f"{name}.rrd", OPEN, waves=waves) as log:
            log.add_rows(rows)
        frames[name] = 0
        for chunk in RrdReader(tmp_path / f"{name}.rrd").stream():
            if str(chunk.entity_path) == "/world/sea" and not chunk.is_static:
                frames[name] += chunk.num_rows
    assert frames == {"sea": 31, "calm": 0}
