"""Hulls from offsets and panels of other programs, on boxes and wedges with closed forms."""

from math import cos, exp, pi, sin
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics.capytaine_worker import MetWave
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.base import Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.hull.submerged import wetted_triangles
from boatsim.physics.particulars import GRAVITY
from validation.waves import hemisphere, s175, wamit_ships
from validation.waves.offsets import (
    Offsets,
    Station,
    extract,
    lofted,
    mgf_in_archive,
    parse_mgf,
    submerged_half,
)
from validation.waves.speed_diffraction import MovingHull
from validation.waves.veres_coefficients import read_veres_coefficients

LENGTH, BEAM, DRAUGHT, DECK = 60.0, 8.0, 3.0, 5.0  # [m]
MGF = """ship
 
 
 
60.0
2
-30.0
3
4.0 5.0
4.0 0.0
0.0 0.0
1
30.0
2
0.0 0.5
3.0 5.0
"""


def box_offsets() -> Offsets:
    """Box, whose sections have no point in the centre plane."""
    points = np.array([[0.5 * BEAM, 0.0], [0.5 * BEAM, DECK]])
    places = (-0.5 * LENGTH, -3.0, 0.5 * LENGTH)
    return Offsets(LENGTH, tuple(Station(x, points) for x in places))


def wedge_offsets() -> Offsets:
    """Prism of V-shaped sections, which are as wide as the box at the waterline."""
    points = np.array([[0.0, 0.0], [0.5 * BEAM * DECK / DRAUGHT, DECK]])
    return Offsets(LENGTH, (Station(-0.5 * LENGTH, points), Station(0.5 * LENGTH, points)))


def volumes(triangles: Array) -> Array:
    """Volume (3,) by the integrals over x, y and z; equal if only the waterplane is open."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    areas = 0.5 * np.cross(b - a, c - a)
    return np.asarray(np.sum((a + b + c) / 3.0 * areas, axis=0))


def metacentre(triangles: Array) -> float:
    """Height of the metacentre above the keel [m], KB + BM, with z = 0 at the waterline."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    plane = -0.5 * np.cross(b - a, c - a)[:, 2]
    middles = 0.5 * np.stack([a + b, b + c, c + a], axis=1)
    x, y, z = np.moveaxis(middles, -1, 0)
    volume = float(plane @ -z.mean(axis=1))
    depth = float(plane @ (z * z).mean(axis=1)) / 2.0 / volume
    return DRAUGHT - depth + float(plane @ (y * y).mean(axis=1)) / volume


def test_sections_are_read_from_bow_to_stern_and_from_deck_to_keel() -> None:
    found = parse_mgf(MGF, "ship.mgf")
    assert found.length == 60.0
    stern, bow = found.stations
    assert (stern.x, bow.x) == (-30.0, 30.0)  # the file has x aft
    assert bow.points == pytest.approx(np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 5.0]]))
    assert stern.points == pytest.approx(np.array([[0.0, 0.5], [3.0, 5.0]]))


@pytest.mark.parametrize(
    "text, words",
    [
        (MGF.replace("60.0", "long"), "'long' is not a number"),
        (MGF.rsplit("\n", 2)[0], "ends early"),
        ("\n" * 4 + "60.0\n1\n0.0\n2\n0 0\n1 2\n", "1 sections"),
        (MGF.replace("30.0\n2\n0.0 0.5\n3.0 5.0", "30.0\n1\n0.0 0.5"), "1 points"),
    ],
)
def test_files_of_another_form_are_refused(text: str, words: str) -> None:
    with pytest.raises(BadInput, match=words):
        parse_mgf(text, "ship.mgf")


def test_an_archive_has_one_file_of_each_ending(tmp_path: Path) -> None:
    path = tmp_path / "ship.shipx_ship"
    with ZipFile(path, "w") as archive:
        archive.writestr("a\\b\\geometry.mgf", MGF)
        archive.writestr("a\\result\\input.re7", "numbers")
        archive.writestr("b\\result\\input.re1", "first")
        archive.writestr("c\\result\\input.re1", "second")
    assert mgf_in_archive(path) == MGF
    assert extract(path, ".re7", tmp_path / "work").read_text() == "numbers"
    with pytest.raises(BadInput, match="2 files"):
        extract(path, ".re1", tmp_path)
    path.write_text("no archive")
    with pytest.raises(BadInput, match="cannot be read"):
        mgf_in_archive(path)


