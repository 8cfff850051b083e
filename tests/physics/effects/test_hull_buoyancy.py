"""Buoyancy of a mesh: its force on still water and in waves, energy, engines and refusals."""

from dataclasses import replace
from math import cos, exp, pi, sin, sinh, tanh
from pathlib import Path
from typing import Any

import hull_meshes
import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.hull_buoyancy import HullBuoyancy
from boatsim.physics.hull.panels import divided
from boatsim.physics.hull.submerged import submerged_part
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hull.obj"
WITHOUT = {"hydrostatics": {"heave": 0.0, "roll": 0.0, "pitch": 0.0}}
LENGTH, BEAM, DRAUGHT, DENSITY = 4.0, 1.0, 0.5, 1000.0  # [m, kg/m^3] of a box


def floating_box(folder: Path, **sea: Any) -> HullBuoyancy:
    """A weightless box of which half is submerged at rest."""
    path = hull_meshes.written(hull_meshes.box(LENGTH, BEAM, 2.0 * DRAUGHT), folder / "box.obj")
    given: dict[str, Any] = {"draught": DRAUGHT, "mass": 0.0, "ahead": 0.0, "below": 0.0}
    given |= {"density": DENSITY, "cell": 0.1, "spectrum": "regular"}
    return HullBuoyancy(mesh=str(path), **(given | sea))


def otter(**sea: Any) -> Vessel:
    """An Otter that floats by its mesh."""
    table = {"use": "hull_buoyancy", "mesh": str(OTTER), "origin": -0.2}
    return load_vessel("otter").with_parameters(WITHOUT).with_effect(table | sea)


def buoyancy(vessel: Vessel) -> HullBuoyancy:
    """Its effect."""
    found = vessel.effect("hull_buoyancy")
    assert isinstance(found, HullBuoyancy)
    return found


def expected_wrench(own: HullBuoyancy, z: float, phi: float, theta: float) -> Array:
    """Wrench (6,) of buoyancy at its centre and weight at the mass centre."""
    part = submerged_part(own.placed_mesh(), z, phi, theta)
    down = part.rotation[2]
    lift = -own.density * GRAVITY * part.volume * down
    weight = own.mass * GRAVITY * down
    centre = np.array([own.ahead, 0.0, own.below])
    moment = np.cross(part.body_centre, lift) + np.cross(centre, weight)
    return np.concatenate([lift + weight, moment])


@pytest.mark.parametrize("seed", range(10))
def test_force_on_still_water_is_buoyancy_at_its_centre_and_weight(seed: int) -> None:
    own = buoyancy(otter())
    rng = np.random.default_rng(seed)
    z, phi, theta, psi = rng.uniform([-0.1, -pi, -1.4, -pi], [0.1, pi, 1.4, pi])
    found = own.wrench(make_motion(z=z, phi=phi, theta=theta, psi=psi, x=3.0, y=-2.0))
    expected = expected_wrench(own, z, phi, theta)
    assert found == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_level_hull_floats_at_the_default_draught() -> None:
    found = buoyancy(otter()).wrench(make_motion())
    assert found == pytest.approx(np.zeros(6), abs=1e-9)


def energy(own: HullBuoyancy, z: float, phi: float, theta: float) -> float:
    """Potential energy [J] of the hull and of the water that it displaces."""
    part = submerged_part(own.placed_mesh(), z, phi, theta)
    raised = own.density * GRAVITY * part.volume * (part.centre[2] + z)
    level = part.rotation @ np.array([own.ahead, 0.0, own.below])
    return float(raised - own.mass * GRAVITY * (z + level[2]))


