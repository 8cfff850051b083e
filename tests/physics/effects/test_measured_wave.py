"""A measured wave as an input: the filter in closed form, the pressure by quadrature, the drift
force, and a section on a rig against another integrator."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics import vessel
from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.ground_spring import GroundSpring
from boatsim.physics.effects.wave_excitation import WaveExcitation, box_pressure_coefficients
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

SECTION = """
about = "box on a rig in beam waves"
source = "none"
freedoms = ["sway", "heave", "roll"]
length = 0.6
beam = 0.4
draught = 0.2
body = { mass = 48.0, roll_inertia = 1.0, yaw_inertia = 1.4 }

[measured]
wave_m = {}

[[effect]]
use = "held_freedom"

[[effect]]
use = "added_mass"
surge = 0.0
sway = 40.0
sway_below = -0.0375
heave = 32.0
roll = 0.2
yaw = 0.0

[[effect]]
use = "hydrostatics"
heave = 2300.0
roll = 29.0
vertical = 1.0

[[effect]]
use = "linear_damping"
sway = 20.0
heave = 60.0
roll = 0.5

[[effect]]
use = "ground_spring"
stiffness_east = 60.0
below = -0.1

[[effect]]
use = "sway_roll_radiation"
damping = 8.0

[[effect]]
use = "wave_excitation"
on = { elevation = "wave_m" }
sway_elevation = -300.0
sway_rate = -200.0
sway_acceleration = -5.0
heave_elevation = -1800.0
heave_rate = -40.0
heave_acceleration = -25.0
roll_elevation = -30.0
roll_rate = -10.0
roll_acceleration = -0.5

