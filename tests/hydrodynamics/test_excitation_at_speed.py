"""Excitation at a forward speed: limits, symmetries and reciprocity, where Capytaine is installed."""

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from typer.testing import CliRunner

from boatsim.cli.application import app
from boatsim.hydrodynamics.axes import excitation_to_sname
from boatsim.hydrodynamics.capytaine_worker import (
    AXES,
    MetWave,
    excitation_at_speed,
    floating_body,
    least_encounter,
    met_excitation,
    waves_at_speed,
)
from boatsim.hydrodynamics.computation import (
    MOST_PANELS,
    HullMesh,
    coefficients_of_rows,
    highest_resolved,
    run_capytaine,
    with_excitation_at_speed,
)
from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.physics.base import Array
from boatsim.physics.coefficients.files import read_coefficients, write_wave_loads
from boatsim.physics.coefficients.table import Coefficients, WaveLoads
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.effects.radiation_memory import RadiationMemory
from boatsim.physics.particulars import GRAVITY
from boatsim.simulate.wave_response import wave_response
from validation.waves.hulls import write_catamaran
from validation.waves.response import FloatingCatamaran
from validation.waves.ship_speed import speed_terms
from validation.waves.wigley import DENSITY, DRAUGHT, HULLS, LENGTH, write_hull

STATIONS, LINES = 6, 3  # panels over half the length and over the draught: a coarse hull
SPEED = 0.3 * float(np.sqrt(GRAVITY * LENGTH))  # [m/s], a Froude number of 0.3
DEPTH = 0.02  # [m] of the mass centre below the waterline
SWAY, HEAVE, PITCH, YAW = 1, 2, 4, 5
HEAD, BEAM = pi, 0.5 * pi
OF_HULL = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0]  # mirror image to port and starboard
DEEP_WATER: dict[str, Any] = {"rho": DENSITY, "g": GRAVITY, "water_depth": float("inf")}


class Solved(NamedTuple):
    """A hull for Capytaine, and what solves its problems."""

    hull: HullMesh
    body: Any
    solver: Any


@pytest.fixture(scope="module")
def wigley(tmp_path_factory: pytest.TempPathFactory) -> Solved:
    """A coarse Wigley hull."""
    capytaine = pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    path = tmp_path_factory.mktemp("wigley") / "wigley.obj"
    write_hull(path, HULLS[0], STATIONS, LINES)
    hull = HullMesh(path, DRAUGHT, density=DENSITY)
    capytaine.set_logging("ERROR")
    request = {"mesh": str(path), "most_panels": MOST_PANELS, **vars(hull)}
    body = floating_body(request | {"mesh": str(path)})
    return Solved(hull, body, capytaine.BEMSolver(method="direct"))


def wave_of(ratio: float) -> float:
    """Frequency [rad/s] of a deep-water wave of some lengths of the hull."""
    return float(np.sqrt(2.0 * pi * GRAVITY / (ratio * LENGTH)))


def computed(hull: HullMesh, w: list[float], headings: list[float], speed: float) -> Coefficients:
    """Coefficients with the excitation at a speed."""
    rows = run_capytaine(hull, w, headings, lambda stage, share: None, speed=speed)
    return with_excitation_at_speed(coefficients_of_rows(rows, hull, headings), rows, speed)


def met_force(wigley: Solved, wave: MetWave) -> Array:
    """Excitation (6,) of a wave in the axes of Capytaine."""
    force = met_excitation(wigley.solver, wigley.body, wave, DEEP_WATER)
    return np.asarray(force)


