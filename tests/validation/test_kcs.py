"""Comparison of a container ship with model tests, checked on hulls with closed forms."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.hydrodynamics.response import Ballast, floating_response
from boatsim.physics.base import AXES
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves import kcs
from validation.waves.hull_at_speed import (
    HullAtSpeed,
    Loading,
    Wave,
    radiated_force,
    undisturbed_heave,
)
from validation.waves.loft import Panels, Station, half_breadth_of, hydrostatics, loft, section_area
from validation.waves.response import DEPTH, INERTIA, OTTER
from validation.waves.ship_speed import METHODS, radiation, speed_terms

TABLE = """TWO STATIONS: a name with spaces
   2
   0.0   3
   0.0  1.0  2.0
   0.0  0.5  3.0
   4.0   2
   1.5  1.5
   0.0  3.0
"""
DRAUGHT, DENSITY = 3.0, 1000.0  # [m], [kg/m^3]


def written(folder: Path, text: str) -> Path:
    """File with a table of offsets."""
    path = folder / kcs.OFFSETS
    path.write_text(text, encoding="ascii")
    return path


def test_reader_returns_the_stations_of_a_table(tmp_path: Path) -> None:
    first, second = kcs.read_offsets(written(tmp_path, TABLE))
    assert (first.x, second.x) == (0.0, 4.0)
    assert first.half_breadth.tolist() == [0.0, 1.0, 2.0]
    assert first.height.tolist() == [0.0, 0.5, 3.0]
    assert second.half_breadth.tolist() == [1.5, 1.5]
    assert second.height.tolist() == [0.0, 3.0]


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ("spaces\n   2", "spaces\n   3", "2 stations; its second line states 3"),
        ("spaces\n   2", "spaces\n   1", "6 numbers follow the last station"),
        ("4.0   2", "4.0   3", "station 2 has 4 numbers; its 3 points need 6"),
        ("4.0   2", "0.0   2", "station 2 at 0 m; allowed is above 0 m"),
        ("0.0  0.5  3.0", "0.0  3.0  0.5", "station 1 has heights that decrease"),
        ("1.5  1.5", "1.5 -1.5", "station 2 has a half-breadth of -1.5 m"),
        ("1.5  1.5", "1.5  wide", "wide"),
        ("1.5  1.5", "1.5  nan", "numbers that are not finite"),
    ],
)
def test_damaged_table_is_refused_in_one_line(
    tmp_path: Path, before: str, after: str, words: str
) -> None:
    path = written(tmp_path, TABLE.replace(before, after))
    with pytest.raises(BadInput) as error:
        kcs.read_offsets(path)
    message = str(error.value)
    assert message.startswith(str(path)) and words in message and "\n" not in message


def test_missing_table_and_table_without_numbers_are_refused(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="there is no such file"):
        kcs.read_offsets(tmp_path / kcs.OFFSETS)
    with pytest.raises(BadInput, match="0 numbers"):
        kcs.read_offsets(written(tmp_path, "only a name\n"))


def wall_sided(length: float, beam: float, count: int, top: float = 6.0) -> list[Station]:
    """Stations of a hull with vertical sides, a flat bottom and a waterplane of two parabolas."""
    stations = []
    for x in np.linspace(0.0, length, count):
        half = 0.5 * beam * (1.0 - (2.0 * x / length - 1.0) ** 2)
        width = np.array([0.0, half, half])
        stations.append(Station(float(x), width, np.array([0.0, 0.0, top])))
    return stations


def test_box_has_its_volume_waterplane_and_metacentre_exactly() -> None:
    length, beam = 10.0, 4.0
    box = []
    for x in (0.0, 3.0, length):
        box.append(Station(x, np.array([0.0, 2.0, 2.0]), np.array([0.0, 0.0, 5.0])))
    for panels in (Panels(1, 1, 1), Panels(5, 3, 2)):
        found = hydrostatics(loft(box, DRAUGHT, panels))
        assert found.volume == pytest.approx(length * beam * DRAUGHT, rel=1e-12)
        assert found.centre == pytest.approx([0.5 * length, 0.0, -0.5 * DRAUGHT], abs=1e-12)
        assert found.waterplane == pytest.approx(length * beam, rel=1e-12)
        assert found.metacentre == pytest.approx(beam**2 / (12.0 * DRAUGHT), rel=1e-12)
    assert section_area(box[1], DRAUGHT) == pytest.approx(beam * DRAUGHT, rel=1e-12)


def test_wall_sided_hull_converges_to_its_closed_form() -> None:
    """Areas of parabolas: 2 / 3 of length and beam, and 16 / 35 of the cube of the half-breadth."""
    length, beam = 40.0, 6.0
    stations = wall_sided(length, beam, 41)
    area = 2.0 / 3.0 * length * beam
    second = 2.0 / 3.0 * (0.5 * beam) ** 3 * length * 16.0 / 35.0
    errors = []
    for number in (12, 24, 48):
        found = hydrostatics(loft(stations, DRAUGHT, Panels(number, 4, 2)))
        exact = np.array([area * DRAUGHT, area, second / (area * DRAUGHT)])
        own = np.array([found.volume, found.waterplane, found.metacentre])
        errors.append(np.abs(own / exact - 1.0).max())
        assert found.centre == pytest.approx([0.5 * length, 0.0, -0.5 * DRAUGHT], abs=1e-9)
    assert errors[2] < 0.003
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]


def test_loft_is_closed_but_for_the_waterplane_and_faces_the_water() -> None:
    """Of a hull with a bulb below the waterline, a skeg, and an end with a breadth."""
    heights = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    stations = [
        Station(-1.0, np.zeros(5), heights),
        Station(0.0, np.array([0.0, 0.0, 0.0, 1.0, 1.5]), heights),  # centre plane below 2 m
        Station(5.0, np.array([2.0, 2.0, 2.0, 2.0, 2.0]), heights),
        Station(9.0, np.array([0.0, 0.8, 0.2, 0.3, 0.9]), heights),
        Station(10.0, np.array([0.0, 0.6, 0.0, 0.0, 0.5]), heights),  # bulb
    ]
    triangles = loft(stations, DRAUGHT, Panels(40, 12, 3))
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = 0.5 * np.cross(b - a, c - a)
    middle = triangles.mean(axis=1)
    total = normal.sum(axis=0)
    found = hydrostatics(triangles)
    assert total[:2] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert total[2] == pytest.approx(-found.waterplane, rel=1e-12)
    # the divergence theorem along each axis; at z = 0 the open waterplane contributes nothing
    for axis in range(3):
        assert float(normal[:, axis] @ middle[:, axis]) == pytest.approx(found.volume, rel=1e-9)
    assert (np.abs(triangles[..., 1]).max(axis=1) > 0.0).all()  # nothing in the centre plane
    assert triangles[..., 0].min() == -1.0 and triangles[..., 0].max() == 10.0


def test_half_breadth_is_that_of_the_stations_and_zero_outside_of_their_heights() -> None:
    stations = wall_sided(40.0, 6.0, 9)
    half = half_breadth_of(stations)
    for station in stations:
        own = half(np.array([station.x]), np.array([1.0]))
        assert own[0] == pytest.approx(station.half_breadth[-1], abs=1e-12)
    assert half(np.array([20.0, 20.0]), np.array([-0.1, 6.1])).tolist() == [0.0, 0.0]


def test_hull_without_stations_below_the_waterline_is_refused() -> None:
    stations = wall_sided(40.0, 6.0, 9)
    with pytest.raises(BadInput, match="1 stations; allowed are 2"):
        loft(stations[:1], DRAUGHT, Panels(4, 2, 1))
    with pytest.raises(BadInput, match="no station has a breadth"):
        loft(stations, -1.0, Panels(4, 2, 1))


def test_radiation_at_speed_is_that_of_strip_theory_in_all_axes() -> None:
    random = np.random.default_rng(1)
    added, damping = random.normal(size=(2, 6, 6))
    added, damping = added + added.T, damping + damping.T
    # a hull that is symmetric to its centre plane has no coupling between these sets of axes
    for matrix in (added, damping):
        for i in (0, 2, 4):
            for j in (1, 3, 5):
                matrix[i, j] = matrix[j, i] = 0.0
    w, speed, limit = 0.7, 3.0, np.eye(6)
    a, b = speed_terms(added, damping, w, speed)
    found = radiated_force(added, damping, limit, w, speed, METHODS[-1])
    # the table of the ship leaves out the terms with surge, which are those of the same motions
    axes = np.ix_([1, 2, 3, 4, 5], [1, 2, 3, 4, 5])
    assert found[axes] == pytest.approx((1j * w * b - w * w * a)[axes], rel=1e-12, abs=1e-12)
    two = np.ix_([2, 4], [2, 4])
    for method in METHODS:
        own = radiated_force(added, damping, limit, w, speed, method)[two]
        expected = radiation(added[two], damping[two], limit[two], w, speed, method)
        assert own == pytest.approx(expected, rel=1e-12)


def test_undisturbed_wave_lifts_a_box_as_its_pressure_on_the_bottom() -> None:
    length, half = 10.0, 2.0
    box = []
    for x in (-0.5 * length, 0.5 * length):
        box.append(Station(x, np.array([0.0, half, half]), np.array([0.0, 0.0, 5.0])))
    wet = loft(box, DRAUGHT, Panels(80, 2, 20))
    for direction in (0.0, 0.25 * np.pi, np.pi):
        wave = Wave(15.0, direction, 0.0)
        k = wave.number
        along, across = k * np.cos(direction), k * np.sin(direction)
        area = length * 2.0 * half
        area *= np.sinc(0.5 * along * length / np.pi) * np.sinc(across * half / np.pi)
        expected = -DENSITY * GRAVITY * np.exp(-k * DRAUGHT) * area
        found = undisturbed_heave(wet, wave, DENSITY)
        assert found == pytest.approx(expected, rel=2e-3)


def test_frequency_of_encounter_is_that_of_waves_met_by_a_moving_hull() -> None:
    wave = Wave(100.0, np.pi, 5.0)
    speed = np.sqrt(GRAVITY * 100.0 / (2.0 * np.pi))  # of the crests in deep water
    assert wave.encounter == pytest.approx(2.0 * np.pi * (speed + 5.0) / 100.0)
    assert Wave(100.0, 0.0, float(speed)).encounter == pytest.approx(0.0, abs=1e-12)
    assert Wave(100.0, 0.5 * np.pi, 5.0).encounter == pytest.approx(wave.frequency)
    for one in (*kcs.head_waves(), *kcs.oblique_waves()):
        assert one.speed / np.sqrt(GRAVITY * kcs.LENGTH) == pytest.approx(0.26, abs=0.002)


def floating_catamaran(roll_damping: float) -> tuple[HullAtSpeed, Ballast]:
    """The catamaran of the Otter's particulars, with its centre of buoyancy at the origin."""
    found = read_coefficients(OTTER)
    found = replace(found, buoyancy=found.buoyancy * np.array([0.0, 1.0, 1.0]))
    mass = found.density * found.volume
    gyradii = np.sqrt(np.array(INERTIA) / mass)
    roll, pitch, yaw = gyradii.tolist()
    ballast = Ballast(DEPTH, (roll, pitch, yaw), roll_damping)
    height = float(found.restoring[3, 3]) / (mass * GRAVITY) + DEPTH
    loading = Loading(DEPTH, height, (roll, pitch, yaw), roll_damping)
    return HullAtSpeed(found, loading, np.zeros((1, 3, 3)), 0.0), ballast


