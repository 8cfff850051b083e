"""What is measured of the surroundings: the law in closed form, a boat from another integrator,
what is left alone."""

from dataclasses import replace
from math import cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from answers import diagnosed, named
from raw_logs import imported
from scipy.integrate import solve_ivp

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.command_range import manoeuvre_commands
from boatsim.diagnosis.experiment_design.manoeuvres import available_manoeuvres
from boatsim.diagnosis.loading import open_recording
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array, make_motion
from boatsim.physics.effects.fan_wind import AIR_DENSITY, FanWind
from boatsim.physics.effects.measured_relative_wind import MeasuredRelativeWind
from boatsim.physics.effects.measured_wind import MeasuredWind
from boatsim.physics.effects.wind import Wind
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate import scenario
from boatsim.simulate.manoeuvre import complete_manoeuvring_table
from boatsim.simulate.run import run

HULL = {"front": 0.3, "side": 0.8, "arm": 0.05, "swing": -0.1}  # [m^2], [m]
KNOWN = """
[measured]
wind_mps = { about = "anemometer ashore" }
wind_from_rad = { about = "clockwise from the x axis" }
"""
BLOWN = """
[[effect]]
use = "measured_wind"
on = { speed = "wind_mps", comes_from = "wind_from_rad" }
front = 0.3
side = 0.8
arm = 0.05
swing = -0.1
"""


def with_anemometer(folder: Path, more: str = "") -> Vessel:
    return vessel.load_vessel(
        str(boats.written(folder, "blown", boats.PLANAR + KNOWN + BLOWN + more))
    )


def by_hand(speed: float, comes_from: float, psi: float, u: float, v: float) -> Array:
    """X, Y, N by the angle of attack."""
    ahead, abeam = -speed * cos(comes_from - psi) - u, -speed * sin(comes_from - psi) - v
    U, g = hypot(ahead, abeam), np.arctan2(abeam, ahead)
    k = 0.5 * AIR_DENSITY * U**2
    Y = k * HULL["side"] * sin(g)
    N = k * HULL["side"] * (HULL["arm"] * sin(g) + 0.5 * HULL["swing"] * sin(2.0 * g))
    return np.array([k * HULL["front"] * cos(g), Y, N])


# ---- the law


@pytest.mark.parametrize("seed", range(5))
def test_the_push_is_quadratic_in_the_air_past_the_hull_with_a_moment_of_two_harmonics(
    seed: int,
) -> None:
    speed, comes_from, psi, u, v = (
        np.random.default_rng(seed).uniform([0, -3, -3, -1, -1], [9, 3, 3, 1, 1]).tolist()
    )
    force = MeasuredWind(**HULL).wrench(
        make_motion(psi=psi, u=u, v=v), speed=speed, comes_from=comes_from
    )
    assert np.array(force)[[0, 1, 5]] == pytest.approx(by_hand(speed, comes_from, psi, u, v))


def test_a_reading_on_board_has_the_boats_own_way_in_it() -> None:
    psi, u, v = 0.7, 0.9, -0.3
    north, east = -4.0 * cos(2.0), -4.0 * sin(2.0)
    ahead, abeam = cos(psi) * north + sin(psi) * east - u, cos(psi) * east - sin(psi) * north - v
    read = {"speed": hypot(ahead, abeam), "comes_from": np.arctan2(-abeam, -ahead)}
    on_board = MeasuredRelativeWind(**HULL).wrench(make_motion(psi=psi, u=u, v=v), **read)
    true = MeasuredWind(**HULL).wrench(make_motion(psi=psi, u=u, v=v), speed=4.0, comes_from=2.0)
    assert on_board == pytest.approx(true)


