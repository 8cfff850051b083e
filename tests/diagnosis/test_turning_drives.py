"""A craft with three azimuth drives, one of which turns slowly: the drive is found with its rate.

The recordings come from an integrator that shares no code with the tool."""

import numpy as np
import pytest
from scipy.integrate import odeint

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA = 30.0, 4.0  # kg, kg m^2
DAMPING = np.array([6.0, 15.0, 6.0])  # N s/m, N s/m, N m s
PLACES = {"bow": (0.6, 0.0), "port": (-0.6, -0.3), "starboard": (-0.6, 0.3)}  # ahead, to starboard
RATE, ROWS, HOLD = 10.0, 900, 30  # Hz, rows of a recording, rows between two orders
TESTED = (
    "thrust_lag",
    "command_delay",
    "steering_rate_limit",
    *(f"azimuth_rate_limit_{drive}_rad" for drive in PLACES),
    *(f"drive_rate_limit_{drive}_N" for drive in PLACES),
)


def craft() -> Vessel:
    channels: dict[str, object] = {}
    surge, sway, yaw = DAMPING.tolist()
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": surge, "sway": sway, "yaw": yaw}
    ]
    for drive, (x, y) in PLACES.items():
        channels[f"{drive}_N"] = {"low": 0.0, "high": 8.0}
        channels[f"{drive}_rad"] = {"low": -3.1416, "high": 3.1416}
        on = {"thrust": f"{drive}_N", "angle": f"{drive}_rad"}
        effects.append({"use": "thruster", "name": drive, "on": on, "x": x, "y": y})
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "sway", "yaw"),
        length=1.5,
        beam=0.9,
        draught=0.1,
        body={"mass": MASS, "roll_inertia": 2.0, "yaw_inertia": INERTIA},
        effects=effects,
        channels=channels,
        diagnosis={"facts": {"still_water": True, "indoors": True}},
    )


CRAFT = craft()


def sailed(seed: int, fastest: Array) -> Recording:
    """A recording of random steps of all drives, whose directions turn with limited rates [rad/s]."""
    rng = np.random.default_rng(seed)
    steps = ROWS // HOLD
    thrusts = np.repeat(rng.uniform(1.0, 8.0, (steps, 3)), HOLD, axis=0)
    directions = np.repeat(rng.uniform(-1.5, 1.5, (steps, 3)), HOLD, axis=0)
    x, y = np.array(list(PLACES.values())).T

    def turned(time: float, order: Array, begin: Array) -> Array:
        most = fastest * max(time, 1e-12)
        return begin + np.clip(order - begin, -most, most)

    def derivatives(
        s: Array, time: float, thrust: Array, order: Array, begin: Array
    ) -> list[float]:
        angle = turned(time, order, begin)
        ahead, right = thrust * np.cos(angle), thrust * np.sin(angle)
        u, v, r = s[3:]
        forces = np.array([ahead.sum(), right.sum(), x @ right - y @ ahead]) - DAMPING * s[3:]
        c, k = np.cos(s[2]), np.sin(s[2])
        rates = [u * c - v * k, u * k + v * c, r]
        return [*rates, forces[0] / MASS + r * v, forces[1] / MASS - r * u, forces[2] / INERTIA]

    s, poses, angle = np.zeros(6), [], directions[0]
    for thrust, order in zip(thrusts, directions, strict=True):
        poses.append(s[:3])
        s = odeint(derivatives, s, [0.0, 1.0 / RATE], args=(thrust, order, angle), rtol=1e-8)[-1]
        angle = turned(1.0 / RATE, order, angle)
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * [0.005, 0.005, 0.003]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    for i, drive in enumerate(PLACES):
        signals |= {f"{drive}_N": thrusts[:, i], f"{drive}_rad": directions[:, i]}
    return Recording(f"run_{seed}", np.arange(ROWS) / RATE, signals, Notes())


def ranked(*recordings: Recording) -> Ranking:
    effects = [e for e in candidate_library(CRAFT).compiled_effects if e.name in TESTED]
    program = Program(CRAFT, effects)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, prior_noise_levels(CRAFT, recordings), {"thrust": 0.05})
    return select_and_rank_candidates(problem, TESTED)


@pytest.mark.slow
def test_a_slow_direction_of_one_drive_is_found_with_the_drive_and_its_rate() -> None:
    fastest = np.array([np.inf, 0.4, np.inf])
    ranking = ranked(sailed(1, fastest), sailed(2, fastest))
    assert [one.name for one in ranking.named] == ["azimuth_rate_limit_port_rad"]
    value, sd = ranking.best.value("azimuth_rate_limit_port_rad", "rate")
    assert abs(value - 0.4) < max(4.0 * sd, 0.02)


@pytest.mark.slow
def test_no_limit_is_found_where_all_directions_turn_at_once() -> None:
    fastest = np.full(3, np.inf)
    assert ranked(sailed(3, fastest), sailed(4, fastest)).named == ()