def test_motion_at_rest_is_that_of_the_response_about_the_waterline() -> None:
    moving, ballast = floating_catamaran(0.0)
    found = moving.found
    expected, _ = floating_response(found, ballast)
    for row in (3, 12, 20):
        for column in (2, 5, 9):
            w, direction = float(found.frequency[row]), float(found.heading[column])
            wave = Wave(2.0 * np.pi * GRAVITY / w**2, direction, 0.0)
            own = moving.motion(wave, AXES, METHODS[-1], True)
            about = expected[row, column].copy()
            # the mass centre moves with the waterline and turns about it
            about[0] += DEPTH * about[4]
            about[1] -= DEPTH * about[3]
            assert own == pytest.approx(about, rel=1e-6, abs=1e-9)


def test_held_axes_do_not_move_and_viscous_damping_makes_roll_smaller() -> None:
    free, _ = floating_catamaran(0.0)
    damped, _ = floating_catamaran(0.2)
    w = float(free.found.frequency[10])
    wave = Wave(2.0 * np.pi * GRAVITY / w**2, float(free.found.heading[6]), 0.0)
    first = free.motion(wave, kcs.FOUR, METHODS[0])
    second = damped.motion(wave, kcs.FOUR, METHODS[0])
    assert first[1] == first[5] == 0.0
    assert abs(second[3]) < abs(first[3])
    assert second[[2, 4]] == pytest.approx(first[[2, 4]], rel=1e-9)


