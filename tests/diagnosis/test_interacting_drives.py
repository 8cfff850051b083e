"""Drives that act on each other or on the hull are found with the size of the loss, and no such
loss is found where there is none.

The recordings of the platform come from an integrator that shares no code with the tool, those of
the supply vessel from the compiled engine with the loss added.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from alike import long
from scipy.integrate import odeint

import boatsim
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA = 30.0, 4.0  # kg, kg m^2
DAMPING = np.array([6.0, 15.0, 6.0])  # N s/m, N s/m, N m s
PLACES = {"bow": (0.6, 0.0), "port": (-0.6, -0.3), "starboard": (-0.6, 0.3)}  # ahead, to starboard
FULL, DRAUGHT = 8.0, 0.15  # N, m
RATE, ROWS, HOLD = 10.0, 900, 30  # Hz, rows of a recording, rows between two orders
EFFECTS = ("thruster_interaction", "shared_supply", "thruster_hull_interaction")


def platform() -> Vessel:
    channels: dict[str, object] = {}
    surge, sway, yaw = DAMPING.tolist()
    effects: list[dict[str, object]] = [
        {"use": "linear_damping", "surge": surge, "sway": sway, "yaw": yaw}
    ]
    for drive, (x, y) in PLACES.items():
        channels[f"{drive}_N"] = {"low": 0.0, "high": FULL}
        channels[f"{drive}_rad"] = {"low": -3.1416, "high": 3.1416}
        on = {"thrust": f"{drive}_N", "angle": f"{drive}_rad"}
        effects.append({"use": "thruster", "name": drive, "on": on, "x": x, "y": y})
    return Vessel.from_effects(
        name="platform",
        dof=("surge", "sway", "yaw"),
        length=1.5,
        beam=0.9,
        draught=DRAUGHT,
        body={"mass": MASS, "roll_inertia": 2.0, "yaw_inertia": INERTIA},
        effects=effects,
        channels=channels,
        diagnosis={"facts": {"still_water": True, "indoors": True}},
    )


def shared_loss(thrust: Array, angle: Array, loss: float) -> Array:
    """Thrust of drives whose common supply is loaded by the others."""
    others = thrust.sum() - thrust
    full_others = FULL * (len(thrust) - 1)
    return thrust * (1.0 - loss * others / full_others)


def hull_loss(thrust: Array, angle: Array, loss: float) -> Array:
    """Thrust of drives whose races strike the hull, by the law of cosines."""
    x, y = np.array(list(PLACES.values())).T
    race = np.array([np.cos(angle + np.pi), np.sin(angle + np.pi)])
    inward = np.array([-x, -y]) / np.sqrt(x**2 + y**2)
    cosine = (race * inward).sum(axis=0)
    return thrust * np.where(cosine > 0.0, 1.0 - loss * cosine**2, 1.0)


def hull_loss_of_port(thrust: Array, angle: Array, loss: float) -> Array:
    """Thrust of drives of which only the race of the port one loses by the hull."""
    return np.where(np.arange(len(thrust)) == 1, hull_loss(thrust, angle, loss), thrust)


def race_loss(thrust: Array, angle: Array, size: float) -> Array:
    """Thrust of drives in each other's races, with the published ratio in its published form."""
    places = [complex(x, y) for x, y in PLACES.values()]
    diameter = 0.65 * DRAUGHT
    left = thrust.copy()
    for i, here in enumerate(places):
        for j, there in enumerate(places):
            if i == j:
                continue
            line = here - there
            race = -np.exp(1j * angle[j])
            phi = abs(np.degrees(np.angle(race / line)))
            t = 1.0 - 0.75 ** ((abs(line) / diameter) ** (2.0 / 3.0))
            steered = t + (1.0 - t) * phi**3 / (130.0 / t**3 + phi**3)
            left[i] *= steered ** (size * 2.0 * thrust[j] / (thrust[i] + thrust[j]))
    return left


