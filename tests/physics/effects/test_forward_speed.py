"""Terms of forward speed of the radiation memory: strip theory, energy, symmetries, back ends."""

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import boatsim
from boatsim.physics.base import Array, make_motion
from boatsim.physics.coefficients.files import read_coefficients, write_coefficients
from boatsim.physics.coefficients.memory_fit import fit_memory, memory_response
from boatsim.physics.coefficients.memory_step import (
    FACTORS,
    FORCES,
    HEAD,
    OSCILLATORS,
    SIGNALS,
    advance_sections,
    store_momentum,
)
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.debugging import python_function
from boatsim.physics.effects.radiation_memory import RadiationMemory
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.physics.vessel.wave_speed import ExcitationSpeedWarning
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate.engine import Engine
from boatsim.simulate.linearisation import linear_model
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.steady_motion import find_steady_motion
from boatsim.simulate.stepper import State

OTTER = Path(__file__).parents[3] / "models" / "otter" / "hydrodynamics"
G, CENTRE = 9.81, -0.1  # [m/s^2]; [m] depth of the mass centre
INERTIA = (10.0, 15.0, 20.0)  # [kg m^2]
ALL = ["surge", "sway", "heave", "roll", "pitch", "yaw"]
DRAG = 40.0  # [N s/m] in surge
BOAT = """
about = "a catamaran under way in still water"
source = "the hull of models/otter"
freedoms = {freedoms}
length = 2.0
beam = 1.04
draught = 0.134146341463

[body]
mass = {mass}
centre = [0.0, {centre}]
roll_inertia = {inertia[0]}
pitch_inertia = {inertia[1]}
yaw_inertia = {inertia[2]}

[channels]
thrust_N = {{ low = -500.0, high = 500.0 }}

[manoeuvring]
ahead = {{ thrust_N = 50.0 }}

[[effect]]
use = "radiation_memory"
coefficients = "{coefficients}"
forward_speed = {factor}

[[effect]]
use = "hydrostatics"
heave = {restoring[0]}
roll = {restoring[1]}
pitch = {restoring[2]}
"""
PROPULSION = f"""
[[effect]]
use = "thruster"
on = {{ thrust = "thrust_N" }}

[[effect]]
use = "linear_damping"
surge = {DRAG}
"""


def stiffness(own: Coefficients) -> Array:
    """Stiffness (6, 6) of the boat."""
    found = np.diag([0.0, 0.0, *np.diag(own.restoring)[2:5], 0.0])
    found[3, 3] += own.volume * own.density * G * CENTRE
    found[4, 4] += own.volume * own.density * G * CENTRE
    return found


def boat(
    folder: Path,
    factor: float,
    freedoms: list[str] = ALL,
    more: str = "",
    coefficients: Path = OTTER,
) -> Vessel:
    """The catamaran with the mass that it displaces."""
    own = read_coefficients(coefficients)
    text = BOAT.format(
        freedoms=freedoms,
        mass=own.volume * own.density,
        centre=CENTRE,
        inertia=INERTIA,
        coefficients=coefficients,
        factor=factor,
        restoring=np.diag(stiffness(own))[2:5].tolist(),
    )
    folder.mkdir(exist_ok=True, parents=True)
    (folder / "hull.xml").write_text(
        '<mujoco><worldbody><body name="hull"><geom type="box" size="1 0.5 0.1"/></body>'
        "</worldbody></mujoco>"
    )
    (folder / "vessel.toml").write_text(text + more)
    return load_vessel(str(folder / "vessel.toml"))


def rigid_mass(own: Coefficients) -> Array:
    """Mass matrix (6, 6) of the boat about its origin, written here."""
    m, z = own.volume * own.density, CENTRE
    ix, iy, iz = INERTIA
    body = np.diag([m, m, m, ix + m * z * z, iy + m * z * z, iz])
    body[0, 4] = body[4, 0] = m * z
    body[1, 3] = body[3, 1] = -m * z
    return body


