"""The memory of the radiation force against convolution integrals and the frequency domain."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

import boatsim
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.coefficients.files import read_coefficients
from boatsim.physics.coefficients.memory_step import HEAD, advance_sections, oscillator_factors
from boatsim.physics.debugging import python_function
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.stepper import State

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
G = 9.81
BOAT = """
about = "a catamaran that heaves, rolls and pitches in still water"
source = "the hull of models/otter"
freedoms = {freedoms}
length = 2.0
beam = 1.04
draught = 0.134146341463
body = {{ mass = {mass}, centre = [0.0, -0.1], roll_inertia = 10.0, pitch_inertia = 15.0, yaw_inertia = 20.0 }}

[[effect]]
use = "radiation_memory"
coefficients = "{coefficients}"

[[effect]]
use = "hydrostatics"
heave = {heave}
roll = {roll}
pitch = {pitch}
"""
UPRIGHT = ["heave", "roll", "pitch"]
ALL = ["surge", "sway", "heave", "roll", "pitch", "yaw"]


def boat(folder: Path, freedoms: list[str], more: str = "") -> boatsim.Vessel:
    """The catamaran with the mass that it displaces."""
    own = read_coefficients(OTTER)
    mass = own.volume * own.density
    lever = mass * G * -0.1  # [N m] of the mass centre, which lies above the origin
    text = BOAT.format(
        freedoms=freedoms,
        mass=mass,
        coefficients=OTTER,
        heave=own.restoring[2, 2],
        roll=own.restoring[3, 3] + lever,
        pitch=own.restoring[4, 4] + lever,
    )
    folder.mkdir(exist_ok=True)
    (folder / "hull.xml").write_text(
        '<mujoco><worldbody><body name="hull"><geom type="box" size="1 0.5 0.1"/></body>'
        "</worldbody></mujoco>"
    )
    (folder / "vessel.toml").write_text(text + more)
    return load_vessel(str(folder / "vessel.toml"))


def linear_matrices(freedoms: list[str]) -> tuple[Array, Array]:
    """Rigid body and stiffness matrices (n, n) of the boat about its origin, written here."""
    own = read_coefficients(OTTER)
    m, z = own.volume * own.density, -0.1
    body = np.diag([m, m, m, 10.0 + m * z * z, 15.0 + m * z * z, 20.0])
    body[0, 4] = body[4, 0] = m * z
    body[1, 3] = body[3, 1] = -m * z
    stiff = np.diag([0.0, 0.0, *np.diag(own.restoring)[2:5] + [0.0, m * G * z, m * G * z], 0.0])
    places = [ALL.index(name) for name in freedoms]
    return body[np.ix_(places, places)], stiff[np.ix_(places, places)]


def test_factors_of_an_oscillator_are_those_of_the_matrix_exponential() -> None:
    from scipy.linalg import expm

    for a, b in ((0.8, 9.0), (9.0, 9.0), (6.0, 9.0)):
        h, memory = 0.13, np.zeros(8)
        python_function(oscillator_factors)(a, b, h, memory, 0)
        # states: place, rate, input, rate of the input
        full = np.zeros((4, 4))
        full[0, 1], full[1, :3], full[2, 3] = 1.0, (-b, -a, 1.0), 1.0
        exact = expm(full * h)[:2]
        end = exact[:, 3] / h
        assert memory[:4] == pytest.approx(exact[:, :2].ravel(), abs=1e-13)
        assert memory[4:6] == pytest.approx(exact[:, 2] - end, abs=1e-13)
        assert memory[6:8] == pytest.approx(end, abs=1e-13)


def test_constant_velocity_ends_without_a_force() -> None:
    p = np.array([1.0, 0.0, 9.0, 2.0, *np.ones(6), *np.zeros(6)])
    memory, act = np.zeros(HEAD + 22), np.zeros(54)
    step = python_function(advance_sections)
    for _ in range(300):
        step((1.0, 0.5, -0.3, 0.0, 0.0, 0.0), act, 18, 0, memory, 0, 0.1, p, 0)
    assert act[:6] == pytest.approx(np.zeros(6), abs=1e-9)


def test_mujoco_and_compiled_engine_agree(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "boat", ALL)
    states = []
    for kind in (OpenWater, Engine):
        engine = kind(vessel, step=0.02)
        engine.reset(State(z=0.03, phi=0.1, theta=0.05, u=0.3, r=0.1))
        engine.advance(100)
        states.append(np.array(engine.state[1:]))
    assert states[1] == pytest.approx(states[0], rel=1e-9, abs=1e-12)


def kernel(t: Array, axes: list[int]) -> Array:
    """Retardation functions (N, n, n): cosine transform of the damping, written for this test."""
    memory = read_coefficients(OTTER).memory
    assert memory is not None
    w = np.linspace(0.0, 200.0, 8001)[1:]
    damping = memory.response(w).real[:, axes, :][:, :, axes].reshape(len(w), -1)
    step = w[1] - w[0]
    cosine = np.cos(np.outer(t, w))
    # beyond 200 rad/s the damping falls as w^-2; what is missing is less than 1e-3 at t = 0
    return (2.0 / np.pi * step * (cosine @ damping)).reshape(len(t), len(axes), len(axes))


@pytest.mark.slow
def test_free_decay_agrees_with_a_convolution_integral(tmp_path: Path) -> None:
    h, steps = 0.01, 600
    axes = [2, 3, 4]
    mass, stiff = linear_matrices(UPRIGHT)
    own = read_coefficients(OTTER)
    total = mass + own.infinite_added_mass[np.ix_(axes, axes)]
    k = kernel(h * np.arange(steps + 1), axes)
    start = np.array([0.002, 0.004, 0.002])
    x, v = np.zeros((steps + 1, 3)), np.zeros((steps + 1, 3))
    x[0] = start
    weights = np.ones(steps + 1)
    a = np.linalg.solve(total, -stiff @ start)
    for n in range(steps):  # velocity Verlet with the convolution by the trapezoidal rule
        x[n + 1] = x[n] + h * v[n] + 0.5 * h * h * a
        v[n + 1] = v[n] + h * a
        for _ in range(3):
            past = np.einsum(
                "kij,kj->i", k[n + 1 :: -1][: n + 2], v[: n + 2] * weights[: n + 2, None]
            )
            ends = 0.5 * (k[0] @ v[n + 1] + k[n + 1] @ v[0])
            force = -stiff @ x[n + 1] - h * (past - ends)
            after = np.linalg.solve(total, force)
            v[n + 1] = v[n] + 0.5 * h * (a + after)
        a = after
    engine = OpenWater(boat(tmp_path / "boat", UPRIGHT), step=h)
    engine.reset(State(z=start[0], phi=start[1], theta=start[2]))
    found = [start]
    for _ in range(steps):
        engine.advance()
        found.append(np.array([engine.state.z, engine.state.phi, engine.state.theta]))
    assert np.abs(np.array(found) - x).max(axis=0) == pytest.approx(np.zeros(3), abs=1e-2 * 0.004)
    assert np.abs(x[-100:]).max() < 0.5 * np.abs(start).max()


SEA = """
[[effect]]
use = "panel_wave_loads"
coefficients = "{coefficients}"
spectrum = "regular"
significant_height = 0.002
modal_period = {period}
toward = {toward}
"""


@pytest.mark.parametrize(("period", "toward"), [(1.2, 0.6 * pi), (1.8, 0.8 * pi)])
def test_response_to_regular_waves_is_that_of_the_frequency_domain(
    tmp_path: Path, period: float, toward: float
) -> None:
    from scipy.interpolate import CubicSpline

    sea = SEA.format(coefficients=OTTER, period=period, toward=toward)
    engine = OpenWater(boat(tmp_path / "boat", UPRIGHT, sea), step=period / 100.0)
    own, w, axes = read_coefficients(OTTER), 2.0 * pi / period, [2, 3, 4]
    added = CubicSpline(own.frequency, own.added_mass)(w)[np.ix_(axes, axes)]
    damping = CubicSpline(own.frequency, own.damping)(w)[np.ix_(axes, axes)]
    force = CubicSpline(own.heading, CubicSpline(own.frequency, own.excitation)(w))(toward)[axes]
    mass, stiff = linear_matrices(UPRIGHT)
    expected = np.linalg.solve(stiff - w * w * (mass + added) + 1j * w * damping, force)
    engine.advance(100 * 40)
    rows = []
    for _ in range(300):
        engine.advance()
        t = engine.t
        rows.append(
            [np.cos(w * t), np.sin(w * t), engine.state.z, engine.state.phi, engine.state.theta]
        )
    table = np.array(rows)
    cosine, sine = np.linalg.lstsq(table[:, :2], table[:, 2:], rcond=None)[0]
    found = (cosine - 1j * sine) / 0.001
    assert np.abs(found - expected) == pytest.approx(np.zeros(3), abs=0.01 * np.abs(expected).max())
    assert found[:2] == pytest.approx(expected[:2], rel=0.01)


def test_linear_model_has_the_response_of_the_frequency_domain(tmp_path: Path) -> None:
    """(C + j w K(j w) - w^2 (M + A)) x = F, with the retardation K of the coefficients."""
    model = boatsim.linearise(boat(tmp_path / "boat", UPRIGHT))
    assert [one.name for one in model.states[:6]] == ["z", "phi", "theta", "w", "p", "q"]
    assert model.accuracy < 1e-4
    own, axes = read_coefficients(OTTER), np.ix_([2, 3, 4], [2, 3, 4])
    assert own.memory is not None
    mass, stiff = linear_matrices(UPRIGHT)
    total = mass + own.infinite_added_mass[axes]
    for w in (2.0, 5.0, 9.0):
        retardation = own.memory.response(np.array([w]))[0][axes]
        expected = np.linalg.inv(stiff + 1j * w * retardation - w * w * total)
        found = np.linalg.solve(1j * w * np.eye(len(model.a)) - model.a, model.e)[:3]
        assert found == pytest.approx(expected, abs=2e-5 * np.abs(expected).max())


@pytest.mark.slow
def test_energy_never_grows_in_still_water_over_a_day(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "boat", UPRIGHT)
    own = read_coefficients(OTTER)
    mass, stiff = linear_matrices(UPRIGHT)
    total = mass + own.infinite_added_mass[np.ix_([2, 3, 4], [2, 3, 4])]
    # 144 releases of 600 s, one beside the other: after longer times nothing but rounding is left
    rng, n = np.random.default_rng(1), 144
    batch = boatsim.Batch(vessel, n=n, step=0.02)
    batch.reset(rng.uniform(-0.05, 0.05, (n, 6)))
    energy = []
    for _ in range(30):  # every 20 s
        x, v = batch.states[:, :3], batch.states[:, 3:]
        energy.append(0.5 * np.sum(x @ stiff * x + v @ total * v, axis=1))
        batch.advance(steps=1000)
    assert n * batch.t[0] == pytest.approx(86400.0)
    table = np.array(energy)
    assert np.all(table[1:] < table[0])
    # below what rounding leaves, energies are no longer compared
    above = table[:-1] > 1e-18 * table[0]
    assert np.all(table[1:][above] < table[:-1][above])
    assert np.all(table[-1] < 1e-6 * table[0])


def test_constant_added_mass_beside_the_memory_is_refused(tmp_path: Path) -> None:
    more = '\n[[effect]]\nuse = "added_mass"\nsurge = 1.0\nsway = 2.0\nyaw = 1.0\nroll = 0.1\n'
    with pytest.raises(BadInput, match="contains the added mass"):
        vessel = boat(tmp_path / "boat", ALL)
        text = (tmp_path / "boat" / "vessel.toml").read_text()
        head, radiation = text.split('[[effect]]\nuse = "radiation_memory"')
        (tmp_path / "boat" / "vessel.toml").write_text(
            head + more + '\n[[effect]]\nuse = "radiation_memory"' + radiation
        )
        load_vessel(str(tmp_path / "boat" / "vessel.toml"))
        del vessel


def test_missing_coefficients_are_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "boat").mkdir()
    vessel = boat(tmp_path / "boat", ALL)
    text = (tmp_path / "boat" / "vessel.toml").read_text()
    (tmp_path / "boat" / "vessel.toml").write_text(text.replace(str(OTTER), "nowhere"))
    with pytest.raises(BadInput, match="there is no coefficients.toml"):
        load_vessel(str(tmp_path / "boat" / "vessel.toml"))
    assert vessel.effect("radiation_memory") is not None