class Following:
    """A hull that follows the surface of a wave at its mass centre."""

    place = 100.0  # [m]

    def motion(
        self,
        wave: Wave,
        free: tuple[str, ...],
        method: str,
        diffraction: bool = False,
        excitation: np.ndarray | None = None,
    ) -> np.ndarray:
        """Heave down by the elevation, roll and pitch by its slopes."""
        found = np.zeros(6, dtype=np.complex128)
        found[2] = -1.0
        found[3] = 1j * wave.number * np.sin(wave.direction)
        found[4] = -1j * wave.number * np.cos(wave.direction)
        return found


def test_hull_that_follows_the_surface_has_unit_motions_and_the_phase_of_the_wave() -> None:
    following: HullAtSpeed = Following()  # type: ignore[assignment]
    for row in kcs.motions(following, [np.zeros(6, dtype=np.complex128)] * 10):
        angle = np.radians(row.angle)
        expected = {"heave": 1.0, "roll": abs(np.sin(angle)), "pitch": abs(np.cos(angle))}
        assert row.found == pytest.approx([expected[row.axis]] * 5, abs=1e-9)
        if row.case == "2.10":
            # the crest passes the forward perpendicular before the mass centre
            later = 360.0 / (row.ratio * kcs.LENGTH) * (kcs.LENGTH - Following.place)
            lead = 90.0 if row.axis == "pitch" else 0.0
            for phase in row.phase:
                assert (phase + later - lead + 180.0) % 360.0 == pytest.approx(180.0, abs=1e-6)