def slender_coefficients(folder: Path) -> Coefficients:
    """Coefficients of the catamaran without those of surge, as of a hull in strip theory."""
    own = read_coefficients(OTTER)
    changed = {}
    for name in ("added_mass", "damping", "infinite_added_mass"):
        table = getattr(own, name).copy()
        table[..., 0, :] = table[..., :, 0] = 0.0
        changed[name] = table
    own = replace(own, **changed, drift=None)
    response = memory_response(own.frequency, own.added_mass, own.damping, own.infinite_added_mass)
    write_coefficients(folder, replace(own, memory=fit_memory(own.frequency, response)))
    return read_coefficients(folder)


def strip_theory(own: Coefficients, w: float, speed: float) -> tuple[Array, Array]:
    """Added mass and damping (6, 6) at forward speed in axes that move with the mean speed.

    They are those of N. Salvesen, E. O. Tuck and O. Faltinsen (1970) without end terms, from those
    at zero speed. SNAME axes have the same signs as axes with z up.
    """
    assert own.memory is not None
    k = own.memory.response(np.array([w]))[0]
    a0, b0 = own.infinite_added_mass + k.imag / w, k.real
    a, b = a0.copy(), b0.copy()
    u, s = speed, speed / w**2
    heave, pitch, sway, roll, yaw = 2, 4, 1, 3, 5
    a[heave, pitch] -= s * b0[heave, heave]
    a[pitch, heave] += s * b0[heave, heave]
    a[pitch, pitch] += u * s * a0[heave, heave]
    b[heave, pitch] += u * a0[heave, heave]
    b[pitch, heave] -= u * a0[heave, heave]
    b[pitch, pitch] += u * s * b0[heave, heave]
    for other in (sway, roll):
        a[other, yaw] += s * b0[other, sway]
        a[yaw, other] -= s * b0[sway, other]
        b[other, yaw] -= u * a0[other, sway]
        b[yaw, other] += u * a0[sway, other]
    a[yaw, yaw] += u * s * a0[sway, sway]
    b[yaw, yaw] += u * s * b0[sway, sway]
    return a, b


def test_equations_at_speed_are_those_of_strip_theory(tmp_path: Path) -> None:
    """(C + i w B(w, U) - w^2 (M + A(w, U))) x = F in axes that move with the mean speed."""
    own = slender_coefficients(tmp_path / "slender")
    vessel = boat(tmp_path / "boat", 1.0, more=PROPULSION, coefficients=tmp_path / "slender")
    speed = 1.3
    model = linear_model(vessel, find_steady_motion(vessel, speed=speed), position=True)
    names = [one.name for one in model.states]
    rows = [names.index(name) for name in ("x", "y", "z", "phi", "theta", "psi")]
    for w in (2.0, 4.0, 7.0):
        a, b = strip_theory(own, w, speed)
        b[0, 0] += DRAG
        expected = np.linalg.inv(stiffness(own) + 1j * w * b - w * w * (rigid_mass(own) + a))
        found = np.linalg.solve(1j * w * np.eye(len(names)) - model.a, model.e)[rows]
        for axes in ([0, 2, 4], [1, 3, 5]):
            block = np.ix_(axes, axes)
            size = np.sqrt(np.abs(np.diag(expected)[axes]))
            errors = np.abs(found - expected)[block] / (size[:, None] * size)
            assert errors.max() < 1e-3


def test_without_the_terms_damping_in_pitch_has_no_part_of_heave(tmp_path: Path) -> None:
    """A control of the test above: it can tell whether the terms are there."""
    own = slender_coefficients(tmp_path / "slender")
    vessel = boat(tmp_path / "boat", 0.0, more=PROPULSION, coefficients=tmp_path / "slender")
    model = linear_model(vessel, find_steady_motion(vessel, speed=1.3), position=True)
    names = [one.name for one in model.states]
    w, pitch = 4.0, 4
    a, b = strip_theory(own, w, 1.3)
    b[0, 0] += DRAG
    expected = np.linalg.inv(stiffness(own) + 1j * w * b - w * w * (rigid_mass(own) + a))
    found = np.linalg.solve(1j * w * np.eye(len(names)) - model.a, model.e)
    error = abs(found[names.index("theta"), pitch] / expected[pitch, pitch] - 1.0)
    assert error > 0.02