def race_loss_of_starboard(thrust: Array, angle: Array, size: float) -> Array:
    """Thrust of drives of which only the starboard one loses in the races of the others."""
    return np.where(np.arange(len(thrust)) == 2, race_loss(thrust, angle, size), thrust)


LOSSES: dict[str, tuple[Callable[[Array, Array, float], Array], str, float]] = {
    "thruster_interaction": (race_loss, "size", 1.0),
    "shared_supply": (shared_loss, "loss", 0.25),
    "thruster_hull_interaction": (hull_loss, "loss", 0.2),
    "drive_interaction_starboard": (race_loss_of_starboard, "size", 1.0),
    "drive_hull_interaction_port": (hull_loss_of_port, "loss", 0.3),
}


def weak_drive(thrust: Array, angle: Array, factor: float) -> Array:
    """Thrust of drives of which the second is weaker than specified."""
    return thrust * np.where(np.arange(len(thrust)) == 1, factor, 1.0)


def bent_curve(thrust: Array, angle: Array, exponent: float) -> Array:
    """Thrust that grows with a power of its command."""
    return FULL * (thrust / FULL) ** exponent


LOOK_ALIKES: dict[str, tuple[Callable[[Array, Array, float], Array], str, float]] = {
    "drive_gain_error_port": (weak_drive, "factor", 0.7),
    "thrust_exponent": (bent_curve, "exponent", 1.3),
}


def sailed(seed: int, effect: str = "") -> Recording:
    """A recording of random orders to all drives; a drive is often turned on another one."""
    rng = np.random.default_rng(seed)
    steps = ROWS // HOLD
    thrusts = rng.uniform(1.0, FULL, (steps, 3))
    directions = rng.uniform(-np.pi, np.pi, (steps, 3))
    directions[::2, 1] = -0.5 * np.pi  # the race of the port drive strikes the starboard one
    changes = LOSSES | LOOK_ALIKES
    law, _, size = changes.get(effect, (lambda thrust, angle, size: thrust, "", 0.0))
    x, y = np.array(list(PLACES.values())).T
    s, poses = np.zeros(6), []

    def derivatives(s: Array, time: float, thrust: Array, angle: Array) -> list[float]:
        ahead, right = thrust * np.cos(angle), thrust * np.sin(angle)
        u, v, r = s[3:]
        forces = np.array([ahead.sum(), right.sum(), x @ right - y @ ahead]) - DAMPING * s[3:]
        c, k = np.cos(s[2]), np.sin(s[2])
        rates = [u * c - v * k, u * k + v * c, r]
        return [*rates, forces[0] / MASS + r * v, forces[1] / MASS - r * u, forces[2] / INERTIA]

    times = np.arange(HOLD + 1) / RATE
    for thrust, angle in zip(thrusts, directions, strict=True):
        given = law(thrust, angle, size)
        course = odeint(derivatives, s, times, args=(given, angle), rtol=1e-8)
        poses += list(course[:-1, :3])
        s = course[-1]
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * [0.005, 0.005, 0.003]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    for i, drive in enumerate(PLACES):
        signals[f"{drive}_N"] = np.repeat(thrusts[:, i], HOLD)
        signals[f"{drive}_rad"] = np.repeat(directions[:, i], HOLD)
    return Recording(f"run_{seed}", np.arange(ROWS) / RATE, signals, Notes())


SUPPLY_VESSEL_SIZES = {
    "thruster_interaction": 1.0,
    "shared_supply": 0.25,
    "thruster_hull_interaction": 0.3,
}


