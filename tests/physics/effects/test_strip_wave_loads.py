"""Loads of waves on a hull in strips: closed integrals, long waves, symmetry, boundary elements."""

from dataclasses import replace
from math import cos, pi, sin, sqrt
from pathlib import Path
from typing import Any

import hull_meshes
import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

import boatsim
from benchmarks.strip_loads import HEADINGS, errors
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import AXES, Array, Wrench, make_motion
from boatsim.physics.effects.hull_buoyancy import HullBuoyancy
from boatsim.physics.effects.strip_wave_loads import StripWaveLoads
from boatsim.physics.program import Program
from boatsim.simulate.batch import Batch

G, RHO = 9.81, 1025.0
LENGTH, BEAM, DRAUGHT = 2.0, 0.4, 0.15
# of a box whose origin is the centre of its waterplane, without added mass and damping
BOX: dict[str, Any] = {
    "length": LENGTH,
    "hull_beam": BEAM,
    "draught": DRAUGHT,
    "block_coefficient": 1.0,
    "waterplane_coefficient": 1.0,
    "waterplane_gyradius": LENGTH / sqrt(12.0),
    "spectrum": "regular",
    "significant_height": 2.0,
}
PLACES = ("flotation", "buoyancy", "sway_mass_at", "sway_mass_below", "sway_damping_at")
CATAMARAN = {"hull_spacing": 0.8, "hull_beam": 0.25}
OTTER = {"use": "strip_wave_loads", **CATAMARAN, "hull_spacing": 0.79}
OTTER_MESH = Path(__file__).parents[3] / "models" / "otter" / "hull.obj"
BY_MESH = {"use": "strip_wave_loads", "mesh": str(OTTER_MESH), "origin": -0.2}


def loads(wavelength: float = 3.0, toward: float = 0.0, **settings: Any) -> StripWaveLoads:
    """A regular wave of unit amplitude on the box."""
    frequency = sqrt(2 * pi * G / wavelength)
    zero = dict.fromkeys(PLACES, 0.0)
    for axis in AXES:
        zero |= {f"{axis}_mass": 0.0, f"{axis}_damping": 0.0}
    given = BOX | zero | {"modal_period": 2 * pi / frequency, "toward": toward} | settings
    return StripWaveLoads.from_settings(given)


def complex_loads(own: StripWaveLoads) -> Array:
    """Complex amplitudes (6,) of the wrench, for the time dependence exp(i w t)."""
    quarter = own.modal_period / 4.0
    start, later = (np.array(own.wrench(make_motion(t=t))) for t in (0.0, quarter))
    return start - 1j * later


# ---- pressure of the undisturbed wave


def pressure_on_box(k: float, toward: float, depth: float, centres: tuple[float, ...]) -> Array:
    """Integral of pressure times normal over the wetted faces, by Gauss quadrature."""
    nodes, weights = leggauss(60)

    def pressure(x: Array, y: Array, z: Array) -> Array:
        decay = np.exp(-k * z)
        if depth > 0.0:
            decay = np.cosh(k * (depth - z)) / np.cosh(k * depth)
        return RHO * G * decay * np.exp(-1j * k * (x * cos(toward) + y * sin(toward)))

    def span(low: float, high: float) -> tuple[Array, Array]:
        return 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights

    total = np.zeros(6, complex)
    for centre in centres:
        x, y, z = (
            span(-LENGTH / 2, LENGTH / 2),
            span(centre - BEAM / 2, centre + BEAM / 2),
            span(0.0, DRAUGHT),
        )
        faces = [((x, y, (np.array([DRAUGHT]), np.ones(1))), (0, 0, 1))]
        for sign in (-1, 1):
            end = (np.array([sign * LENGTH / 2]), np.ones(1))
            side = (np.array([centre + sign * BEAM / 2]), np.ones(1))
            faces += [((end, y, z), (sign, 0, 0)), ((x, side, z), (0, sign, 0))]
        for (a, b, c), normal in faces:
            points = np.meshgrid(a[0], b[0], c[0], indexing="ij")
            area = a[1][:, None, None] * b[1][None, :, None] * c[1][None, None, :]
            force = [-n * pressure(*points) * area for n in normal]
            px, py, pz = points
            fx, fy, fz = force
            moments = (py * fz - pz * fy, pz * fx - px * fz, px * fy - py * fx)
            total += [np.sum(part) for part in (*force, *moments)]
    return total