@pytest.mark.parametrize("seed", range(6))
def test_still_water_exerts_the_gradient_of_an_energy(seed: int) -> None:
    own = buoyancy(otter())
    z, phi, theta = np.random.default_rng(seed).uniform([-0.08, -3.0, -1.0], [0.08, 3.0, 1.0])
    f = own.wrench(make_motion(z=z, phi=phi, theta=theta))
    vertical = -sin(theta) * f.X + cos(theta) * (sin(phi) * f.Y + cos(phi) * f.Z)
    generalised = np.array([vertical, f.K, cos(phi) * f.M - sin(phi) * f.N])
    slopes = []
    for change in np.eye(3) * 1e-5:
        above = energy(own, *(np.array([z, phi, theta]) + change))
        below = energy(own, *(np.array([z, phi, theta]) - change))
        slopes.append((below - above) / 2e-5)
    assert generalised == pytest.approx(slopes, abs=1e-4)


def undamped(**sea: Any) -> Vessel:
    """The Otter without damping, added mass and propellers that turn."""
    still = {"surge": 0.0, "sway": 0.0, "heave": 0.0, "roll": 0.0, "pitch": 0.0, "yaw": 0.0}
    return otter(**sea).with_parameters(
        {
            "added_mass": still,
            "linear_damping": still,
            "quadratic_damping": {"yaw": 0.0},
            "cross_flow_drag": {"section_drag_coefficient": 0.0},
        }
    )


def total_energy(vessel: Vessel, state: Any) -> float:
    """Kinetic and potential energy [J]."""
    body, own = vessel.body, buoyancy(vessel)
    turning = np.array([state.p, state.q, state.r])
    lever = np.array([own.ahead, 0.0, own.below])
    centre = np.array([state.u, state.v, state.w]) + np.cross(turning, lever)
    inertia = np.array([body.roll_inertia, body.effective_pitch_inertia(), body.yaw_inertia])
    kinetic = 0.5 * body.mass * centre @ centre + 0.5 * turning @ (inertia * turning)
    return float(kinetic + energy(own, state.z, state.phi, state.theta))


@pytest.mark.parametrize(
    ("heel", "trim", "most"), [(0.1, 0.05, 1e-6), (0.3, 0.0, 1e-5), (1.0, 0.1, 1e-5)]
)
def test_released_boat_without_damping_keeps_its_energy(
    heel: float, trim: float, most: float
) -> None:
    """Over 10 s the change of the energy decreases with the step, to 1e-6 or 1e-5 at 5 ms."""
    vessel = undamped()
    at_rest = energy(buoyancy(vessel), 0.0, 0.0, 0.0)
    changes = []
    for step in (0.02, 0.005):
        engine = OpenWater(vessel, step=step)
        engine.reset(State(phi=heel, theta=trim, z=0.02))
        energies = [total_energy(vessel, engine.state) - at_rest]
        for _ in range(20):
            engine.advance(round(0.5 / step))
            energies.append(total_energy(vessel, engine.state) - at_rest)
        changes.append(np.ptp(energies) / energies[0])
    assert changes[1] < most
    assert changes[1] < 0.1 * changes[0]


@pytest.mark.parametrize(("heel", "end"), [(1.0, 0.0), (-2.1, -pi), (2.1, pi)])
def test_boat_turns_upright_or_over(heel: float, end: float) -> None:
    engine = OpenWater(otter(), step=0.02)
    engine.reset(State(phi=heel))
    engine.advance(1500)
    assert engine.state.phi == pytest.approx(end, abs=1e-3)


def linear_amplitudes(own: HullBuoyancy) -> Array:
    """Complex amplitudes (6,) of the wrench of a wave of unit height above the still water."""
    period, height = own.modal_period, own.significant_height
    rest = np.array(replace(own, significant_height=0.0).wrench(make_motion()))
    start = np.array(own.wrench(make_motion(t=0.0))) - rest
    later = np.array(own.wrench(make_motion(t=0.25 * period))) - rest
    return np.asarray((start - 1j * later) / (0.5 * height))