@pytest.mark.parametrize("psi", [0.0, 1.0, 2.5, -2.0])
def test_a_boat_at_rest_takes_it_as_a_fan_or_a_steady_wind(psi: float) -> None:
    at, read = make_motion(psi=psi), {"speed": 4.0, "comes_from": 0.4 - pi}
    fan = FanWind(speed=4.0, toward=0.4, front=0.3, side=0.8, arm=0.05).wrench(at)
    assert MeasuredWind(**(HULL | {"swing": 0.0})).wrench(at, **read) == pytest.approx(fan)
    force = 0.5 * AIR_DENSITY * 16.0 * HULL["side"]
    steady = Wind(force=force, toward=0.4, arm=0.05, swing=-0.1, end_on=0.3 / 0.8)
    assert MeasuredWind(**HULL).wrench(at, **read) == pytest.approx(steady.wrench(at))


@pytest.mark.parametrize("seed", range(5))
def test_a_steady_wind_of_known_speed_is_the_measured_one_on_a_boat_under_way(seed: int) -> None:
    speed, toward, psi, u, v = (
        np.random.default_rng(seed).uniform([2, -3, -3, -3, -1], [9, 3, 3, 3, 1]).tolist()
    )
    at = make_motion(psi=psi, u=u, v=v)
    steady = Wind(
        force=0.5 * AIR_DENSITY * speed**2 * HULL["side"],
        toward=toward,
        arm=HULL["arm"],
        swing=HULL["swing"],
        end_on=HULL["front"] / HULL["side"],
        inverse_speed=1.0 / speed,
    )
    measured = MeasuredWind(**HULL).wrench(at, speed=speed, comes_from=toward - pi)
    assert steady.wrench(at) == pytest.approx(measured)


def test_no_wind_on_a_boat_that_drifts_with_it() -> None:
    drifting = make_motion(psi=0.0, u=-2.0 * cos(1.0), v=-2.0 * sin(1.0))
    assert MeasuredWind(**HULL).wrench(drifting, speed=2.0, comes_from=1.0) == pytest.approx(
        [0.0] * 6, abs=1e-12
    )


# ---- what is no command


@pytest.fixture(scope="module")
def boat(tmp_path_factory: pytest.TempPathFactory) -> Vessel:
    lag = '[[effect]]\nuse = "command_delay"\ndelay = 0.5\n\n[[effect]]\nuse = "thrust_lag"\ntime_constant = 0.4\n'
    return with_anemometer(tmp_path_factory.mktemp("vessels"), lag)


def test_nothing_that_acts_on_commands_acts_on_what_is_measured(boat: Vessel) -> None:
    measured = {"wind_mps", "wind_from_rad"}
    assert boat.inputs == (*boat.commands, "wind_mps", "wind_from_rad")
    assert set(boat.readings) == measured and not measured & {
        *boat.commands,
        *boat.actuators,
        *boat.angles,
    }
    everything = (*boat.effects, *candidate_library(boat).compiled_effects)
    assert not measured & {n for e in everything for n in boat.target_actuators(e)}
    assert not measured & {
        *manoeuvre_commands(boat),
        *complete_manoeuvring_table(boat).steer,
        *complete_manoeuvring_table(boat).ahead,
    }
    assert not measured & {
        n for m in available_manoeuvres(boat, {}, 0.0, False) for level in m.levels for n in level
    }


def test_a_reading_is_in_force_at_once_where_commands_are_late(boat: Vessel) -> None:
    program = Program(boat)
    act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
    values, on = program.values(), program.effect_switches()
    program.simulation_functions.settle_actuators(
        program.command_array({}), memory, values, on, act
    )
    sent = program.command_array({"thrust_port_N": 50.0})
    sent[-2:] = 7.0, 2.0
    program.simulation_functions.advance_actuators(sent, memory, 0.02, values, on, act)
    held = dict(zip(boat.law_signals, act.reshape(3, -1).T.tolist(), strict=True))
    assert held["thrust_port_N"] == [0.0, 0.0, 0.0]
    assert held["wind_mps"] == [7.0] * 3 and held["wind_from_rad"] == [2.0] * 3
    assert held["cos_wind_from_rad"] == pytest.approx([cos(2.0)] * 3)
    assert held["sin_wind_from_rad"] == pytest.approx([sin(2.0)] * 3)


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ('[[effect]]\nuse = "thrust_lag"\non = "wind_mps"\n', "wind_mps"),
        (
            '[[effect]]\nuse = "measured_relative_wind"\non = { speed = "wind_mps" }\n',
            "on.comes_from is missing",
        ),
        (
            '[[effect]]\nuse = "measured_wind"\nname = "b"\non = { speed = "wind_mp" }\n',
            "'wind_mps'",
        ),
    ],
)
def test_a_wrong_binding_is_one_line(tmp_path: Path, more: str, line: str) -> None:
    with pytest.raises(BadInput, match=line) as found:
        with_anemometer(tmp_path, more)
    assert "\n" not in str(found.value)