def test_points_of_a_section_have_equal_distances() -> None:
    found = submerged_half(box_offsets().stations[0], DRAUGHT, 14)
    assert found[0] == pytest.approx([0.0, 0.0]) and found[-1] == pytest.approx([4.0, 3.0])
    steps = np.hypot(*np.diff(found, axis=0).T)
    assert steps == pytest.approx(np.full(14, (4.0 + 3.0) / 14))


def test_a_lofted_box_has_volume_and_metacentre_of_a_wall_sided_hull() -> None:
    triangles = lofted(box_offsets(), DRAUGHT, 5.0, 7)
    assert volumes(triangles) == pytest.approx(np.full(3, LENGTH * BEAM * DRAUGHT), rel=1e-12)
    assert metacentre(triangles) == pytest.approx(
        0.5 * DRAUGHT + BEAM**2 / (12.0 * DRAUGHT), rel=1e-12
    )
    stations = np.unique(np.round(triangles[..., 0], 6))
    assert np.diff(stations).max() <= 5.0 and -3.0 in stations


def test_a_lofted_wedge_has_volume_and_metacentre_of_the_prism() -> None:
    triangles = lofted(wedge_offsets(), DRAUGHT, 60.0, 5)
    half = 0.5 * LENGTH * BEAM * DRAUGHT
    assert volumes(triangles) == pytest.approx(np.full(3, half), rel=1e-12)
    expected = 2.0 * DRAUGHT / 3.0 + BEAM**2 / (6.0 * DRAUGHT)
    assert metacentre(triangles) == pytest.approx(expected, rel=1e-12)


def test_a_hull_without_sections_in_the_water_is_refused() -> None:
    with pytest.raises(BadInput, match="0 sections"):
        lofted(box_offsets(), DECK + 1.0, 5.0, 4)


def write_re7(path: Path) -> Path:
    """File of VERES with two speeds, one heading and two frequencies."""
    lines = ["text"] * 6 + ["1025.0 9.81", "175.0 25.4 9.5", "2.5 9.6", "-1 2", "2 1 2 6"]
    matrix = np.arange(36.0).reshape(6, 6)
    lines += [" ".join(f"{x}" for x in row) for row in matrix]
    for speed in (0.0, 10.0):
        lines += [f"{speed} 0 0 2.5 9.5", "180.0"]
        for w in (0.5, 0.7):
            lines.append(f"{w}")
            for number in range(6):
                rows = matrix + 100.0 * number + 1000.0 * speed + w
                lines += [" ".join(f"{x}" for x in row) for row in rows]
            lines.append("0.1D+01 0.2D+09 0.4D+01")
    path.write_text("\n".join(lines) + "\n")
    return path


def test_coefficients_of_veres_are_read_in_sname_axes(tmp_path: Path) -> None:
    found = read_veres_coefficients(write_re7(tmp_path / "input.re7"))
    assert (found.length, found.draught, found.centre) == (175.0, 9.5, (-2.5, 9.6))
    assert found.speed == pytest.approx([0.0, 10.0])
    assert found.heading == pytest.approx([0.0])  # 180 deg is from astern
    assert found.frequency == pytest.approx([0.5, 0.7])
    # x aft and z up become x ahead and z down: heave on pitch keeps its place and changes its sign
    assert found.body[2, 4] == -16.0 and found.body[2, 2] == 14.0
    for number, table in enumerate(
        (found.added_mass, found.more_added_mass, found.damping, found.more_damping)
    ):
        assert table.shape == (2, 1, 2, 6, 6)
        assert table[1, 0, 1, 3, 3] == pytest.approx(21.0 + 100.0 * number + 10000.7)
        assert table[1, 0, 1, 1, 3] == pytest.approx(-(9.0 + 100.0 * number + 10000.7))
    assert found.stiffness[0, 0, 0, 2, 2] == pytest.approx(2.0 * 14.0 + 900.0 + 1.0)
    assert found.viscous == pytest.approx(np.full((2, 1, 2), 5.0))


def test_a_file_of_veres_that_ends_early_is_refused(tmp_path: Path) -> None:
    path = write_re7(tmp_path / "input.re7")
    path.write_text(path.read_text().rsplit("\n", 3)[0])
    with pytest.raises(BadInput, match="numbers; the file states"):
        read_veres_coefficients(path)