@pytest.mark.parametrize("depth", [0.0, 1.0])
@pytest.mark.parametrize("waves", [1.0, 2.0, 5.0])
def test_pressure_of_small_waves_on_a_box_is_that_of_linear_theory(
    tmp_path: Path, waves: float, depth: float
) -> None:
    """Froude-Krylov forces of head waves in closed form."""
    k = 2.0 * pi / (waves * LENGTH)
    attenuation, mean = exp(-k * DRAUGHT), (1.0 - exp(-k * DRAUGHT)) / k
    frequency = (GRAVITY * k) ** 0.5
    if depth > 0.0:
        frequency *= tanh(k * depth) ** 0.5
        below = np.cosh(k * depth)
        attenuation = np.cosh(k * (depth - DRAUGHT)) / below
        mean = (sinh(k * depth) - sinh(k * (depth - DRAUGHT))) / (k * below)
    own = floating_box(
        tmp_path,
        significant_height=1e-4,
        modal_period=2.0 * pi / frequency,
        toward=pi,
        depth=depth,
    )
    found = linear_amplitudes(own)
    half = 0.5 * k * LENGTH
    c = DENSITY * GRAVITY * BEAM
    heave = -c * attenuation * LENGTH * sin(half) / half
    # the pressure on the stern less that on the bow
    surge = 2j * c * mean * sin(half)
    # of the pressure on the bottom and on both ends
    turn = 2.0 * c * attenuation * (sin(half) / k**2 - 0.5 * LENGTH * cos(half) / k) * 1j
    few = 1e-4 * c  # the triangles of both sides differ
    assert found[2] == pytest.approx(heave, abs=0.01 * c * LENGTH)
    assert abs(found[0]) == pytest.approx(abs(surge), abs=0.01 * abs(surge) + 1e-3 * c)
    assert np.abs(found[[1, 3, 5]]).max() < few
    ends = c * end_moment(k, depth) * 2.0 * sin(half)
    assert abs(abs(found[4]) - abs(turn.imag - ends)) < 0.02 * c * LENGTH**2 / 12.0


def end_moment(k: float, depth: float) -> float:
    """Integral of z C(z) over the draught of an end of the box [m^2], by quadrature."""
    z = (np.arange(2000) + 0.5) / 2000 * DRAUGHT
    attenuation = np.exp(-k * z)
    if depth > 0.0:
        attenuation = np.cosh(k * (depth - z)) / np.cosh(k * depth)
    return float(np.sum(z * attenuation) * DRAUGHT / 2000)


def test_boat_in_a_long_wave_feels_the_depth_below_the_surface(tmp_path: Path) -> None:
    own = floating_box(tmp_path, significant_height=0.4, modal_period=40.0)
    crest = own.wrench(make_motion())
    deeper = replace(own, significant_height=0.0).wrench(make_motion(z=0.2))
    assert crest.Z == pytest.approx(deeper.Z, rel=0.01)
    high = own.wrench(make_motion(z=-0.6))  # above still water, but below the crest
    assert high.Z == pytest.approx(-DENSITY * GRAVITY * LENGTH * BEAM * 0.1, rel=0.01)


def test_force_converges_with_the_size_of_the_cells() -> None:
    sea = {"spectrum": "regular", "significant_height": 0.3, "modal_period": 1.6, "toward": 0.6}
    m = make_motion(t=0.7, z=0.02, phi=0.4, theta=-0.1, psi=0.3)
    forces = []
    for cell in (0.2, 0.1, 0.05, 0.025):
        forces.append(np.array(buoyancy(otter(**sea, cell=cell)).wrench(m)))
    errors = [np.abs(f - forces[-1]).max() for f in forces[:-1]]
    assert errors[0] < 0.03 * np.abs(forces[-1]).max()
    assert errors[2] < errors[1] < errors[0]