def test_a_channel_is_either_sent_or_measured(tmp_path: Path) -> None:
    text = boats.PLANAR + "\n[measured]\nthrust_port_N = {}\n"
    with pytest.raises(BadInput, match=r"thrust_port_N is in both \[channels\] and \[measured\]"):
        vessel.load_vessel(str(boats.written(tmp_path, "twice", text)))


# ---- in a simulation


def blown_scenario(folder: Path, **keys: Any) -> scenario.Scenario:
    with_anemometer(folder)
    (folder / "adrift.toml").write_text(
        'vessel = "blown/"\nduration = 4.0\ncontroller = { use = "open_loop" }\n'
    )
    return scenario.load(str(folder / "adrift.toml"), keys)


@pytest.mark.slow
def test_a_scenario_says_what_is_measured_and_the_log_has_it(tmp_path: Path) -> None:
    wind = {"wind_mps": 6.0, "wind_from_rad": -pi / 2}
    log = run(blown_scenario(tmp_path, measured=wind)).recording
    assert set(log["wind_mps"]) == {6.0} and log["wind_from_rad"][0] == pytest.approx(-pi / 2)
    assert (
        log["wind_Y_N"][0] == pytest.approx(by_hand(6.0, -pi / 2, 0.0, 0.0, 0.0)[1])
        and log["y_m"][-1] > 0.1
    )
    still = run(blown_scenario(tmp_path)).recording
    assert not still["wind_mps"].any() and not still["y_m"].any()
    file = tmp_path / "adrift.csv"
    write_csv(log, file)
    recording, boat = open_recording(file, str(tmp_path / "blown/"), ())
    assert map_recording(recording, Program(boat)).commands[0].tolist() == pytest.approx(
        [0.0] * 4 + list(wind.values())
    )


def test_what_is_not_measured_can_not_be_set(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="did you mean 'wind_mps'"):
        blown_scenario(tmp_path, measured={"wind_mp": 3.0})
    with pytest.raises(BadInput, match="wind_mps"):
        blown_scenario(tmp_path, goal=[{"wind_mps": 3.0}])


def test_an_environment_has_no_action_on_the_weather(tmp_path: Path) -> None:
    env = pytest.importorskip(
        "boatsim.simulate.env",
        reason="dm_control does not support Python 3.13 and later",
        exc_type=ImportError,
    )
    world = env.load(blown_scenario(tmp_path, measured={"wind_mps": 6.0}))
    spec = world.action_spec()
    assert spec.shape == (4,) and "wind" not in spec.name
    world.reset()
    world.step(np.zeros(4))
    assert world.physics.control().shape == (4,)
    assert world.physics.engine.state.u < 0.0  # from ahead


# ---- in a recording


def read_back(folder: Path, columns: dict[str, Array]) -> tuple[Recording, Vessel]:
    t = 0.1 * np.arange(60)
    still = {
        n: 0.0 * t
        for n in ("x_m", "y_m", "psi_rad", *vessel.load_vessel(str(folder / "blown/")).commands)
    }
    file = folder / "log.csv"
    write_csv(Recording("log", t, still | columns), file)
    return open_recording(file, str(folder / "blown/"), ())


def test_a_recording_without_the_anemometer_is_one_line(tmp_path: Path) -> None:
    with_anemometer(tmp_path)
    recording, boat = read_back(tmp_path, {"wind_mps": np.full(60, 2.0)})
    with pytest.raises(BadInput, match="log.csv.*column wind_from_rad is missing") as found:
        map_recording(recording, Program(boat))
    assert "\n" not in str(found.value)