@pytest.mark.slow
def test_without_speed_the_excitation_is_that_at_rest(wigley: Solved) -> None:
    w, headings = wave_of(1.3), [0.0, 0.8, BEAM, 2.5, HEAD]
    at_rest = computed(wigley.hull, [w], headings, 0.0)
    assert at_rest.speed == 0.0
    waves = waves_at_speed(wigley.body, w, [-one for one in headings], 0.0, DEEP_WATER)
    pairs = np.array(excitation_at_speed(wigley.solver, wigley.body, waves, DEEP_WATER))
    values: Array = np.asarray(pairs[..., 0] + 1j * pairs[..., 1])
    found = excitation_to_sname(values, conjugate=True)
    size = np.abs(at_rest.excitation[0]).max()
    assert found == pytest.approx(at_rest.excitation[0], rel=1e-9, abs=1e-9 * size)
    # at a speed the other results are the same to the last bit
    report, names = (lambda stage, share: None), ("excitation", "added_mass", "radiation_kochin")
    still, moving = (
        run_capytaine(wigley.hull, [w], headings, report, speed=speed) for speed in (0.0, SPEED)
    )
    for name in names:
        assert still[1][name] == moving[1][name]
    assert "excitation_at_speed" in moving[1] and "excitation_at_speed" not in still[1]


@pytest.mark.slow
def test_in_beam_waves_speed_adds_the_moments_of_the_scattered_waves_alone(wigley: Solved) -> None:
    capytaine = pytest.importorskip("capytaine")
    from capytaine.bem.airy_waves import froude_krylov_force

    w = wave_of(1.0)
    still, moving = (
        computed(wigley.hull, [w], [BEAM], speed).excitation[0, 0] for speed in (0.0, SPEED)
    )
    wave = capytaine.DiffractionProblem(
        body=wigley.body, wave_direction=-BEAM, omega=w, **DEEP_WATER
    )
    pressure = froude_krylov_force(wave)
    undisturbed = excitation_to_sname(np.array([pressure[axis] for axis in AXES]), conjugate=True)
    scattered = still - undisturbed
    expected = still.copy()
    expected[PITCH] -= SPEED / (1j * w) * scattered[HEAVE]
    expected[YAW] += SPEED / (1j * w) * scattered[SWAY]
    size = np.abs(expected).max()
    assert moving == pytest.approx(expected, rel=1e-9, abs=1e-9 * size)
    assert abs(moving[PITCH] - still[PITCH]) > 0.1 * abs(still[PITCH])


@pytest.mark.slow
@pytest.mark.parametrize("heading", [HEAD, 0.0])
def test_long_waves_lift_the_hull_by_its_waterplane_and_carry_it_along(
    wigley: Solved, heading: float
) -> None:
    """At any speed a free hull follows the surface of long waves, with the terms of radiation."""
    w = wave_of(60.0)
    k = w * w / GRAVITY
    met = w - k * SPEED * float(np.cos(heading))
    found = computed(wigley.hull, [w], [heading], SPEED)
    waterplane = found.restoring[HEAVE, HEAVE]
    assert abs(found.excitation[0, 0, HEAVE]) == pytest.approx(waterplane, rel=0.06)
    slow = computed(wigley.hull, [met], [heading], 0.0)
    added, damping = speed_terms(slow.added_mass[0], slow.damping[0], met, SPEED)
    mass = found.density * found.volume
    inertia = mass * np.array([0.0, 0.25 * LENGTH, 0.25 * LENGTH]) ** 2
    body = rigid_body(mass, (0.0, DEPTH), inertia)
    stiffness = linear_stiffness(found, mass, DEPTH)
    dynamic = stiffness + 1j * met * damping - met * met * (body + added)
    free = [HEAVE, PITCH]
    motion = np.linalg.solve(dynamic[np.ix_(free, free)], found.excitation[0, 0, free])
    # the surface: heave -1 down, bow up by its slope along x, i k cos(heading)
    expected = np.array([-1.0, -1j * k * np.cos(heading)])
    assert motion[0] == pytest.approx(expected[0], abs=0.02)
    assert motion[1] == pytest.approx(expected[1], abs=0.1 * k)
    # with the excitation at rest pitch is far from the slope of the wave
    at_rest = computed(wigley.hull, [w], [heading], 0.0).excitation[0, 0, free]
    other = np.linalg.solve(dynamic[np.ix_(free, free)], at_rest)
    assert abs(other[1] - expected[1]) > 0.2 * k