def motion(case: str, axis: str, ratio: float, error: float) -> kcs.Motion:
    """Motion that is computed with an error by all methods."""
    found = (0.5 * (1.0 + error),) * len(kcs.NAMES)
    return kcs.Motion(case, 0.0, ratio, axis, 0.5, found, np.nan, found)


def test_errors_are_counted_by_case_axis_and_wavelength() -> None:
    rows = [
        motion("2.10", "heave", 0.65, 0.9),
        motion("2.10", "heave", 1.0, -0.08),
        motion("2.10", "heave", 1.95, 0.3),
        motion("2.10", "pitch", 1.0, 0.2),
        motion("2.11", "heave", 1.0, 0.05),
    ]
    heave = kcs.chosen(rows, "2.10", "heave")
    assert [row.ratio for row in heave] == [1.0, 1.95]
    assert kcs.errors(heave, 0) == pytest.approx((1, 0.19, 0.3))
    assert len(kcs.chosen(rows, "2.10", "heave", resonant=False)) == 3
    assert kcs.errors(kcs.chosen(rows, "2.11", "heave"), 3) == pytest.approx((1, 0.05, 0.05))


def test_particulars_are_those_of_the_stations() -> None:
    stations = wall_sided(kcs.LENGTH, kcs.BEAM, 47, 16.0)
    found = kcs.lofted(stations, kcs.RESOLUTIONS[0])
    rows = {row.name: row.found for row in kcs.particulars(found)}
    assert rows["CM"] == pytest.approx(1.0, rel=1e-9)
    assert rows["LCB"] == pytest.approx(0.0, abs=1e-9)
    assert rows["volume"] == pytest.approx(
        2.0 / 3.0 * kcs.LENGTH * kcs.BEAM * kcs.DRAUGHT, rel=0.01
    )
    assert rows["KM"] - rows["GM"] == pytest.approx(kcs.KEEL_TO_CENTRE)
