"""A craft that floats on air: no candidate needs water, and what differs from its data sheet is
found. The recordings come from an integrator that shares no code with the tool."""

from collections.abc import Callable

import numpy as np
import pytest
from alike import long
from scipy.integrate import odeint

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.candidate_sets import CandidateSets
from boatsim.diagnosis.search.ranking import Ranking, select_and_rank_candidates
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA, GRAVITY = 0.14, 5e-4, 9.81  # kg, kg m^2, m/s^2
# places ahead and to starboard [m] and directions [rad] of three pairs of fans, push one way only
FANS = {
    "a1": (0.044, 0.015, 0.5 * np.pi),
    "a2": (0.044, -0.015, -0.5 * np.pi),
    "b1": (-0.009, -0.045, -np.pi / 6),
    "b2": (-0.035, -0.03, 5 * np.pi / 6),
    "c1": (-0.035, 0.03, -5 * np.pi / 6),
    "c2": (-0.009, 0.045, np.pi / 6),
}
RATE, ROWS = 40.0, 900
NOMINAL = 7.4  # [V] of the battery
FULL = 0.7  # thrust of a fan at the largest command [N]
WATER = {"current", "wave_forcing", "added_mass", "prop_walk", "cross_flow_drag", "planing_lag"}
TESTED = (
    "yaw_inertia_error",
    "slope",
    "payload",
    "quadratic_damping",
    "shared_supply",
    *(f"drive_gain_error_{fan}" for fan in FANS),
)


def craft(facts: dict[str, object], **more: object) -> Vessel:
    effects = []
    for fan, (x, y, angle) in FANS.items():
        on = {"thrust": f"{fan}_N", "angle": float(angle)}
        effects.append({"use": "thruster", "name": fan, "on": on, "x": x, "y": y})
    return Vessel.from_effects(
        name="hovercraft",
        dof=("surge", "sway", "yaw"),
        length=0.12,
        beam=0.12,
        draught=0.01,
        body={"mass": MASS, "roll_inertia": 3e-4, "yaw_inertia": INERTIA},
        effects=effects,
        channels={f"{fan}_N": {"low": 0.0, "high": FULL} for fan in FANS},
        diagnosis={"facts": facts},
        **more,
    )


FACTS: dict[str, object] = {"no_water": True, "indoors": True, "moored": False}
CRAFT = craft(FACTS)
ELECTRIC = craft(FACTS, measured={"battery_V": {"neutral": NOMINAL}})