def test_waves_from_port_and_starboard_have_mirrored_forces(wigley: Solved) -> None:
    found = computed(wigley.hull, [wave_of(1.2)], [-0.7, 0.7], SPEED).excitation[0]
    size = np.abs(found).max()
    assert found[0] == pytest.approx(found[1] * OF_HULL, rel=1e-6, abs=1e-6 * size)


def test_force_of_scattered_waves_is_that_of_the_radiation_by_reciprocity(wigley: Solved) -> None:
    """Green's theorem: the integral of phi_D v_R over the hull equals that of phi_R v_D."""
    capytaine = pytest.importorskip("capytaine")
    from capytaine.bem.airy_waves import froude_krylov_force

    w, heading = wave_of(1.2), 0.9 * pi
    wave = waves_at_speed(wigley.body, w, [heading], SPEED, DEEP_WATER)[0]
    problem = capytaine.DiffractionProblem(
        body=wigley.body, wave_direction=heading, omega=w, **DEEP_WATER
    )
    pressure = froude_krylov_force(problem)
    force = met_force(wigley, wave._replace(speed=0.0))
    hull = wigley.body.hull_mask
    flux = problem.boundary_condition[hull] * wigley.body.mesh.faces_areas
    for place in (SWAY, HEAVE, PITCH):
        radiated = wigley.solver.solve(
            capytaine.RadiationProblem(
                body=wigley.body, radiating_dof=AXES[place], omega=wave.encounter, **DEEP_WATER
            )
        )
        expected = DENSITY * np.sum(radiated.potential[hull] * flux)
        found = force[place] - pressure[AXES[place]]
        assert found == pytest.approx(expected, rel=0.08), AXES[place]


def test_an_overtaken_long_wave_is_scattered_with_the_conjugate_impedance(wigley: Solved) -> None:
    """Water that rises at i w a meets B + i w_e A; A and B are even in the frequency."""
    long, met = 0.05, 5.0
    added = computed(wigley.hull, [met], [HEAD], 0.0).added_mass[0, HEAVE, HEAVE]
    ahead, overtaken = (
        met_force(wigley, MetWave(long, sign * met, 0.0, 0.0))[HEAVE] for sign in (1.0, -1.0)
    )
    # z up and exp(-i w_e t): the force is (B - i w_e A) times the velocity -i w of the surface
    expected = 2.0 * (-1j * met * added) * (-1j * long)
    assert ahead - overtaken == pytest.approx(expected, rel=0.02)


def test_excitation_is_continuous_where_the_hull_keeps_up_with_the_wave(wigley: Solved) -> None:
    w, heading = wave_of(1.0), 0.4
    least = least_encounter(w, DEEP_WATER)
    assert 0.0 < least < 0.2 * w
    size = np.abs(met_force(wigley, MetWave(w, w, heading, SPEED))).max()
    for place in (-least, 0.0, least):
        below, above = (
            met_force(wigley, MetWave(w, place + change, heading, SPEED))
            for change in (-1e-7 * w, 1e-7 * w)
        )
        assert below == pytest.approx(above, abs=1e-5 * size)
    # scattered waves that do not oscillate exert no pressure without speed
    capytaine = pytest.importorskip("capytaine")
    from capytaine.bem.airy_waves import froude_krylov_force

    problem = capytaine.DiffractionProblem(
        body=wigley.body, wave_direction=heading, omega=w, **DEEP_WATER
    )
    pressure = froude_krylov_force(problem)
    expected = np.array([pressure[axis] for axis in AXES])
    found = met_force(wigley, MetWave(w, 0.0, heading, 0.0))
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * size)


def test_water_of_finite_depth_is_interpolated_where_capytaine_has_no_solution(
    wigley: Solved,
) -> None:
    water = DEEP_WATER | {"water_depth": 0.5 * LENGTH}
    w = wave_of(3.0)
    least = least_encounter(w, water)
    assert least > least_encounter(w, DEEP_WATER)
    force = met_excitation(wigley.solver, wigley.body, MetWave(w, 0.5 * least, 0.0, SPEED), water)
    assert np.isfinite(force).all()


