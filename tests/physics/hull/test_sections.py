"""Sections of a mesh: closed forms of a box, a wedge and Wigley's hull, and sums over the strips."""

from pathlib import Path

import hull_meshes
import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.hull.mesh import read_closed_mesh
from boatsim.physics.hull.sections import hull_sections
from boatsim.physics.hull.submerged import submerged_part

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hull.obj"


def test_strips_of_a_box_are_its_sections() -> None:
    found = hull_sections(hull_meshes.box(2.0, 0.5, 0.3).moved(0.7, 0.0, 0.1), 7, "box")
    assert found.breadth == pytest.approx(np.full(7, 0.5), rel=1e-12)
    assert found.area == pytest.approx(np.full(7, 0.5 * 0.1), rel=1e-12)
    assert (found.stern, found.bow, found.depth) == pytest.approx((-0.3, 1.7, 0.1))
    assert found.particulars() == pytest.approx(
        {
            "length": 2.0,
            "centre": 0.7,
            "hull_spacing": 0.0,
            "hull_beam": 0.5,
            "block_coefficient": 1.0,
            "waterplane_coefficient": 1.0,
            "waterplane_gyradius": 2.0 / np.sqrt(12.0),
            "flotation": 0.7,
            "buoyancy": 0.7,
        }
    )


def test_strips_of_a_wedge_are_as_wide_as_in_their_middle() -> None:
    plan = np.array([[-1.0, -0.4], [-1.0, 0.4], [1.0, 0.0]])
    points = [np.column_stack([plan, np.full(3, z)]) for z in (-0.2, 0.3)]
    found = hull_sections(hull_meshes.convex(np.concatenate(points)), 10, "wedge")
    middle = -1.0 + 0.2 * (np.arange(10) + 0.5)
    assert found.breadth == pytest.approx(0.4 * (1.0 - middle), rel=1e-12)
    assert found.area == pytest.approx(0.3 * 0.4 * (1.0 - middle), rel=1e-12)


def test_sections_of_a_wigley_hull_converge_with_the_square_of_the_panels() -> None:
    edges = np.linspace(-1.0, 1.0, 11)
    share = (np.diff(edges) - np.diff(edges**3) / 3.0) / 0.2  # mean of 1 - xi^2 in each strip
    errors = []
    for parts in (10, 20, 40):
        found = hull_sections(hull_meshes.wigley(2.0, 0.25, 0.125, parts), 10, "wigley")
        breadth = found.breadth / (0.25 * share) - 1.0
        area = found.area / (0.25 * 0.125 * 2.0 / 3.0 * share) - 1.0
        errors.append([np.abs(breadth).max(), np.abs(area).max()])
    assert max(errors[2]) < 3e-3
    for coarse, fine in zip(errors[:2], errors[1:], strict=True):
        assert np.array(coarse) / fine == pytest.approx([4.0, 4.0], rel=0.1)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_strips_add_up_to_the_volume_and_the_waterplane_of_any_hull(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(30, 3)) * [1.0, 0.3, 0.2]
    mesh = hull_meshes.convex(points).moved(0.4, 0.0, 0.05)
    found, whole = hull_sections(mesh, 13, "body"), submerged_part(mesh, 0.0)
    width = (found.bow - found.stern) / 13
    assert found.area.sum() * width == pytest.approx(whole.volume, rel=1e-12)
    assert found.breadth.sum() * width == pytest.approx(whole.area, rel=1e-12)
    assert found.spacing == 0.0
    assert min(found.breadth.min(), found.area.min()) >= 0.0


def test_two_hulls_have_the_spacing_of_their_waterplanes() -> None:
    one = hull_meshes.wigley(2.0, 0.25, 0.125, 12)
    both = hull_sections(hull_meshes.catamaran(one, 0.79), 20, "catamaran")
    single = hull_sections(one, 20, "hull")
    assert both.spacing == pytest.approx(0.79, rel=1e-9)
    assert both.breadth == pytest.approx(2.0 * single.breadth, rel=1e-9)
    own, half = both.particulars(), single.particulars()
    assert own == pytest.approx(half | {"hull_spacing": 0.79}, abs=1e-9)


def test_mesh_of_pontoons_has_their_published_coefficients() -> None:
    """Particulars of the Otter: hulls of 2 x 0.25 m, 0.79 m apart, C_B 0.4, C_w 0.75."""
    mesh = read_closed_mesh(OTTER).moved(0.0, 0.0, 0.134146341463)
    found = hull_sections(mesh, 20, "otter").particulars()
    assert found["hull_spacing"] == pytest.approx(0.79, rel=1e-5)
    assert found["length"] == pytest.approx(2.0)
    volume = found["block_coefficient"] * found["hull_beam"] * 2.0 * 0.134146341463
    assert 2.0 * volume == pytest.approx(2.0 * 0.4 * 0.25 * 2.0 * 0.134146341463, rel=0.06)


def test_hull_that_is_wider_below_the_waterline_has_its_area_and_volume() -> None:
    section = np.array([[-0.1, -0.2], [0.1, -0.2], [0.4, 0.5], [-0.4, 0.5]])
    found = hull_sections(hull_meshes.prism(section, 2.0), 5, "tumblehome")
    waterline = 0.2 + 0.6 * 0.2 / 0.7
    assert found.breadth == pytest.approx(np.full(5, waterline))
    assert found.area == pytest.approx(np.full(5, 0.5 * 0.5 * (waterline + 0.8)))
    assert found.particulars()["block_coefficient"] == 1.0


@pytest.mark.parametrize(("begin", "end"), [(0.3, 0.9), (0.0, 0.6)])
@pytest.mark.parametrize(("sign", "side"), [(1.0, "starboard"), (-1.0, "port")])
def test_hull_on_one_side_of_the_centre_plane_is_refused(
    begin: float, end: float, sign: float, side: str
) -> None:
    y = sign * np.array([begin, end])
    section = np.array([[y[0], -0.2], [y[1], -0.2], [y[1], 0.5], [y[0], 0.5]])
    words = f"off.stl: the hull lies to {side} of the centre plane, from {begin:g} to {end:g} m"
    with pytest.raises(BadInput, match=words):
        hull_sections(hull_meshes.prism(section, 2.0), 5, "off.stl")


def test_hull_above_the_water_is_refused() -> None:
    with pytest.raises(BadInput, match=r"raft.obj: the hull does not float: 0 m\^3"):
        hull_sections(hull_meshes.box(1.0, 0.5, 0.2).moved(0.0, 0.0, -0.1), 5, "raft.obj")