def test_waves_of_the_force_are_those_of_the_elevation(tmp_path: Path) -> None:
    """A column of water as slender as a pole carries the elevation at its place."""
    mesh = hull_meshes.box(0.01, 0.01, 4.0).moved(0.7, -0.4, 0.0)
    own = HullBuoyancy(
        mesh=str(hull_meshes.written(mesh, tmp_path / "pole.obj")),
        draught=2.0,
        mass=0.0,
        ahead=0.0,
        below=0.0,
        cell=0.02,
        significant_height=0.3,
        modal_period=2.0,
        spreading=2.0,
        components=20.0,
    )
    field = own.wave_field()
    assert field is not None
    for t in (0.0, 1.3):
        # the pressure on the bottom is that of waves 2 m below; the hydrostatic one is subtracted
        force = own.wrench(make_motion(t=t, x=1.0, y=2.0)).Z
        part = replace(own, significant_height=0.0).wrench(make_motion(x=1.0, y=2.0)).Z
        attenuated = replace(field, amplitude=field.amplitude * np.exp(-2.0 * field.wave_number))
        rise = attenuated.elevation(1.7, 1.6, t)
        scale = own.density * GRAVITY * 1e-4
        assert force - part == pytest.approx(-scale * float(rise), abs=2e-3 * scale)


@pytest.mark.parametrize(
    "sea",
    [
        {},
        {"significant_height": 0.4, "modal_period": 2.0, "toward": 1.2, "components": 10.0},
    ],
)
def test_mujoco_compiled_engine_and_batch_agree(sea: dict[str, float]) -> None:
    vessel = otter(**sea)
    states = []
    for kind in (OpenWater, Engine):
        engine = kind(vessel, step=0.02)
        engine.reset(State(phi=0.9))
        engine.advance(200)
        states.append(np.array(engine.state[1:]))
    assert states[1] == pytest.approx(states[0], rel=1e-8, abs=1e-10)
    batch = Batch(vessel, 2, step=0.02)
    batch.reset(np.array(State(phi=0.9)[1:]))
    batch.advance(steps=200)
    assert batch.states[1] == pytest.approx(states[0], rel=1e-8, abs=1e-10)


def test_heave_roll_and_pitch_alone(tmp_path: Path) -> None:
    """Vessels with fewer degrees of freedom take the same effect."""
    whole = load_vessel("otter").with_parameters(WITHOUT)
    table = {"use": "hull_buoyancy", "mesh": str(OTTER), "origin": -0.2}
    for dof in (("heave",), ("heave", "roll"), ("heave", "pitch"), ("heave", "roll", "pitch")):
        vessel = replace(whole, dof=dof).with_effect(table)
        engine = OpenWater(vessel, step=0.02)
        engine.reset(State(z=0.05))
        engine.advance(1000)
        assert engine.state.z == pytest.approx(0.0, abs=1e-3)
    with pytest.raises(BadInput, match="hull_buoyancy needs a vessel that is free to heave"):
        replace(whole, dof=("surge", "sway", "yaw")).with_effect(table)


def test_long_triangles_are_divided_without_a_gap() -> None:
    mesh = hull_meshes.box(4.0, 1.0, 0.5)
    parts = divided(mesh.corners, 0.3)
    edges = np.linalg.norm(np.roll(parts, -1, axis=1) - parts, axis=2)
    assert edges.max() <= 0.3
    a, b, c = np.moveaxis(parts, 1, 0)
    assert np.cross(b - a, c - a).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.einsum("ni,ni->n", a, np.cross(b, c)).sum() / 6.0 == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mesh": ""}, "hull_buoyancy needs mesh = an STL or OBJ file"),
        ({"mesh": "none.obj"}, "there is no such file"),
        ({"density": 300.0}, r"otter: hull_buoyancy: the hull encloses .* m\^3"),
    ],
)
def test_hull_that_cannot_float_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        otter(**given)


def test_second_buoyancy_is_refused() -> None:
    table = {"use": "hull_buoyancy", "mesh": str(OTTER)}
    with pytest.raises(
        BadInput, match="takes the place of hydrostatics; set hydrostatics.heave = 0"
    ):
        load_vessel("otter").with_effect(table)