def test_waves_from_ahead_are_scattered_as_shorter_ones() -> None:
    panel = 0.1
    met = float(np.sqrt(2.0 * pi * GRAVITY / (4.0 * panel)))
    w = highest_resolved(panel, SPEED)
    assert w + w * w / GRAVITY * SPEED == pytest.approx(met, rel=1e-12)
    assert highest_resolved(panel, 1e-9) == pytest.approx(met, rel=1e-6)


@pytest.mark.slow
def test_the_command_writes_the_excitation_at_the_speed(wigley: Solved, tmp_path: Path) -> None:
    words = ["--draught", str(DRAUGHT), "--density", str(DENSITY), "--panel", "0.6"]
    words += ["--frequencies", "8", "--headings", "5", "--no-compare", "--centre-depth", "0.1"]
    folders = tmp_path / "rest", tmp_path / "moving"
    for folder, speed in zip(folders, ("0", f"{SPEED}"), strict=True):
        done = CliRunner().invoke(
            app,
            [
                "hydrodynamics",
                str(wigley.hull.mesh),
                *words,
                "--speed",
                speed,
                "--out",
                str(folder),
            ],
            catch_exceptions=False,
        )
        assert done.exit_code == 0, done.output
        printed = " ".join(done.output.split())
        assert ("too long for the waves that the hull scatters ahead" in printed) == (speed != "0")
        assert (f"excitation at a forward speed of {SPEED:g} m/s" in printed) == (speed != "0")
    rest, moving = map(read_coefficients, folders)
    assert rest.speed == 0.0 and moving.speed == pytest.approx(SPEED)
    assert "speed" not in (folders[0] / "coefficients.toml").read_text()
    for name in ("radiation.csv", "memory.csv", "drift.csv"):
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes()
    difference = np.abs(moving.excitation - rest.excitation).max(axis=(0, 1))
    assert np.all(difference > 0.01 * np.abs(rest.excitation).max(axis=(0, 1)))


@pytest.mark.slow
def test_a_simulated_boat_at_speed_follows_the_surface_of_long_waves(tmp_path: Path) -> None:
    """The moments of radiated and scattered waves cancel in the simulation too."""
    pytest.importorskip("capytaine")
    pytest.importorskip("trimesh")
    speed, period, headings = 1.1, 4.5, [0.0, 0.25 * pi, BEAM, 0.75 * pi, HEAD]
    write_catamaran(tmp_path / "catamaran.stl")
    catamaran = FloatingCatamaran()
    own = catamaran.coefficients
    hull = HullMesh(tmp_path / "catamaran.stl", own.draught, density=own.density, panel=0.25)
    loads = computed(hull, [1.2, 1.4, 1.6, 1.8], headings, speed)
    table = WaveLoads(
        "long waves", 0.0, loads.frequency, loads.heading, loads.excitation, speed=speed
    )
    write_wave_loads(tmp_path / "loads", table)
    boat = catamaran.vessel(tmp_path / "boat", ("surge", "heave", "pitch"))
    boat = boat.without_effect("ground_spring")
    effects = []
    for effect in boat.effects:
        if isinstance(effect, RadiationMemory):
            effect = replace(effect, forward_speed=1.0)
        if isinstance(effect, PanelWaveLoads):
            effect = replace(effect, coefficients=str(tmp_path / "loads"))
        effects.append(effect)
    boat = replace(boat, effects=tuple(effects))
    found = wave_response(boat, [0.0, HEAD], [period], 0.002, speed=speed)
    assert found.steady.all()
    k = (2.0 * pi / period) ** 2 / GRAVITY
    for row, direction in zip(found.operators[:, 0], (1.0, -1.0), strict=True):
        assert row[1] == pytest.approx(-1.0, abs=0.03)
        assert row[2] / k == pytest.approx(-1j * direction, abs=0.12)