def test_a_direction_that_passes_north_has_the_mean_of_its_neighbours(tmp_path: Path) -> None:
    with_anemometer(tmp_path)
    gone_round = np.where(np.arange(60) % 2, 0.1, 2 * pi - 0.1)
    recording, _ = read_back(tmp_path, {"wind_mps": np.full(60, 2.0), "wind_from_rad": gone_round})
    assert np.cos(recording.thinned(5.0)["wind_from_rad"]) == pytest.approx(1.0)


# ---- a boat from elsewhere


def weather(t: float) -> tuple[float, float]:
    """A wind that gusts and veers: speed [m/s], where it comes from [rad]."""
    return 3.0 + 1.2 * sin(0.7 * t) + 0.6 * sin(1.9 * t + 1.0), 0.5 + 0.9 * sin(0.11 * t)


def sailed(name: str, seed: int) -> Recording:
    """The trial boat in that wind from scipy's integrator; nothing here is the tool's."""
    rng, every, rows = np.random.default_rng(seed), 0.1, 300
    levels = np.column_stack(
        [rng.uniform(-0.9, 0.9, (rows // 25, 2)), rng.uniform(-0.6, 0.6, (rows // 25, 2))]
    )
    commands, t = np.repeat(levels, 25, axis=0), every * np.arange(rows)
    start = rng.uniform(0.0, 50.0)

    def rates(now: float, y: Array, command: Array) -> list[float]:
        psi, u, v, r = y[2:]
        thrust, angle = command[:2], command[2:]
        Xs, Ys = thrust * np.cos(angle), thrust * np.sin(angle)
        X_A, Y_A, N_A = 0.1 * by_hand(*weather(start + now), psi, u, v)
        X, Y = Xs.sum() - 3.0 * u + X_A, Ys.sum() - 10.0 * v + Y_A
        N = -0.6 * Ys.sum() + 0.19 * (Xs[0] - Xs[1]) - r + N_A
        du, dv, dr = (X + 4.6 * v * r) / 4.9, (Y - 4.6 * u * r) / 13.6, N / 1.3
        return [u * cos(psi) - v * sin(psi), u * sin(psi) + v * cos(psi), r, du, dv, dr]

    y, poses = np.zeros(6), []
    for now, command in zip(t, commands, strict=True):
        poses.append(y[:3])
        y = solve_ivp(rates, (now, now + every), y, rtol=1e-8, atol=1e-10, args=(command,)).y[:, -1]
    seen = np.array(poses) + rng.normal(0.0, [0.003, 0.003, 0.01], (rows, 3))
    names = ("x_m", "y_m", "psi_rad", *vessel.load_vessel("trial_boat").commands)
    wind = np.array(
        [weather(start + now + 0.5 * every) for now in t]
    )  # a reading holds until the next
    columns = np.column_stack([seen, commands, wind])
    return Recording(
        name, t, dict(zip((*names, "wind_mps", "wind_from_rad"), columns.T, strict=True))
    )


def trial_boat(folder: Path, known: bool) -> str:
    """The nominal boat of those runs, with its anemometer or without."""
    text = (vessel.load_vessel("trial_boat").file).read_text(encoding="utf-8")
    text = text.replace("walls_m = [-4.0, 4.0, -3.0, 3.0], ", "").split("  # the tank")[0]
    areas = BLOWN.replace("0.3", "0.03").replace("0.8", "0.08")
    return str(boats.written(folder, "blown", text + "\n" + (KNOWN + areas if known else "")))


@pytest.mark.long
@pytest.mark.slow
def test_with_the_wind_known_nothing_is_missing_and_without_it_something_is(tmp_path: Path) -> None:
    runs = [sailed(f"run_{seed}", seed) for seed in range(2)]
    with_it = diagnosed(runs, tmp_path, trial_boat(tmp_path, True))
    assert with_it["verdict"] == "nothing_missing" and not with_it["effects"], with_it["sentence"]
    (other := tmp_path / "unknown").mkdir()
    bare = [
        replace(r, signals={k: x for k, x in r.signals.items() if not k.startswith("wind")})
        for r in runs
    ]
    without = diagnosed(bare, other, trial_boat(other, False))
    assert without["verdict"] != "nothing_missing", without["sentence"]
    assert "wind" in [e["name"] for e in without["effects"]] or without["unknown"]["flag"], without[
        "sentence"
    ]


ABOARD = """
[measured]
apparent_wind_mps = { about = "anemometer in the mast" }
apparent_wind_from_rad = { about = "clockwise from the bow" }
"""


def test_it_is_a_candidate_where_the_vessel_names_and_the_recordings_have_its_columns(
    tmp_path: Path,
) -> None:
    bare = candidate_library(vessel.load_vessel("trial_boat"))
    assert "wind_mps and wind_from_rad are not in" in bare.inapplicable["measured_wind"]
    boat = vessel.load_vessel(str(boats.written(tmp_path, "aboard", boats.PLANAR + ABOARD)))
    name, columns = "measured_relative_wind", ["apparent_wind_mps", "apparent_wind_from_rad"]
    assert name in candidate_library(boat, columns=["x_m", *columns]).tested_names
    half = candidate_library(boat, columns=["x_m", "apparent_wind_mps"])
    assert "apparent_wind_from_rad was recorded" in half.excluded[name]
    assert "measured_wind" in candidate_library(boat).inapplicable


def test_a_vessel_with_the_effect_has_it_as_a_coefficient_and_not_as_a_candidate(
    boat: Vessel,
) -> None:
    library = candidate_library(boat, columns=["wind_mps", "wind_from_rad"])
    assert not {"measured_wind", "further_measured_wind"} & set(library.tested_names)


def apparent(run: Recording) -> Recording:
    """The run with the wind as an anemometer on board measures it, and not ashore."""
    t, psi = run.t, run["psi_rad"]
    north, east = np.gradient(run["x_m"], t), np.gradient(run["y_m"], t)
    kernel = np.ones(11) / 11
    north, east = np.convolve(north, kernel, "same"), np.convolve(east, kernel, "same")
    speed, comes_from = run["wind_mps"], run["wind_from_rad"]
    air = -speed * np.exp(1j * comes_from) - (north + 1j * east)
    past = air * np.exp(-1j * psi)
    kept = {k: x for k, x in run.signals.items() if not k.startswith("wind")}
    kept |= {"apparent_wind_mps": abs(past), "apparent_wind_from_rad": np.angle(-past)}
    return replace(run, signals=kept)


@pytest.mark.slow
def test_from_the_raw_log_of_an_owner_the_wind_is_named_with_its_areas(tmp_path: Path) -> None:
    """Apparent wind in knots, its angle in degrees to both sides, heading in degrees."""
    bare = trial_boat(tmp_path, False)
    boat = tmp_path / "aboard"
    boat.mkdir()
    text = (Path(bare) / "vessel.toml").read_text(encoding="utf-8")
    boats.written(boat, "blown", text + ABOARD)
    runs = []
    for seed in range(3):
        run = apparent(sailed(f"run_{seed}", seed))
        raw = {"time": run.t, "psi_deg": np.degrees(run["psi_rad"]) % 360.0}
        raw |= {
            name: run[name] for name in ("x_m", "y_m", *vessel.load_vessel("trial_boat").commands)
        }
        raw["AWS_kn"] = run["apparent_wind_mps"] * 3600.0 / 1852.0
        raw["AWA"] = np.degrees(run["apparent_wind_from_rad"])
        folder = tmp_path / f"log_{seed}"
        folder.mkdir()
        recording, _ = imported(folder, boat / "blown", raw)
        runs.append(replace(recording, name=f"run_{seed}", notes=run.notes))
    answer = diagnosed(runs, tmp_path, str(boat / "blown"))
    true = {"front_m2": 0.03, "side_m2": 0.08, "arm_m": 0.05, "swing_m": -0.1}
    named(answer, "measured_relative_wind", true)
