"""The boundary element method against published values, where Capytaine is installed."""

from pathlib import Path
from typing import Any

import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics import computation
from validation.waves.drift import cylinder_drift, section_drift
from validation.waves.hemisphere import comparison


def test_missing_capytaine_is_answered_by_the_command_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(_: str) -> Any:
        return None

    monkeypatch.setattr(computation, "find_spec", nothing)
    hull = computation.HullMesh(tmp_path / "hull.stl", 0.1)
    with pytest.raises(BadInput, match=r'pip install "boatsim\[bem\]"'):
        computation.mesh_size(hull)


@pytest.mark.slow
def test_hemisphere_has_the_coefficients_of_hulme(tmp_path: Path) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    for row in comparison(tmp_path):
        assert row.added_mass[0] == pytest.approx(row.added_mass[1], rel=0.015)
        assert row.damping[0] == pytest.approx(row.damping[1], abs=0.015 * row.largest)


@pytest.mark.slow
def test_mean_drift_of_a_deep_cylinder_is_that_of_havelock(tmp_path: Path) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    for row in cylinder_drift(tmp_path):
        assert row.force == pytest.approx(row.exact, rel=0.03)
        assert abs(row.energy) < 0.02


@pytest.mark.slow
def test_mean_drift_of_a_section_is_that_of_maruo(tmp_path: Path) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    rows = section_drift(tmp_path)
    largest = max(row.maruo for row in rows)
    for row in rows:
        assert row.far_field == pytest.approx(row.maruo, rel=0.1, abs=0.01 * largest)