def test_strip_theory_in_body_axes_has_the_coriolis_force_of_the_added_mass() -> None:
    """At high frequency the transformation of Perez and Fossen leaves the terms that stay anyway.

    x' = nu + U L x and x'' = nu' + U L nu turn the equations in axes that move with the mean speed
    into those in body axes.
    """
    own = read_coefficients(OTTER)
    speed, w = 0.9, 50.0
    added = 0.5 * (own.infinite_added_mass + own.infinite_added_mass.T)  # errors of the panels
    nothing = fit_memory(own.frequency, np.zeros((len(own.frequency), 6, 6)))
    still = replace(own, infinite_added_mass=added, memory=nothing)
    a, b = strip_theory(still, w, speed)  # without memory
    turn = np.zeros((6, 6))
    turn[1, 5], turn[2, 4] = 1.0, -1.0
    # nu = x' - U L x for the motion x exp(i w t)
    to_body = 1j * w * np.eye(6) - speed * turn
    force = -(1j * w * b - w * w * a) @ np.linalg.inv(to_body)
    force += 1j * w * added
    expected = np.zeros((6, 6))  # M = U (A nu)_3, N = -U (A nu)_2
    expected[4], expected[5] = speed * added[2], -speed * added[1]
    upright, sideways = np.ix_([2, 4], [2, 4]), np.ix_([1, 3, 5], [1, 3, 5])
    for block in (upright, sideways):
        assert force[block] == pytest.approx(expected[block], abs=1e-9 * np.abs(added).max() * w)


def test_momentum_after_a_long_time_is_that_of_the_low_frequency_added_mass() -> None:
    own = read_coefficients(OTTER)
    assert own.memory is not None
    effect = RadiationMemory(coefficients=str(OTTER))
    p, act = np.array(effect.table()), np.zeros(3 * SIGNALS)
    memory = np.zeros(effect.memory_states)
    velocity = (0.7, -0.2, 0.1, 0.3, 0.2, -0.4)  # surge, heave, pitch, sway, roll, yaw
    for _ in range(1000):
        python_function(advance_sections)(velocity, act, SIGNALS, 0, memory, 0, 0.1, p, 0)
    python_function(store_momentum)(act, SIGNALS, 0, memory, 0, p, 0)
    w = 1e-4
    excess = own.memory.response(np.array([w]))[0].imag / w  # A(w) - A at infinite frequency
    nu = np.array([velocity[0], velocity[3], velocity[1], velocity[4], velocity[2], velocity[5]])
    heave, sway = (excess @ nu)[2], (excess @ nu)[1]
    assert act[FORCES : FORCES + 2] == pytest.approx([heave, sway], rel=1e-5)