def floated(
    seed: int,
    inertia: float = 1.0,
    gains: Array | None = None,
    slope: tuple[float, float] = (0.0, 0.0),
    lags: Array | None = None,
    delays: Array | None = None,
    rates: Array | None = None,
    powers: Array | None = None,
    limits: Array | None = None,
    strongest: float = 0.25,
    fades: Array | None = None,
    power: float = 0.0,
    charge: tuple[float, float] = (1.0, 1.0),
    supply: float = 0.0,
) -> Recording:
    """A recording of the craft with other numbers than those of its data sheet.

    `lags` are time constants of the fans [s], `delays` their dead times in rows, `rates` the
    largest rates of their thrust [N/s], `powers` the exponents of their curves, and `limits` the
    largest thrusts [N]. The commands are up to `strongest` [N]. `fades` are the shares of the thrust
    that the fans lose in a second. The thrust is a `power` of the voltage of the battery, whose
    share of the nominal one at begin and end is `charge`. `supply` is the share that a fan loses
    while all others give full thrust.
    """
    rng = np.random.default_rng(seed)
    commands = np.repeat(rng.uniform(0.0, strongest, (ROWS // 10, len(FANS))), 10, axis=0)
    x, y, angle = np.array(list(FANS.values())).T
    strengths = np.ones(len(FANS)) if gains is None else gains
    lags = np.zeros(len(FANS)) if lags is None else lags
    ordered = commands.copy()
    for i, late in enumerate(np.zeros(len(FANS), int) if delays is None else delays):
        ordered[late:, i] = commands[: ROWS - late, i]
        ordered[:late, i] = commands[0, i]
    ordered = FULL * (ordered / FULL) ** (np.ones(len(FANS)) if powers is None else powers)
    if limits is not None:
        ordered = np.minimum(ordered, limits)
    level = np.linspace(*charge, ROWS) + 0.03 * np.sin(np.arange(ROWS) / RATE)
    ordered = ordered * level[:, None] ** power
    if fades is not None:
        ordered = ordered * (1.0 - fades * np.arange(ROWS)[:, None] / RATE)
    fastest = np.full(len(FANS), np.inf) if rates is None else rates

    def thrust_after(time: float, order: Array, begin: Array) -> Array:
        followed = order + (begin - order) * np.exp(-time / np.maximum(lags, 1e-9))
        most = fastest * max(time, 1e-12)
        return begin + np.clip(followed - begin, -most, most)

    def derivatives(s: Array, time: float, order: Array, begin: Array) -> list[float]:
        thrust = thrust_after(time, order, begin)
        others = thrust.sum() - thrust
        thrust = thrust * (1.0 - supply * others / (FULL * (len(FANS) - 1)))
        X, Y = thrust @ np.cos(angle), thrust @ np.sin(angle)
        N = thrust @ (x * np.sin(angle) - y * np.cos(angle))
        c, k = np.cos(s[2]), np.sin(s[2])
        north = (X * c - Y * k) / MASS + GRAVITY * slope[0]
        east = (X * k + Y * c) / MASS + GRAVITY * slope[1]
        return [s[3], s[4], s[5], north, east, N / (inertia * INERTIA)]

    s, poses, thrust = np.zeros(6), [], strengths * ordered[0]
    for order in strengths * ordered:
        poses.append(s[:3])
        s = odeint(derivatives, s, [0.0, 1.0 / RATE], args=(order, thrust), rtol=1e-8)[-1]
        thrust = thrust_after(1.0 / RATE, order, thrust)
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * [3e-4, 3e-4, 2e-3]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    signals |= {f"{fan}_N": commands[:, i] for i, fan in enumerate(FANS)}
    signals["battery_V"] = NOMINAL * level + 0.02 * rng.standard_normal(ROWS)
    return Recording(f"flight_{seed}", np.arange(ROWS) / RATE, signals, Notes())


def ranked(
    *recordings: Recording, tested: tuple[str, ...] = TESTED, boat: Vessel = CRAFT
) -> Ranking:
    program = Program(boat, candidate_library(boat).compiled_effects)
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, prior_noise_levels(boat, recordings), {"thrust": 0.05})
    return select_and_rank_candidates(problem, tested)


def test_no_candidate_of_a_craft_without_water_needs_water():
    floating = candidate_library(craft({"indoors": True}))
    assert set(floating.tested_names) >= WATER
    assert not set(candidate_library(CRAFT).tested_names) & WATER


def test_slope_and_yaw_inertia_are_candidates_only_without_water():
    for name in ("slope", "yaw_inertia_error"):
        assert name in candidate_library(CRAFT).tested_names
        assert "no_water" in candidate_library(craft({})).inapplicable[name]


def test_each_drive_is_an_ordinary_candidate_only_where_there_are_more_than_two():
    names = {f"drive_gain_error_{fan}" for fan in FANS}
    own = ("drive_lag", "drive_delay", "drive_rate_limit", "drive_exponent", "drive_limit")
    for effect in (*own, "drive_hysteresis", "drive_deadband"):
        names |= {f"{effect}_{fan}_N" for fan in FANS}
    assert names <= set(candidate_library(CRAFT).tested_names)
    two = candidate_library(vessel.load_vessel("trial_boat"))
    assert {"drive_lag", "drive_exponent"} <= set(two.tried_last)
    assert not names & set(two.tested_names)


def test_no_mass_on_board_is_tested_where_the_craft_was_weighed():
    assert {"extra_mass", "payload"} <= set(candidate_library(craft({})).tested_names)
    weighed = candidate_library(craft({"weighed": True}))
    assert not {"extra_mass", "payload"} & set(weighed.tested_names)
    assert weighed.excluded["extra_mass"] == "weighed = true"


def test_fitted_coefficients_stay_within_the_bounds_of_the_file_format():
    program = Program(CRAFT, ())
    recordings = [floated(1)]
    mapped = [map_recording(recording, program) for recording in recordings]
    problem = Problem(mapped, prior_noise_levels(CRAFT, recordings), {"thrust": 0.5})
    (gain,) = problem.nominal_coefficients
    bounds = type(CRAFT.effects[0]).params()["gain"]
    assert (gain.low, gain.high) == (bounds.low, bounds.high)  # all gains are 1


CASES: dict[str, tuple[dict[str, object], str, dict[str, float]]] = {
    "inertia": ({"inertia": 0.7}, "yaw_inertia_error", {"factor": 0.7}),
    "one fan": (
        {"gains": np.array([1.0, 1.0, 0.5, 1.0, 1.0, 1.0])},
        "drive_gain_error_b1",
        {"factor": 0.5},
    ),
    "slope": ({"slope": (0.01, -0.005)}, "slope", {"north": 0.01, "east": -0.005}),
    "battery": ({"supply": 0.4}, "shared_supply", {"loss": 0.4}),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.slow
def test_what_differs_from_the_data_sheet_is_found_with_its_size(case: str):
    changed, name, truth = CASES[case]
    sail: Callable[..., Recording] = floated
    ranking = ranked(sail(1, **changed), sail(2, **changed))
    assert [one.name for one in ranking.named] == [name]
    for parameter, true in truth.items():
        value, sd = ranking.best.value(name, parameter)
        assert abs(value - true) < 4.0 * sd
        assert sd < 0.2 * abs(true)


@pytest.mark.slow
def test_nothing_is_found_where_the_data_sheet_is_right():
    assert ranked(floated(3), floated(4)).named == ()


DYNAMICS = (
    "thrust_lag",
    "command_delay",
    *(f"drive_lag_{fan}_N" for fan in FANS),
    *(f"drive_delay_{fan}_N" for fan in FANS),
    *(f"drive_rate_limit_{fan}_N" for fan in FANS),
)
CURVES = (
    "thrust_exponent",
    *(f"drive_gain_error_{fan}" for fan in FANS),
    *(f"drive_exponent_{fan}_N" for fan in FANS),
)
FAN = np.arange(len(FANS)) == 2  # the third one, b1


@pytest.mark.parametrize(
    ("changed", "name", "parameter", "true"),
    [
        ({"lags": 0.12 * FAN}, "drive_lag_b1_N", "time_constant", 0.12),
        long({"delays": 5 * FAN}, "drive_delay_b1_N", "delay", 5 / RATE),
        ({"rates": np.where(FAN, 0.3, np.inf)}, "drive_rate_limit_b1_N", "rate", 0.3),
    ],
)
@pytest.mark.slow
def test_a_lag_a_dead_time_and_a_rate_limit_of_one_fan_are_found_with_the_fan(
    changed, name, parameter, true
):
    ranking = ranked(floated(1, **changed), floated(2, **changed), tested=DYNAMICS)
    assert [one.name for one in ranking.named] == [name]
    value, sd = ranking.best.value(name, parameter)
    assert abs(value - true) < max(4.0 * sd, 0.1 * true)


@pytest.mark.slow
def test_the_exponent_of_one_fan_is_found_with_the_fan() -> None:
    powers = np.where(FAN, 1.5, 1.0)
    ranking = ranked(floated(1, powers=powers), floated(2, powers=powers), tested=CURVES)
    assert [one.name for one in ranking.named] == ["drive_exponent_b1_N"]
    value, sd = ranking.best.value("drive_exponent_b1_N", "exponent")
    assert abs(value - 1.5) < max(4.0 * sd, 0.05)


LIMITS = (*CURVES, "thrust_limit", *(f"drive_limit_{fan}_N" for fan in FANS))


@pytest.mark.slow
def test_the_limit_of_one_fan_is_found_with_the_fan() -> None:
    limits = np.where(FAN, 0.4 * FULL, FULL)
    made = [floated(seed, limits=limits, strongest=FULL) for seed in (1, 2)]
    ranking = ranked(*made, tested=LIMITS)
    assert [one.name for one in ranking.named] == ["drive_limit_b1_N"]
    value, sd = ranking.best.value("drive_limit_b1_N", "share")
    assert abs(value - 0.4) < max(4.0 * sd, 0.01)


@pytest.mark.slow
def test_no_limit_is_found_where_the_fans_reach_their_full_thrust() -> None:
    assert ranked(*(floated(seed, strongest=FULL) for seed in (3, 4)), tested=LIMITS).named == ()


FADES = (*LIMITS, "thrust_fade", *(f"drive_fade_{fan}" for fan in FANS))


@pytest.mark.slow
def test_the_fan_whose_thrust_fades_is_found() -> None:
    fades = np.where(FAN, 0.02, 0.0)
    ranking = ranked(floated(1, fades=fades), floated(2, fades=fades), tested=FADES)
    assert [one.name for one in ranking.named] == ["drive_fade_b1"]
    value, sd = ranking.best.value("drive_fade_b1", "rate")
    assert abs(value - 0.02) < max(4.0 * sd, 0.01 * 0.02)


@pytest.mark.slow
def test_a_thrust_of_all_fans_that_fades_is_one_cause_and_none_where_it_does_not() -> None:
    fades = np.full(len(FANS), 0.01)
    ranking = ranked(floated(1, fades=fades), floated(2, fades=fades), tested=FADES)
    assert [one.name for one in ranking.named] == ["thrust_fade"]
    value, sd = ranking.best.value("thrust_fade", "rate")
    assert abs(value - 0.01) < max(4.0 * sd, 0.01 * 0.01)
    assert ranked(floated(3), floated(4), tested=FADES).named == ()


@pytest.mark.slow
def test_the_power_of_the_voltage_is_found_and_none_where_the_thrust_does_not_depend_on_it() -> (
    None
):
    tested = (*FADES, "thrust_with_voltage")
    charges = ((1.08, 0.98), (0.95, 0.85))
    made = [floated(seed, power=1.6, charge=one) for seed, one in enumerate(charges, 1)]
    ranking = ranked(*made, tested=tested, boat=ELECTRIC)
    assert [one.name for one in ranking.named] == ["thrust_with_voltage"]
    value, sd = ranking.best.value("thrust_with_voltage", "exponent")
    assert abs(value - 1.6) < max(4.0 * sd, 0.02)
    sound = [floated(seed, charge=one) for seed, one in enumerate(charges, 3)]
    assert ranked(*sound, tested=tested, boat=ELECTRIC).named == ()


def test_full_fits_go_to_other_drives_before_other_faults_of_one_that_was_fitted():
    recording = floated(1)
    program = Program(CRAFT, candidate_library(CRAFT).compiled_effects)
    mapped = [map_recording(recording, program)]
    problem = Problem(mapped, prior_noise_levels(CRAFT, [recording]), {"thrust": 0.05})
    sets = CandidateSets(problem, (), problem.nominal_hypothesis())
    key = frozenset[str]()
    ahead = [
        "drive_gain_error_b1",
        "drive_exponent_b1_N",
        "drive_fade_b1",
        "drive_lag_a1_N",
        "slope",
    ]
    assert sets.order_of_full_fits(key, ahead) == ahead
    sets.fitted_in_full.add((key, "drive_gain_error_b1"))
    left = ["drive_lag_a1_N", "slope", "drive_exponent_b1_N", "drive_fade_b1"]
    assert sets.order_of_full_fits(key, ahead) == left
    assert sets.order_of_full_fits(frozenset({"payload"}), ahead) == ahead
