"""The boundary element method against published values, where Capytaine is installed."""

from pathlib import Path
from typing import Any

import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics import computation
from validation.waves import cylinder, wigley
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


# Errors that are allowed with a thousand panels: added mass, damping, excitation. The moments on
# side and bottom of the cylinder nearly cancel each other in pitch
CYLINDER_LIMITS = {
    "surge": (0.02, 0.025, 0.01),
    "heave": (0.025, 0.02, 0.01),
    "pitch": (0.05, 0.25, 0.13),
}


@pytest.mark.slow
@pytest.mark.parametrize("depth", cylinder.DEPTHS)
def test_truncated_cylinder_has_the_coefficients_of_its_eigenfunctions(
    depth: float, tmp_path: Path
) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    for row in cylinder.compared(tmp_path, depth):
        errors = (row.added_mass.error, row.damping.error, row.excitation.error)
        assert errors == tuple(map(min, errors, CYLINDER_LIMITS[row.axis])), row


@pytest.mark.slow
def test_errors_of_the_truncated_cylinder_fall_with_the_size_of_its_panels(tmp_path: Path) -> None:
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    by_mesh = [
        cylinder.compared(tmp_path, cylinder.DEPTHS[1], panels) for panels in cylinder.PANELS[:2]
    ]
    for coarse, fine in zip(*by_mesh, strict=True):
        for name in ("added_mass", "damping", "excitation"):
            before, after = getattr(coarse, name).error, getattr(fine, name).error
            assert after < max(before / 1.7, 0.002), (fine.axis, fine.number, name)


@pytest.mark.slow
@pytest.mark.parametrize("hull", wigley.HULLS, ids=lambda hull: hull.name)
def test_wigley_hulls_heave_and_pitch_in_head_waves_as_their_models(
    hull: wigley.Hull, tmp_path: Path
) -> None:
    """Waves of a length and more; the models scatter by some 10 % between neighbouring waves."""
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    rows = wigley.responses(tmp_path, hull)
    panels, strips = (wigley.long_wave_errors(rows, name) for name in ("panels", "strips"))
    assert panels.largest[0] < 0.12 and panels.largest[1] < 0.2
    assert strips.largest[0] < 0.28 and strips.largest[1] < 0.2
    assert abs(panels.mean[0]) < 0.06 and abs(panels.mean[1]) < 0.13