def test_momentum_is_the_integral_of_the_force_within_and_at_the_end_of_a_step() -> None:
    rng, h = np.random.default_rng(2), 0.02
    count = 2
    sections = []
    level = rng.normal(size=6)
    for b, a, share in ((9.0, 2.0, 1.0), (30.0, 4.0, -1.0)):  # the sum of N / b is zero
        sections += [b, a, *rng.normal(size=6), *(share * b * level)]
    p = np.array([count, count, *sections, *sections])
    memory, act = np.zeros(HEAD + 2 * count * (FACTORS + OSCILLATORS)), np.zeros(3 * SIGNALS)

    def heave_and_sway(row: int, place: int, u: Array) -> Array:
        """Force (place 0) or momentum in heave and sway at the velocities u."""
        first = row * SIGNALS
        if place == 0:
            heave = act[first + 7] * u[0] + act[first + 9] * u[1] + act[first + 10] * u[2]
            sway = act[first + 12] * u[3] + act[first + 13] * u[4] + act[first + 14] * u[5]
            return np.array([act[first + 1] + heave, act[first + 3] + sway])
        own = act[first + FORCES : first + SIGNALS]
        return np.array([own[0] + own[2:5] @ u[:3], own[1] + own[5:8] @ u[3:]])

    frequency, phase = rng.uniform(0.5, 3.0, 6), rng.uniform(0.0, 6.0, 6)
    total = np.zeros(2)
    for k in range(80):
        times = (k * h, (k + 0.5) * h, (k + 1) * h)
        begin, end = (np.sin(frequency * t + phase) for t in (times[0], times[2]))
        middle = 0.5 * (begin + end)  # the velocity is linear within a step
        python_function(advance_sections)(tuple(begin), act, SIGNALS, 0, memory, 0, h, p, 0)
        python_function(store_momentum)(act, SIGNALS, 0, memory, 0, p, 0)
        if k == 0:
            total = heave_and_sway(0, 1, begin)
        assert heave_and_sway(0, 1, begin) == pytest.approx(total, abs=2e-5)
        forces = [heave_and_sway(i, 0, u) for i, u in enumerate((begin, middle, end))]
        total = total + h / 6.0 * (forces[0] + 4.0 * forces[1] + forces[2])
        assert heave_and_sway(2, 1, end) == pytest.approx(total, abs=2e-5)


def test_the_terms_exert_no_power() -> None:
    rng = np.random.default_rng(3)
    with_terms = RadiationMemory(coefficients=str(OTTER), forward_speed=1.0, **masses())
    without = replace(with_terms, forward_speed=0.0)
    first, p = np.int64(0), np.zeros(3)
    for _ in range(20):
        act, nu = rng.normal(size=SIGNALS), rng.normal(size=6)
        u, v, w, roll, pitch, yaw = nu
        # over ground it moves otherwise: the velocity through the water counts
        m = make_motion(u=3.0, v=1.0, ur=u, vr=v, wr=w, p=roll, q=pitch, r=yaw)
        law = python_function(RadiationMemory.law)
        more = np.array(law(m, with_terms.values(), act, first, first, p, first))
        less = np.array(law(m, without.values(), act, first, first, p, first))
        assert np.abs(more - less).max() > 0.01
        assert (more - less) @ nu == pytest.approx(0.0, abs=1e-13 * np.abs(more).max() * 10)


def masses() -> dict[str, float]:
    """Added mass at infinite frequency as parameters of the effect."""
    names = ("surge_heave", "surge_pitch", "heave_pitch", "sway_roll", "sway_yaw", "roll_yaw")
    return dict.fromkeys(ALL, 10.0) | dict.fromkeys(names, 1.0)


def test_energy_under_way_never_exceeds_that_of_the_start(tmp_path: Path) -> None:
    """Without propulsion, waves and fixed springs, the energy of hull and water is the source."""
    own = read_coefficients(OTTER)
    vessel = boat(tmp_path / "boat", 1.0)
    total = rigid_mass(own) + own.infinite_added_mass
    stiff = stiffness(own)
    rng, n = np.random.default_rng(5), 8
    engine = OpenWater(vessel, step=0.01)
    for _ in range(n):
        place = 0.03 * rng.uniform(-1.0, 1.0, 3)
        speeds = np.array([1.5, 0.2, 0.2, 0.1, 0.1, 0.2]) * rng.uniform(-1.0, 1.0, 6)
        engine.reset(State(0.0, 0.0, 0.0, *place, 0.0, *speeds))
        energies = []
        for _ in range(150):
            state = engine.state
            nu = np.array([state.u, state.v, state.w, state.p, state.q, state.r])
            pose = np.array([0.0, 0.0, state.z, state.phi, state.theta, 0.0])
            energies.append(0.5 * nu @ total @ nu + potential(stiff, pose))
            engine.advance(10)
        assert max(energies) <= energies[0] * (1.0 + 1e-9)
        assert energies[-1] < 0.999 * energies[0]