def write_gdf(path: Path) -> Path:
    """Panels of the half of a box to port: bottom, side and ends."""
    x, y, z = 0.5 * LENGTH, 0.5 * BEAM, -DRAUGHT
    panels = (
        ((-x, 0, z), (-x, y, z), (x, y, z), (x, 0, z)),
        ((-x, y, z), (-x, y, 0), (x, y, 0), (x, y, z)),
        ((x, 0, z), (x, y, z), (x, y, 0), (x, 0, 0)),
        ((-x, 0, z), (-x, 0, 0), (-x, y, 0), (-x, y, z)),
    )
    lines = ["a box", "1.0 9.81 ULEN GRAV", "0 1 ISX ISY", str(len(panels))]
    for panel in panels:
        lines += [" ".join(f"{value}" for value in corner) for corner in panel]
    path.write_text("\n".join(lines) + "\n")
    return path


def test_panels_of_wamit_become_a_hull_of_both_sides(tmp_path: Path) -> None:
    triangles = wamit_ships.read_gdf(write_gdf(tmp_path / "box.gdf"))
    assert triangles.shape == (16, 3, 3)
    assert volumes(triangles) == pytest.approx(np.full(3, LENGTH * BEAM * DRAUGHT), rel=1e-12)
    (tmp_path / "box.gdf").write_text("a box\n1.0\n")
    with pytest.raises(BadInput, match="panels cannot be read"):
        wamit_ships.read_gdf(tmp_path / "box.gdf")


def floating_box() -> Coefficients:
    """Coefficients of the box without water that moves with it."""
    nothing = np.zeros((6, 6))
    return Coefficients(
        source="box",
        density=1025.0,
        depth=0.0,
        draught=DRAUGHT,
        volume=LENGTH * BEAM * DRAUGHT,
        buoyancy=np.array([2.0, 0.0, 0.5 * DRAUGHT]),
        restoring=nothing,
        frequency=np.array([1.0]),
        added_mass=nothing[None],
        damping=nothing[None],
        infinite_added_mass=nothing,
        heading=np.array([pi]),
        excitation=np.zeros((1, 1, 6)),
    )


def test_both_forms_of_the_mass_of_wamit_are_the_same_body(tmp_path: Path) -> None:
    box = floating_box()
    mass = box.density * box.volume
    gyradii, height = np.array([3.0, 15.0, 16.0]), -0.8
    short = tmp_path / "short.frc"
    radii = [" ".join(f"{x}" for x in row) for row in np.diag(gyradii)]
    short.write_text("\n".join(["text", "1 0 1 1", f"{height}", *radii, "0", "0"]))
    matrix = np.diag([mass, mass, mass, *(mass * gyradii**2)])
    x = float(box.buoyancy[0])
    # z up, and z the height of the mass centre: J. N. Newman, Marine Hydrodynamics, 1977, eq. 141
    for i, j, value in ((0, 4, height), (1, 3, -height), (1, 5, x), (2, 4, -x)):
        matrix[i, j] = matrix[j, i] = mass * value
    damping = np.zeros((6, 6))
    damping[3, 3] = 7.0
    rows = [" ".join(f"{x}" for x in row) for row in matrix]
    more = [" ".join(f"{x}" for x in row) for row in damping]
    long = tmp_path / "long.frc"
    head = ["text", "1 0 1 1", "1025.0", f"{x} 0 {height}", "1"]
    long.write_text("\n".join([*head, *rows, "1", *more, "0"]))
    first, second = (wamit_ships.read_mass(path, box) for path in (short, long))
    assert first.body == pytest.approx(second.body, rel=1e-12, abs=1e-6)
    assert first.mass == pytest.approx(mass) and first.depth == second.depth == 0.8
    assert second.damping[3, 3] == 7.0 and not first.damping.any()
    long.write_text("text\n")
    with pytest.raises(BadInput, match="mass cannot be read"):
        wamit_ships.read_mass(long, box)


def test_pressure_of_an_undisturbed_wave_on_a_box_is_its_integral() -> None:
    triangles = lofted(box_offsets(), DRAUGHT, 0.5, 60)
    wave = s175.UndisturbedWave(wetted_triangles(triangles * np.array([1.0, -1.0, -1.0])), 1025.0)
    for w in (0.3, 1.0):
        k = w * w / GRAVITY
        size = 1025.0 * GRAVITY
        head, beam = wave(w, s175.HEAD), wave(w, s175.BEAM)
        along = 2.0 * sin(0.5 * k * LENGTH) / k
        across = 2.0 * sin(0.5 * k * BEAM) / k
        # z is down, and the crest lifts
        assert head[2] == pytest.approx(-size * BEAM * along * exp(-k * DRAUGHT), rel=1e-3)
        assert beam[2] == pytest.approx(-size * LENGTH * across * exp(-k * DRAUGHT), rel=1e-3)
        deep = (1.0 - exp(-k * DRAUGHT)) / k
        sway = 2.0j * size * LENGTH * sin(0.5 * k * BEAM) * deep
        # a crest that has passed to starboard presses the hull to port
        assert beam[1] == pytest.approx(sway, rel=1e-3)