@pytest.mark.parametrize("depth", [0.0, 0.6])
@pytest.mark.parametrize("spacing", [0.0, 0.9])
@pytest.mark.parametrize("toward", [0.0, pi, pi / 2, -pi / 2, 2.4, -0.7])
@pytest.mark.parametrize("wavelength", [1.0, 3.0, 40.0])
def test_the_undisturbed_pressure_on_a_box_is_its_integral_over_the_wetted_faces(
    wavelength: float, toward: float, spacing: float, depth: float
) -> None:
    own = loads(wavelength, toward, hull_spacing=spacing, depth=depth, strips=400.0)
    field = own.wave_field()
    assert field is not None
    centres = (-spacing / 2, spacing / 2) if spacing else (0.0,)
    wanted = pressure_on_box(float(field.wave_number[0]), toward, depth, centres)
    scale = np.abs(wanted).max()
    assert complex_loads(own) == pytest.approx(wanted, rel=3e-4, abs=3e-4 * scale)


def test_the_roll_moment_of_a_catamaran_is_that_of_its_two_hulls() -> None:
    both, one = loads(2.2, 2.0, **CATAMARAN), loads(2.2, 2.0, hull_beam=0.25)
    for t, psi in ((0.0, 0.0), (0.4, 0.5)):
        total = np.zeros(6)
        for side in (-0.4, 0.4):
            x, y = -side * sin(psi), side * cos(psi)
            X, Y, Z, K, M, N = one.wrench(make_motion(t=t, x=x, y=y, psi=psi))
            total += [X, Y, Z, K + side * Z, M, N - side * X]
        assert both.wrench(make_motion(t=t, psi=psi)) == pytest.approx(total, rel=1e-9, abs=1e-9)


def test_the_error_falls_with_the_square_of_the_number_of_strips() -> None:
    bow = {"flotation": 0.1, "buoyancy": 0.05, "waterplane_coefficient": 0.8}
    bow |= {"waterplane_gyradius": 0.5, "block_coefficient": 0.5, "heave_mass": 30.0}
    found = [complex_loads(loads(2.0, 2.6, strips=n, **bow)) for n in (10.0, 20.0, 40.0, 400.0)]
    error = [np.abs(one - found[-1]).max() / np.abs(found[-1]).max() for one in found[:3]]
    assert error[1] < 0.02
    assert error[0] / error[1] == pytest.approx(4.0, rel=0.25)
    assert error[1] / error[2] == pytest.approx(4.0, rel=0.25)


# ---- symmetry


def any_hull(toward: float, wavelength: float = 2.5, **settings: Any) -> StripWaveLoads:
    """A catamaran with added mass and damping in every axis."""
    moving = {f"{axis}_mass": 20.0 + i for i, axis in enumerate(AXES)}
    moving |= {f"{axis}_damping": 60.0 + i for i, axis in enumerate(AXES)}
    return loads(wavelength, toward, **CATAMARAN, **moving, **settings)


@pytest.mark.parametrize("toward", [0.0, pi])
def test_waves_from_ahead_and_astern_exert_no_sway_roll_or_yaw(toward: float) -> None:
    force = np.abs(complex_loads(any_hull(toward, flotation=0.1)))
    assert force[[1, 3, 5]] == pytest.approx(0.0, abs=1e-9)
    assert force[[0, 2, 4]].min() > 100.0


@pytest.mark.parametrize("toward", [pi / 2, -pi / 2])
def test_waves_from_abeam_exert_no_surge_pitch_or_yaw_on_a_hull_symmetric_fore_and_aft(
    toward: float,
) -> None:
    force = np.abs(complex_loads(any_hull(toward)))
    assert force[[0, 4, 5]] == pytest.approx(0.0, abs=1e-9)
    assert force[[1, 2, 3]].min() > 100.0


def test_waves_from_ahead_and_astern_exert_mirrored_forces_on_a_symmetric_hull() -> None:
    ahead, astern = (complex_loads(any_hull(angle)) for angle in (0.7, pi - 0.7))
    # what turns about the transverse axis or points ahead changes its sign
    assert astern == pytest.approx(ahead * [-1, 1, 1, 1, -1, -1], rel=1e-9, abs=1e-9)


# ---- long waves


def box_matrices(below: float) -> tuple[Array, Array]:
    """Mass and restoring matrices of a homogeneous box with its mass centre at a depth."""
    mass = RHO * LENGTH * BEAM * DRAUGHT
    inertia = mass / 12 * np.array([BEAM**2, LENGTH**2, LENGTH**2 + BEAM**2])
    M = np.diag([mass, mass, mass, *inertia])
    M[3, 3], M[4, 4] = M[3, 3] + mass * below**2, M[4, 4] + mass * below**2
    M[0, 4] = M[4, 0] = mass * below
    M[1, 3] = M[3, 1] = -mass * below
    lever = below - DRAUGHT / 2
    stiff = RHO * G * LENGTH * BEAM
    roll, pitch = stiff * BEAM**2 / 12, stiff * LENGTH**2 / 12
    C = np.diag([0.0, 0.0, stiff, roll + mass * G * lever, pitch + mass * G * lever, 0.0])
    return M, C