def potential(stiff: Array, pose: Array) -> float:
    """Energy of the linear restoring forces [J]."""
    return float(0.5 * pose @ stiff @ pose)


def run(vessel: Vessel, start: State, steps: int = 150, engine: type = OpenWater) -> Array:
    """State (13,) after some steps of 0.02 s."""
    simulated = engine(vessel, step=0.02)
    simulated.reset(start)
    simulated.advance(steps)
    return np.array(simulated.state)


START = State(z=0.02, phi=0.05, theta=0.03, u=1.2, v=0.1, w=-0.1, p=0.1, q=-0.2, r=0.15)


def test_without_speed_through_the_water_there_are_no_terms_to_the_last_bit() -> None:
    rng = np.random.default_rng(4)
    with_terms = RadiationMemory(coefficients=str(OTTER), forward_speed=1.0, **masses())
    without = replace(with_terms, forward_speed=0.0)
    first, p = np.int64(0), np.zeros(3)
    law = python_function(RadiationMemory.law)
    for _ in range(20):
        act, (v, w, roll, pitch, yaw) = rng.normal(size=SIGNALS), rng.normal(size=5)
        m = make_motion(u=0.7, ur=0.0, vr=v, wr=w, p=roll, q=pitch, r=yaw)  # drifts with the water
        more = law(m, with_terms.values(), act, first, first, p, first)
        less = law(m, without.values(), act, first, first, p, first)
        assert more[1:] == less[1:]  # the reaction in surge is of second order in the motion
        straight = m._replace(q=0.0, r=0.0)
        assert law(straight, with_terms.values(), act, first, first, p, first) == (
            law(straight, without.values(), act, first, first, p, first)
        )


def test_a_hull_that_only_rolls_and_pitches_moves_to_the_last_bit_as_without(
    tmp_path: Path,
) -> None:
    start = State(phi=0.1, theta=0.05, p=0.2)
    more = run(boat(tmp_path / "more", 1.0, ["roll", "pitch"]), start)
    less = run(boat(tmp_path / "less", 0.0, ["roll", "pitch"]), start)
    assert more.tolist() == less.tolist()


def test_without_the_parameter_there_are_no_terms(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "plain", 0.0)
    file = tmp_path / "plain" / "vessel.toml"
    file.write_text(file.read_text().replace("forward_speed = 0.0\n", ""))
    assert run(load_vessel(str(file)), START).tolist() == run(vessel, START).tolist()


def test_mirror_image_of_the_motion(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "boat", 1.0)
    own = run(vessel, START)
    mirrored = run(vessel, START._replace(phi=-0.05, v=-0.1, p=-0.1, r=-0.15))
    signs = [-1.0 if name in ("y", "phi", "psi", "v", "p", "r") else 1.0 for name in State._fields]
    assert mirrored * signs == pytest.approx(own, rel=1e-12, abs=1e-14)
    assert abs(own[State._fields.index("y")]) > 0.01


def test_a_current_and_a_turn_of_the_earth_carry_the_motion_along(tmp_path: Path) -> None:
    own = run(boat(tmp_path / "still", 1.0), START)
    north, east, turn = 0.4, -0.3, 0.8
    more = f'\n[[effect]]\nuse = "current"\nnorth = {north}\neast = {east}\n'
    vessel = boat(tmp_path / "current", 1.0, more=more)
    c, s = np.cos(turn), np.sin(turn)
    # the water's velocity in the axes of the hull, which is heeled and trimmed
    phi, theta = START.phi, START.theta
    level = np.array([c * north + s * east, c * east - s * north, 0.0])
    pitched = np.array([np.cos(theta) * level[0], level[1], np.sin(theta) * level[0]])
    water = np.array(
        [
            pitched[0],
            np.cos(phi) * pitched[1] + np.sin(phi) * pitched[2],
            np.cos(phi) * pitched[2] - np.sin(phi) * pitched[1],
        ]
    )
    start = START._replace(
        psi=turn, u=START.u + water[0], v=START.v + water[1], w=START.w + water[2]
    )
    found = dict(zip(State._fields, run(vessel, start), strict=True))
    still = dict(zip(State._fields, own, strict=True))
    assert found["x"] == pytest.approx(c * still["x"] - s * still["y"] + north * 3.0, abs=1e-6)
    assert found["y"] == pytest.approx(s * still["x"] + c * still["y"] + east * 3.0, abs=1e-6)
    assert found["psi"] == pytest.approx(turn + still["psi"], abs=1e-6)
    for name in ("z", "phi", "theta", "p", "q", "r"):
        assert found[name] == pytest.approx(still[name], abs=1e-6)