def steamed(seed: int, effect: str = "") -> Recording:
    """A recording of the shipped supply vessel, with one effect added to it."""
    vessel = load_vessel("osv")
    if effect:
        size = SUPPLY_VESSEL_SIZES[effect]
        vessel = vessel.with_effect({"use": effect, LOSSES[effect][1]: size})
    rng = np.random.default_rng(seed)
    goals = []
    for k in range(20):
        goal = {"from": 45.0 * k, "bow_1_N": rng.uniform(-3e5, 3e5)}
        goal["bow_2_N"] = rng.uniform(-3e5, 3e5)
        goal["port_N"], goal["starboard_N"] = rng.uniform(1e5, 6.5e5), rng.uniform(1e5, 4.2e5)
        goal["port_angle_rad"] = rng.uniform(-np.pi, np.pi) if k % 2 else -0.5 * np.pi
        goal["starboard_angle_rad"] = rng.uniform(-np.pi, np.pi)
        goals.append(goal)
    goals[0].pop("from")
    sea_trial = boatsim.load_scenario("otter/turn", vessel=vessel, goal=goals, duration=900.0)
    recording = boatsim.run(sea_trial).recording
    rows = slice(None, None, max(round(1.0 / (recording.t[1] - recording.t[0])), 1))
    signals = {name: recording[name][rows].copy() for name in vessel.commands}
    noise = {"x_m": 0.1, "y_m": 0.1, "psi_rad": 0.002}
    for name, sd in noise.items():
        exact = recording[name][rows]
        signals[name] = exact + sd * rng.standard_normal(len(exact))
    return Recording(f"trial_{seed}", recording.t[rows], signals, Notes())


SAIL = {"platform": sailed, "osv": steamed}
RIVALS = ("thrust_gain_error", "thrust_exponent", "damping_error", "cross_flow_drag")


@cache
def problem_of(name: str, effect: str) -> tuple[Problem, tuple[str, ...]]:
    """The recordings of a vessel with one effect, and the candidates that are tested."""
    boat = platform() if name == "platform" else load_vessel(name)
    recordings = [SAIL[name](seed, effect) for seed in (1, 2)]
    own = ("drive_gain_error", "drive_hull_interaction", "drive_interaction")
    drives = [f"{effect}_{drive}" for effect in own for drive in boat.names_of("thruster")]
    tested = (*EFFECTS, *RIVALS, *drives)
    library = candidate_library(boat, own[1:])
    effects = [e for e in library.compiled_effects if e.name in tested]
    program = Program(boat, effects)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, prior_noise_levels(boat, recordings), {"thrust": 0.05})
    return problem, tuple(e.name for e in effects)


def ranked(name: str, effect: str) -> Ranking:
    """What a diagnosis finds in the recordings of a vessel with one effect."""
    return select_and_rank_candidates(*problem_of(name, effect))


CASES = [
    *(("platform", effect) for effect in EFFECTS),
    ("platform", "drive_interaction_starboard"),
    ("platform", "drive_hull_interaction_port"),
    long("osv", "thruster_interaction"),
    long("osv", "shared_supply"),
    long("osv", "thruster_hull_interaction"),
]


@pytest.mark.parametrize(("name", "effect"), CASES)
@pytest.mark.slow
def test_a_loss_is_found_with_its_size(name: str, effect: str) -> None:
    parameter, true = LOSSES[effect][1], LOSSES[effect][2]
    if name == "osv":
        true = SUPPLY_VESSEL_SIZES[effect]
    ranking = ranked(name, effect)
    assert [one.name for one in ranking.named] == [effect]
    value, sd = ranking.best.value(effect, parameter)
    assert abs(value - true) < 4.0 * sd
    assert sd < 0.2 * true


@pytest.mark.parametrize("name", ["platform", long("osv")])
@pytest.mark.slow
def test_no_loss_is_found_where_there_is_none(name: str) -> None:
    assert ranked(name, "").named == ()


@pytest.mark.parametrize("effect", LOOK_ALIKES)
@pytest.mark.slow
def test_another_error_of_the_thrust_is_not_taken_for_such_a_loss(effect: str) -> None:
    _, parameter, true = LOOK_ALIKES[effect]
    ranking = ranked("platform", effect)
    assert [one.name for one in ranking.named] == [effect]
    value, sd = ranking.best.value(effect, parameter)
    assert abs(value - true) < 4.0 * sd