@pytest.mark.parametrize("damped", [0.0, 1.0])
@pytest.mark.parametrize("toward", [0.0, pi / 2, 2.1])
def test_a_free_box_follows_the_surface_and_the_water_of_long_waves(
    toward: float, damped: float
) -> None:
    """Equations of motion by hand: heave and slopes of the surface, surge and sway of a particle."""
    added = {"surge": 9.0, "sway": 80.0, "heave": 130.0, "roll": 1.0, "pitch": 25.0, "yaw": 20.0}
    drag = {"surge": 20.0, "sway": 50.0, "heave": 400.0, "roll": 9.0, "pitch": 150.0, "yaw": 30.0}
    moving = {f"{axis}_mass": value for axis, value in added.items()}
    moving |= {f"{axis}_damping": damped * value for axis, value in drag.items()}
    wavelength = 2000.0
    k, w = 2 * pi / wavelength, sqrt(2 * pi * G / wavelength)
    M, C = box_matrices(0.02)
    M = M + np.diag(list(added.values()))
    B = damped * np.diag(list(drag.values()))
    force = complex_loads(loads(wavelength, toward, **moving))
    motion = np.linalg.solve(C - w**2 * M + 1j * w * B, force)
    ahead, across = cos(toward), sin(toward)
    surface = np.array([-1j * ahead, -1j * across, -1.0, 1j * k * across, -1j * k * ahead])
    assert motion[:5] == pytest.approx(surface, rel=4e-3, abs=4e-3 * k)


def test_a_homogeneous_box_yaws_in_long_waves_with_the_part_of_its_inertia_that_lies_ahead() -> (
    None
):
    """The water does not turn: a square box would not yaw, and a line turns as the water shears."""
    wavelength, toward = 2000.0, 0.6
    k, w = 2 * pi / wavelength, sqrt(2 * pi * G / wavelength)
    M, _ = box_matrices(0.0)
    yaw = complex_loads(loads(wavelength, toward))[5] / (-(w**2) * M[5, 5])
    share = (LENGTH**2 - BEAM**2) / (LENGTH**2 + BEAM**2)
    assert yaw == pytest.approx(-k * sin(toward) * cos(toward) * share, rel=1e-3)


def test_a_long_wave_lifts_the_hull_by_the_elevation_of_the_field() -> None:
    own = loads(2000.0, 0.7, significant_height=0.4, depth=30.0, strips=20.0)
    waves = own.wave_field()
    assert waves is not None
    for t, x, y in ((0.0, 0.0, 0.0), (9.0, 40.0, -70.0), (50.0, 300.0, 20.0)):
        lift = own.wrench(make_motion(t=t, x=x, y=y)).Z
        assert lift == pytest.approx(-RHO * G * LENGTH * BEAM * waves.elevation(x, y, t), abs=5.0)


# ---- encounter


@pytest.mark.parametrize("toward", [0.0, pi, 2.0])
def test_a_boat_with_forward_speed_meets_the_waves_at_the_frequency_of_encounter(
    toward: float,
) -> None:
    own, speed = any_hull(toward), 1.5
    w = 2 * pi / own.modal_period
    met = w - w**2 / G * speed * cos(toward)
    period = 2 * pi / abs(met)
    for t in (0.3, 4.0):
        now, later = (
            own.wrench(make_motion(t=s, x=speed * s, u=speed)) for s in (t, t + 3.0 * period)
        )
        assert later == pytest.approx(now, rel=1e-9, abs=1e-6)


def test_waves_travel_on_the_water_and_calm_water_exerts_no_force() -> None:
    own = any_hull(1.0)
    still = own.wrench(make_motion(t=5.0, x=1.0, y=2.0))
    adrift = make_motion(current=(0.4, -0.3), t=5.0, x=1.0 + 2.0, y=2.0 - 1.5)
    assert own.wrench(adrift) == pytest.approx(still, rel=1e-9)
    assert replace(own, significant_height=0.0).wrench(make_motion(t=5.0)) == Wrench()
    assert replace(own, significant_height=0.0).wave_axes() == ()
    assert own.wave_axes() == AXES


# ---- boundary elements