def test_frequency_of_encounter_grows_in_head_waves_alone() -> None:
    w, speed = 0.6, 10.0
    assert s175.encounter(w, s175.HEAD, speed) == pytest.approx(w + w * w / GRAVITY * speed)
    assert s175.encounter(w, s175.BEAM, speed) == w
    assert s175.encounter(w, 0.25 * pi, speed) == pytest.approx(
        w - w * w / GRAVITY * speed * cos(0.25 * pi)
    )


def motion(ratio: float, error: float, axis: int = s175.HEAVE) -> s175.Motion:
    """Motion at rest in head waves with an error, which is 0 with the second method."""
    return s175.Motion(0.0, s175.HEAD, ratio, axis, 0.5, (0.5 * (1.0 + error), 0.5))


def test_errors_are_counted_near_the_resonance_of_each_motion() -> None:
    rows = [motion(0.9, 0.9), motion(1.2, -0.08), motion(2.0, 0.3), motion(2.5, 0.9)]
    rows.append(motion(1.2, 0.7, s175.PITCH))
    found = s175.errors(rows, 0.0, s175.HEAD, s175.HEAVE, 0)
    assert found == pytest.approx((1, 2, 0.3, 0.19))
    assert s175.errors(rows, 0.0, s175.HEAD, s175.HEAVE, 1) == pytest.approx((2, 2, 0.0, 0.0))
    assert s175.errors(rows, 0.0, s175.HEAD, s175.PITCH, 0)[:2] == (0, 1)
    finer = [*rows[:2], motion(2.0, 0.04), *rows[3:]]
    assert s175.largest_change(rows, finer, s175.HEAVE) == pytest.approx(0.2)
    pairs = [wamit_ships.Pair(2.0, 2.0 * (1.0 + error)) for error in (-0.029, 0.029, 0.031)]
    assert wamit_ships.within(pairs) == 2


@pytest.fixture(scope="module")
def half_sphere(tmp_path_factory: pytest.TempPathFactory) -> HullMesh:
    """A coarse hemisphere."""
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    path = tmp_path_factory.mktemp("hemisphere") / "hemisphere.stl"
    hemisphere.write_hemisphere(path, 4, 16)
    return HullMesh(path, hemisphere.RADIUS / hemisphere.volume_share(4, 16) ** (1.0 / 3.0))


def test_diffraction_at_rest_is_that_of_the_coefficients(half_sphere: HullMesh) -> None:
    w, heading = 2.5, 0.7 * pi
    rows = run_capytaine(half_sphere, [w], [heading], lambda stage, share: None)
    expected = coefficients_of_rows(rows, half_sphere, [heading]).excitation[0, 0]
    found = MovingHull(half_sphere).excitation(MetWave(w, w, heading, 0.0))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def test_scattered_long_waves_are_radiated_at_the_frequency_of_encounter(
    half_sphere: HullMesh,
) -> None:
    """In a long wave the water rises as one body, and the hull radiates the opposite motion."""
    long, met, speed = 0.05, 2.5, 3.0
    rows = run_capytaine(half_sphere, [met], [pi], lambda stage, share: None)
    table = coefficients_of_rows(rows, half_sphere, [pi])
    impedance = table.damping[0, 2, 2] + 1j * met * table.added_mass[0, 2, 2]
    moving = MovingHull(half_sphere)
    found = moving.excitation(MetWave(long, met, pi, 0.0))
    # at another frequency of encounter, so high that no waves are radiated, the undisturbed part is
    # the same: the difference of both is that of the scattered waves
    other = 4.0
    more = run_capytaine(half_sphere, [other], [pi], lambda stage, share: None)
    second = coefficients_of_rows(more, half_sphere, [pi])
    there = second.damping[0, 2, 2] + 1j * other * second.added_mass[0, 2, 2]
    difference = found[2] - moving.excitation(MetWave(long, other, pi, 0.0))[2]
    assert difference == pytest.approx(-1j * long * (impedance - there), rel=0.01)
    # the moment at a speed, of the heave force of the scattered waves
    turned = moving.excitation(MetWave(long, met, pi, speed))[4] - found[4]
    scattered = -1j * long * impedance
    assert turned == pytest.approx(-speed / (1j * met) * scattered, rel=0.01)