def test_mujoco_compiled_engine_and_batch_agree(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "boat", 1.0)
    own = run(vessel, START)
    assert run(vessel, START, engine=Engine) == pytest.approx(own, rel=1e-9, abs=1e-12)
    level = START._replace(phi=0.0, theta=0.0)  # the rates of the coordinates are those of the body
    batch = boatsim.Batch(vessel, n=3, step=0.02)
    batch.reset(np.tile(np.array(level[1:]), (3, 1)))
    batch.advance(steps=150)
    assert batch.states[1, :6] == pytest.approx(run(vessel, level)[1:7], rel=1e-10, abs=1e-13)
    different = run(boat(tmp_path / "less", 0.0), START)
    assert np.abs(different - own).max() > 1e-3


def test_a_replay_of_a_recording_repeats_its_motion(tmp_path: Path) -> None:
    vessel = boat(tmp_path / "boat", 1.0, more=PROPULSION)
    engine = OpenWater(vessel, step=0.02)
    engine.reset(State())
    rows, t = [], 0.1 * np.arange(200)
    thrust = 60.0 * (t > 0.5)
    for force in thrust:
        rows.append(engine.state)
        engine.command({"thrust_N": float(force)})
        engine.advance(5)
    signals = {"thrust_N": thrust}
    units = {"x": "m", "y": "m", "z": "m", "phi": "rad", "theta": "rad", "psi": "rad"}
    for name, unit in units.items():
        signals[f"{name}_{unit}"] = np.array([getattr(row, name) for row in rows])
    write_csv(Recording("run", t, signals), tmp_path / "run.csv")
    simulated = boatsim.replay(
        str(tmp_path / "run.csv"), str(tmp_path / "boat" / "vessel.toml"), horizon=15.0
    )
    moved = simulated.signals["x_m"]
    assert moved[100] == pytest.approx(signals["x_m"][100], abs=0.02)
    assert signals["x_m"][100] > 3.0


# ---- loads of waves at a forward speed


LOADS = """
[[effect]]
use = "panel_wave_loads"
coefficients = "{coefficients}"
significant_height = {height}
modal_period = 3.0
"""


@pytest.mark.parametrize(
    ("speed", "factor", "height", "warned"),
    [(1.5, 0.0, 0.1, True), (1.5, 1.0, 0.1, False), (0.0, 0.0, 0.1, False), (1.5, 0.0, 0.0, False)],
)
def test_loads_at_speed_without_the_terms_of_the_radiation_give_a_warning(
    tmp_path: Path, speed: float, factor: float, height: float, warned: bool
) -> None:
    write_coefficients(tmp_path / "loads", replace(read_coefficients(OTTER), speed=speed))
    more = LOADS.format(coefficients=tmp_path / "loads", height=height)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        boat(tmp_path / "boat", factor, more=more)
    own = [str(one.message) for one in found if one.category is ExcitationSpeedWarning]
    if warned:
        [line] = own
        assert "the loads of panel_wave_loads are those at 1.5 m/s, but radiation_memory" in line
        assert "\n" not in line and "forward_speed = 1.0" in line
    else:
        assert own == []