@pytest.mark.parametrize("hull", ["box", "wigley", "catamaran"])
def test_long_waves_exert_the_forces_of_a_boundary_element_method(hull: str) -> None:
    for heading in (180.0, 135.0, 90.0):
        for axis, by_wavelength in errors(hull, heading).items():
            limit = 0.18 if axis in ("surge", "sway") else 0.04
            for wavelength in (16.0, 8.0, 6.0):
                assert abs(by_wavelength[wavelength]) < limit, (axis, heading, wavelength)


@pytest.mark.parametrize("hull", ["box", "wigley"])
def test_heave_and_pitch_of_waves_from_ahead_hold_down_to_half_the_length(hull: str) -> None:
    found = errors(hull, 180.0)
    assert max(map(abs, found["heave"].values())) < 0.06
    assert max(map(abs, found["pitch"].values())) < 0.12


# ---- sections of a mesh


@pytest.mark.parametrize("hull", ["box", "wigley", "catamaran"])
def test_sections_of_a_mesh_exert_the_forces_of_a_boundary_element_method(
    hull: str, tmp_path: Path
) -> None:
    """As near as the particulars, from which they differ by 2 % of the largest force at most."""
    for heading in HEADINGS:
        by_particulars = errors(hull, heading)
        for axis, by_wavelength in errors(hull, heading, folder=tmp_path).items():
            limit = 0.18 if axis in ("surge", "sway") else 0.04
            for wavelength, error in by_wavelength.items():
                assert error == pytest.approx(by_particulars[axis][wavelength], abs=0.02)
                if wavelength >= 6.0:
                    assert abs(error) < limit, (axis, heading, wavelength)


@pytest.mark.parametrize("toward", [pi, 2.4, pi / 2])
@pytest.mark.parametrize("wavelength", [2.0, 4.0])
def test_the_undisturbed_pressure_on_a_hull_with_transom_and_wedge_is_that_on_its_panels(
    toward: float, wavelength: float, tmp_path: Path
) -> None:
    """A vertical prism whose sections no polynomial along the hull describes."""
    plan = np.array([[-1.0, -0.2], [-1.0, 0.2], [0.3, 0.2], [1.0, 0.0], [0.3, -0.2]])
    points = [np.column_stack([plan, np.full(5, z)]) for z in (-0.3, 0.0)]
    path = hull_meshes.written(hull_meshes.convex(np.concatenate(points)), tmp_path / "hull.obj")
    height = 1e-4
    wave = {"spectrum": "regular", "significant_height": 2.0 * height, "toward": toward}
    wave |= {"modal_period": 2 * pi / sqrt(2 * pi * G / wavelength)}
    panels = HullBuoyancy(
        mesh=str(path), draught=DRAUGHT, mass=0.0, ahead=0.0, below=0.0, cell=0.03, **wave
    )
    calm = np.array(replace(panels, significant_height=0.0).wrench(make_motion()))
    wanted = (complex_loads(panels) - calm * (1 - 1j)) / height
    own = loads(wavelength, toward, strips=100.0, mesh=str(path))
    found = complex_loads(replace(own, **own.sections().particulars()))
    for axes in ([0, 1, 2], [3, 4, 5]):  # forces [N], moments [N m]
        largest = np.abs(wanted[axes]).max()
        assert found[axes] == pytest.approx(wanted[axes], abs=0.01 * largest)


def test_particulars_follow_from_the_mesh() -> None:
    boat = vessel.load_vessel("otter").with_effect(BY_MESH)
    own = boat.effect("strip_wave_loads")
    assert isinstance(own, StripWaveLoads)
    # pontoons of 2 x 0.25 m, 0.79 m apart, with few panels
    assert (own.length, own.hull_spacing, own.centre) == pytest.approx((2.0, 0.79, 0.2), rel=1e-4)
    assert own.hull_beam == pytest.approx(0.25, rel=0.01)
    assert own.waterplane_coefficient == pytest.approx(0.75, rel=0.03)
    assert own.buoyancy == pytest.approx(0.2, abs=1e-3)
    submerged = own.block_coefficient * 2.0 * own.length * own.hull_beam * own.draught
    assert own.density * submerged == pytest.approx(boat.body.mass, rel=1e-9)
    assert boat.with_effect({"use": "fan_wind"}).effect("strip_wave_loads") == own


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mesh": "none.stl"}, r"none.stl: there is no such file"),
        ({"length": 2.0}, r"length = 2 and mesh; the mesh gives 2; leave out length or mesh"),
        ({"hull_spacing": 0.8}, r"hull_spacing = 0.8 and mesh; the mesh gives 0.79"),
        ({"flotation": 0.0}, r"flotation = 0 and mesh"),
        ({"density": 300.0}, r"otter: strip_wave_loads: the hull encloses .* m\^3"),
        ({"draught": 0.0}, r"the hull does not float"),
    ],
)
def test_a_mesh_that_does_not_fit_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        vessel.load_vessel("otter").with_effect(BY_MESH | given)