[[effect]]
use = "wave_drift"
sway = -140000.0
"""
HULL = """<mujoco model="section"><worldbody><body name="hull">
<geom type="box" size="0.3 0.2 0.13"/></body></worldbody></mujoco>"""
RATE = 20.0  # [Hz] of the wave probe
GRAVITY = 9.81  # [m/s^2]


def section(folder: Path, text: str = SECTION) -> Vessel:
    """The box as a vessel."""
    (folder / "section").mkdir(exist_ok=True)
    (folder / "section" / "hull.xml").write_text(HULL)
    (folder / "section" / "vessel.toml").write_text(text)
    return vessel.load_vessel(str(folder / "section"))


def filtered(boat: Vessel, frequency: float) -> tuple[Array, Array]:
    """Times (N,) and filtered elevation, rate, acceleration (N, 3) of a sampled sine, settled.

    They are the means over each step that Runge and Kutta use, at its middle.
    """
    program = Program(boat)
    code, values, on = program.simulation_functions, program.values(), program.effect_switches()
    memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
    code.settle_actuators(np.zeros(1), memory, values, on, act)
    first = list(program.composition.law_signals).index("filtered_elevation by wave_excitation")
    times, found = [], []
    for i in range(int(30 * RATE)):
        t = (i + 1) / RATE
        code.advance_actuators(
            np.array([np.sin(frequency * t)]), memory, 1.0 / RATE, values, on, act
        )
        rows = act.reshape(3, code.HELD)[:, first : first + 3]
        times.append(t - 0.5 / RATE)
        found.append((rows[0] + 4.0 * rows[1] + rows[2]) / 6.0)
    last = int(10 * RATE)
    return np.array(times)[-last:], np.array(found)[-last:]


def phasor(t: Array, values: Array, frequency: float) -> complex:
    """Complex amplitude of a sine in some samples."""
    basis = np.column_stack([np.sin(frequency * t), np.cos(frequency * t)])
    in_phase, ahead = np.linalg.lstsq(basis, values, rcond=None)[0]
    return complex(in_phase, ahead)


@pytest.mark.parametrize("frequency", [3.0, 6.0, 9.0])
def test_the_filter_of_a_sampled_wave_has_its_transfer_function(
    tmp_path: Path, frequency: float
) -> None:
    boat = section(tmp_path)
    t, values = filtered(boat, frequency)
    effect = boat.effect("wave_excitation")
    assert isinstance(effect, WaveExcitation)
    w, s = effect.bandwidth, 1j * frequency
    low_pass = w**3 / ((s + w) * (s**2 + w * s + w**2))
    for i in range(3):
        expected = low_pass * s**i
        found = phasor(t, values[:, i], frequency)
        # linear interpolation and the mean each reduce the amplitude by up to (w dt)^2 / 12
        assert abs(found / expected - 1.0) < 0.01 + (frequency / RATE) ** 2 / 6.0


def test_a_wave_that_leads_by_the_delay_of_the_filter_has_a_phase_error_below_two_degrees(
    tmp_path: Path,
) -> None:
    boat = section(tmp_path)
    t, values = filtered(boat, 5.0)
    lead = np.exp(5.0j * boat.filtered_readings["wave_m"])
    for i in range(3):
        assert abs(np.angle(lead * phasor(t, values[:, i], 5.0) / 5.0j**i)) < np.radians(2.0)


def test_undisturbed_pressure_on_a_box_equals_its_integral(tmp_path: Path) -> None:
    boat, w, rho = section(tmp_path), 5.0, 1000.0
    k, half, depth = w**2 / GRAVITY, 0.5 * boat.beam, boat.draught
    found = box_pressure_coefficients(boat, w, rho)

    def elevation(y: float, phase: float) -> float:  # from starboard: towards -y
        return float(np.cos(phase + k * y))

    for phase in (0.0, 0.7, 2.0):
        weight = rho * GRAVITY * boat.length

        def on_bottom(y: float, phase: float = phase) -> float:
            return float(np.exp(-k * depth)) * elevation(y, phase)

        def on_sides(z: float, phase: float = phase) -> float:
            return float(np.exp(-k * z)) * (elevation(half, phase) - elevation(-half, phase))

        heave = -weight * quad(on_bottom, -half, half)[0]
        sway = -weight * quad(on_sides, 0.0, depth)[0]
        roll = -weight * quad(lambda y: y * on_bottom(y), -half, half)[0]  # noqa: B023
        roll += weight * quad(lambda z: z * on_sides(z), 0.0, depth)[0]  # noqa: B023
        eta, rate, acceleration = np.cos(phase), -w * np.sin(phase), -w * w * np.cos(phase)
        assert found["heave_elevation"] * eta + found[
            "heave_acceleration"
        ] * acceleration == pytest.approx(heave, rel=1e-9, abs=1e-9)
        assert found["sway_rate"] * rate == pytest.approx(sway, rel=1e-9, abs=1e-9)
        assert found["roll_rate"] * rate == pytest.approx(roll, rel=1e-9, abs=1e-9)


def test_a_spring_below_the_origin_heels_the_hull_and_is_strained_by_heel() -> None:
    spring = GroundSpring(stiffness_east=100.0, below=0.1)
    aside = spring.wrench(make_motion(y=0.2))
    heeled = spring.wrench(make_motion(phi=0.003))
    assert aside.Y == pytest.approx(-20.0)
    assert aside.K == pytest.approx(2.0)
    assert heeled.Y == pytest.approx(100.0 * 0.1 * 0.003, rel=1e-4)
    # the stiffness matrix of a conservative spring is symmetric
    assert heeled.Y / 0.003 == pytest.approx(aside.K / 0.2, rel=1e-4)


def wave(t: float) -> tuple[float, float, float]:
    """Elevation, rate and acceleration of a group of two waves [m], with a soft begin.

    They are so low that body axes and axes of the water surface coincide.
    """
    found = np.zeros(3)
    for amplitude, w in ((0.0012, 5.0), (0.0008, 5.6)):
        s, c = np.sin(w * t), np.cos(w * t)
        found += amplitude * np.array([s, w * c, -w * w * s])
    return tuple(min(1.0, t / 4.0) ** 2 * found)


def by_hand(t: Array, held: tuple[str, ...] = ()) -> Array:
    """Sway, heave and roll (N, 3) of the box by another integrator, from the exact wave."""
    M = np.array([[88.0, 0.0, 1.5], [0.0, 80.0, 0.0], [1.5, 0.0, 1.25625]])
    D = np.array([[20.0, 0.0, 8.0], [0.0, 60.0, 0.0], [8.0, 0.0, 0.5]])
    lever = -0.1
    K = np.array(
        [
            [60.0, 0.0, -60.0 * lever],
            [0.0, 2300.0, 0.0],
            [-60.0 * lever, 0.0, 29.0 + 60.0 * lever**2],
        ]
    )
    F = np.array([[-300.0, -200.0, -5.0], [-1800.0, -40.0, -25.0], [-30.0, -10.0, -0.5]])
    free = [i for i, axis in enumerate(("sway", "heave", "roll")) if axis not in held]
    smoothing = 1.5 / np.sqrt(0.5 * GRAVITY / 0.2)

    def slope(time: float, x: Array) -> Array:
        eta = np.array(wave(time))
        force = F @ eta + np.array([-140000.0 * x[7], 0.0, 0.0]) - D @ x[3:6] - K @ x[:3]
        acceleration = np.zeros(3)
        acceleration[free] = np.linalg.solve(M[np.ix_(free, free)], force[free])
        mean = [(eta[0] ** 2 - x[6]) / smoothing, (x[6] - x[7]) / smoothing]
        return np.concatenate([x[3:6], acceleration, mean])

    found = solve_ivp(slope, (0.0, t[-1]), np.zeros(8), t_eval=t, rtol=1e-8, atol=1e-10)
    return np.asarray(found.y[:3].T)


def recorded(t: Array, poses: Array) -> Recording:
    """The recording of the box and the wave probe."""
    elevation = np.array([wave(x)[0] for x in t])
    y, z, phi = poses.T
    return Recording("box", t, {"y_m": y, "z_m": z, "phi_rad": phi, "wave_m": elevation})


@pytest.mark.parametrize("held", [(), ("roll",), ("sway",)])
def test_a_box_on_a_rig_follows_a_measured_wave_as_another_integrator_computes(
    tmp_path: Path, held: tuple[str, ...]
) -> None:
    boat = section(tmp_path)
    if held:
        boat = boat.with_parameters({"held_freedom": dict.fromkeys(held, 1.0)})
    t = np.arange(0.0, 30.0, 1.0 / RATE)
    poses = by_hand(t, held)
    program = Program(boat)
    mapped = map_recording(recorded(t, poses), program)
    states = np.zeros((1, 6))
    out = np.full((1, len(t), 6), np.nan)
    code = program.simulation_functions
    code.simulate_intervals(
        mapped.times_and_commands,
        0.02,
        program.vessel_numbers(),
        np.array([0]),
        np.array([len(t) - 1]),
        states,
        out,
    )
    free = np.abs(by_hand(t)).max(axis=0)
    # sway has the forces of second order too, of which the linear integrator knows the drift alone
    allowed = {"sway": 0.1, "heave": 0.04, "roll": 0.04}
    for i, axis in enumerate(("sway", "heave", "roll")):
        off = out[0, :, i] - poses[:, i]
        if axis in held:
            assert np.abs(out[0, :, i]).max() < 0.05 * free[i]
        else:
            assert np.sqrt(np.mean(off**2)) < allowed[axis] * np.sqrt(np.mean(poses[:, i] ** 2))


def test_the_drift_force_grows_with_the_square_of_the_wave(tmp_path: Path) -> None:
    boat = section(tmp_path)
    t = np.arange(0.0, 40.0, 1.0 / RATE)
    program = Program(boat)
    code, values, on = program.simulation_functions, program.values(), program.effect_switches()
    first = list(program.composition.law_signals).index("mean_square by wave_drift")
    means = []
    for amplitude in (0.01, 0.02):
        memory, act = np.zeros(program.memory_size), np.zeros(program.actuator_signal_size)
        code.settle_actuators(np.zeros(1), memory, values, on, act)
        squares = []
        for time in t:
            sample = np.array([amplitude * np.sin(5.0 * time)])
            code.advance_actuators(sample, memory, 1.0 / RATE, values, on, act)
            squares.append(act[2 * code.HELD + first])
        means.append(float(np.mean(squares[-251:])))
    assert means[0] == pytest.approx(0.5 * 0.01**2, rel=0.02)
    assert means[1] == pytest.approx(4.0 * means[0], rel=1e-9)