# ---- vessels


def test_particulars_follow_from_the_vessel() -> None:
    own = vessel.load_vessel("otter").with_effect(OTTER).effect("strip_wave_loads")
    assert isinstance(own, StripWaveLoads)
    assert own.block_coefficient == pytest.approx(0.4, rel=1e-6)  # of its file: 0.4 x 0.25 x 2 m
    assert own.waterplane_coefficient == pytest.approx(0.75)
    assert (own.flotation, own.buoyancy) == (-0.2, 0.2)
    assert own.heave_damping == pytest.approx(546.48, rel=1e-4) and own.pitch_mass == 11.0
    plain = StripWaveLoads().with_all_parameters(vessel.load_vessel("trial_boat"))
    block = plain.block_coefficient
    assert plain.waterplane_coefficient == pytest.approx((1 + 2 * block) / 3)


def test_a_waterplane_that_no_hull_has_is_refused() -> None:
    boat = vessel.load_vessel("otter")
    refusal = "otter: strip_wave_loads: the breadth is not positive .* ahead of the origin; state"
    with pytest.raises(BadInput, match=refusal):
        boat.with_effect({**OTTER, "waterplane_gyradius": 0.2})


@pytest.mark.parametrize("hull", [OTTER, BY_MESH], ids=["particulars", "mesh"])
def test_the_compiled_program_gives_the_forces_of_the_law(hull: dict[str, Any]) -> None:
    sea = {"significant_height": 0.3, "modal_period": 2.5, "toward": 2.0, "spreading": 3.0}
    boat = vessel.load_vessel("otter").with_effect({**hull, **sea, "components": 12.0})
    own = boat.effect("strip_wave_loads")
    assert isinstance(own, StripWaveLoads)
    program, found = Program(boat), []
    calm = tuple(replace(e, significant_height=0.0) if e is own else e for e in boat.effects)
    for one in (program, Program(replace(boat, effects=calm))):
        state = np.zeros(12)
        state[[0, 1, 5]] = 1.0, -2.0, 0.3
        act, at = np.zeros(one.actuator_signal_size), np.int64(0)
        code = one.simulation_functions
        found.append(
            code.total_body_force(4.0, state, act, at, one.values(), one.effect_switches())
        )
    law = own.wrench(make_motion(t=4.0, x=1.0, y=-2.0, psi=0.3))
    assert np.subtract(*found) == pytest.approx(law, rel=1e-9)


@pytest.mark.slow
def test_a_boat_in_six_degrees_of_freedom_moves_in_waves_in_both_engines() -> None:
    logs = []
    for engine in ("mujoco", "compiled"):
        scenario = boatsim.load_scenario("otter/beam_sea", duration=20.0, engine=engine)
        logs.append(boatsim.run(scenario, seed=2).recording)
    first, second = logs
    for column in ("x_m", "y_m", "z_m", "phi_rad", "theta_rad", "psi_rad"):
        assert second[column] == pytest.approx(first[column], abs=1e-6)
    settled = first.t > 5.0
    rms = first["wave_elevation_m"][settled].std()
    assert 0.04 < rms < 0.11
    assert first["z_m"][settled].std() == pytest.approx(rms, rel=0.3)
    assert 0.02 < first["phi_rad"][settled].std() < 0.25


@pytest.mark.slow
@pytest.mark.parametrize(
    ("toward", "wanted"),
    [(pi, {"surge": 0.999, "heave": 1.0, "pitch": 0.99}), (pi / 2, {"sway": 1.0, "roll": 0.999})],
)
def test_an_otter_follows_waves_of_200_m(toward: float, wanted: dict[str, float]) -> None:
    """Amplitudes over those of the elevation and of its slope, after ten periods."""
    k = 2 * pi / 200.0
    period, amplitude = 2 * pi / sqrt(G * k), 0.002
    wave = {"spectrum": "regular", "significant_height": 2 * amplitude, "modal_period": period}
    boat = vessel.load_vessel("otter").with_effect({**OTTER, **wave, "toward": toward})
    step = period / 100.0
    states = Batch(boat, step=step).rollout(np.zeros(12), np.zeros((3000, 2)), step)[-800:]
    for axis, ratio in wanted.items():
        i = AXES.index(axis)
        surface = amplitude if i < 3 else amplitude * k
        assert np.ptp(states[:, i]) / 2 / surface == pytest.approx(ratio, abs=2e-3)
