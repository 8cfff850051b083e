"""A current that varies: the forces of its acceleration, waves on it, and every engine alike."""

from collections.abc import Callable
from dataclasses import replace
from math import cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import boats
import numpy as np
import pytest
from alike import few
from scipy.integrate import solve_ivp

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.physics.vessel.wave_field import wave_field
from boatsim.simulate.batch import Batch
from boatsim.simulate.engine import Engine
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run import run
from boatsim.simulate.scenario import load
from boatsim.simulate.stepper import State

TABLE = Path(__file__).parents[2] / "data" / "current.csv"
STEP = 0.01  # [s]
RAMP = ((0.0, 0.0, 0.0), (5.0, 0.5, -0.25))  # t, north, east
BENT = ((0.0, 0.0, 0.0), (2.0, 0.2, -0.1), (3.0, 0.1, 0.1), (5.0, 0.1, 0.1))


def written(folder: Path, columns: str, rows: Any) -> str:
    """Path of the table with these columns."""
    path = folder / "tide.csv"
    lines = [",".join(f"{value:.17g}" for value in row) for row in rows]
    path.write_text("\n".join([columns, *lines]) + "\n", encoding="utf-8")
    return str(path)


def ramp(folder: Path) -> str:
    """Path of a table of a current that varies in time alone."""
    return written(folder, "t_s,north_mps,east_mps", RAMP)


def moved_water(t: float, rows: Any = RAMP) -> Array:
    """Displacement since t = 0 of water whose velocity is that of a table."""
    times, *velocities = np.array(rows).T
    fine = np.unique(np.append(np.linspace(0.0, t, 1001), times[times < t]))
    return np.array([np.trapezoid(np.interp(fine, times, v), fine) for v in velocities])


def field_table(folder: Path, velocity: Callable[[float, float], tuple[float, float]]) -> str:
    """Path of a steady table with the velocity of a field at the corners of a square of 200 m.

    In between it is the field itself, if that is linear in x and in y.
    """
    rows = [(x, y, *velocity(x, y)) for x in (-100.0, 100.0) for y in (-100.0, 100.0)]
    return written(folder, "x_m,y_m,north_mps,east_mps", rows)


def in_table(vessel: Vessel, file: str, **settings: float) -> Vessel:
    return vessel.with_effect({"use": "current_table", "file": file, **settings})


def ended(vessel: Vessel, start: State, seconds: float, engine: type[Any] = OpenWater) -> State:
    """State of a vessel without commands after some time."""
    one = engine(vessel, step=STEP)
    one.reset(start)
    one.advance(round(seconds / STEP))
    return State(*one.state)


ALL = ("trial_boat", "otter", "mariner", "joystick_boat")  # without a wind


@pytest.mark.parametrize("name", few(ALL, 2))
@pytest.mark.parametrize("engine", [OpenWater, Engine])
def test_in_a_uniform_current_any_boat_moves_through_accelerating_water_as_through_still_water(
    name: str, engine: type[Any], tmp_path: Path
) -> None:
    """Gravity and acceleration are equal: the slope of the surface accelerates boat and water."""
    vessel = load_vessel(name)
    start = State(x=1.0, y=-2.0, psi=0.7, u=0.8, v=-0.1, r=0.05)
    still = ended(vessel, start, 4.0, engine)
    carried = ended(in_table(vessel, ramp(tmp_path)), start, 4.0, engine)
    north, east = 0.4, -0.2  # the water at the end
    c, s = cos(still.psi), sin(still.psi)
    x, y = np.array([still.x, still.y]) + moved_water(4.0)
    u, v = still.u + c * north + s * east, still.v + c * east - s * north
    same = [still.psi, still.r, still.phi, still.p]
    tolerance = {"abs": 1e-7}
    assert [carried.psi, carried.r, carried.phi, carried.p] == pytest.approx(same, **tolerance)
    assert (carried.x, carried.y) == pytest.approx((x, y), **tolerance)
    if not still.theta:  # u and v of a hull that pitches are not level
        assert (carried.u, carried.v) == pytest.approx((u, v), **tolerance)


def test_a_bend_of_the_table_is_met_at_most_a_sixth_of_a_step_early(tmp_path: Path) -> None:
    boat = boats.planar(tmp_path, settings=boats.WITHOUT_DRAG)
    vessel = in_table(boat, written(tmp_path, "t_s,north_mps,east_mps", BENT))
    for engine in (OpenWater, Engine):
        found = ended(vessel, State(), 5.0, engine)
        early = STEP / 6.0 * np.array([-0.2 + 0.1, 0.25 - 0.2])  # sum of the changes of slope
        assert (found.u, found.v) == pytest.approx(np.array([0.1, 0.1]) + early, abs=1e-6)


def test_ballast_away_from_the_origin_drifts_with_the_water_too(tmp_path: Path) -> None:
    load = {"use": "extra_mass", "mass": 2.0, "x": 0.3}
    vessel = in_table(boats.planar(tmp_path).with_effect(load), ramp(tmp_path))
    for engine in (OpenWater, Engine):
        drifted = ended(vessel, State(psi=0.4), 4.0, engine)
        assert drifted.psi == pytest.approx(0.4, abs=1e-9)
        assert (drifted.x, drifted.y) == pytest.approx(moved_water(4.0), abs=1e-9)


def test_a_uniform_steady_table_is_a_current(tmp_path: Path) -> None:
    boat, start = load_vessel("otter"), State(psi=0.4, u=1.0, r=0.2)
    sea = {"significant_height": 0.1, "modal_period": 2.0, "toward": 1.0}
    boat = boat.with_effect({"use": "irregular_sea", **sea})
    file = written(
        tmp_path,
        "t_s,x_m,north_mps,east_mps",
        [(t, x, 0.3, -0.2) for t in (1.0, 3.0) for x in (0.0, 2.0)],
    )
    plain = ended(boat.with_effect({"use": "current", "north": 0.3, "east": -0.2}), start, 5.0)
    assert ended(in_table(boat, file), start, 5.0) == pytest.approx(plain, abs=1e-10)
    half = ended(in_table(boat, file, scale=0.5), start, 5.0)
    weak = ended(boat.with_effect({"use": "current", "north": 0.15, "east": -0.1}), start, 5.0)
    assert half == pytest.approx(weak, abs=1e-10)


def test_a_table_adds_to_a_current_and_begins_at_its_start(tmp_path: Path) -> None:
    file = ramp(tmp_path)
    boat = boats.planar(tmp_path, settings={"current": {"north": -0.2}})
    engine = OpenWater(in_table(boat, file, start=2.5, scale=2.0))
    assert engine.water_velocity() == pytest.approx((0.5 - 0.2, -0.25))  # twice 0.25 and -0.125


def test_a_boat_without_drag_drifts_along_the_streamlines(tmp_path: Path) -> None:
    """Solid rotation: the water is accelerated towards the middle, and so is the boat."""
    rate, radius = 0.2, 6.0
    file = field_table(tmp_path, lambda x, y: (-rate * y, rate * x))
    vessel = in_table(boats.planar(tmp_path, settings=boats.WITHOUT_DRAG), file)
    start = State(x=radius, psi=0.3, u=rate * radius * sin(0.3), v=rate * radius * cos(0.3))
    for engine in (OpenWater, Engine):
        found = ended(vessel, start, 10.0, engine)
        expected = radius * np.array([cos(rate * 10.0), sin(rate * 10.0)])
        assert (found.x, found.y) == pytest.approx(expected, abs=1e-6)
        assert found.psi == pytest.approx(0.3, abs=1e-9)  # the shear of the water does not turn it


def test_drifting_in_a_field_of_any_shape_is_that_of_the_water_itself(tmp_path: Path) -> None:
    def field(x: float, y: float) -> tuple[float, float]:
        return 0.4 + 0.05 * x - 0.03 * y, -0.2 + 0.04 * x - 0.05 * y

    vessel = in_table(boats.planar(tmp_path), field_table(tmp_path, field))
    path = solve_ivp(lambda t, z: field(*z), (0.0, 8.0), [2.0, 1.0], rtol=1e-11, atol=1e-12)
    north, east = field(2.0, 1.0)
    start = State(x=2.0, y=1.0, u=north, v=east)
    found = ended(vessel, start, 8.0)
    assert (found.x, found.y) == pytest.approx(path.y[:, -1], abs=1e-7)


SWAY_ADDED, MASS = 3.0, 6.0  # [kg] of the planar boat


def test_a_boat_that_enters_a_parallel_jet_gains_the_share_of_its_added_mass(
    tmp_path: Path,
) -> None:
    """No pressure accelerates water of a jet: the fluid that moves with the hull alone gains."""
    file = field_table(tmp_path, lambda x, y: (0.02 * y, 0.0))
    text = boats.PLANAR.replace('"surge", "sway", "yaw"', '"surge", "sway"')
    folder = boats.written(tmp_path, "held_heading", text)
    vessel = in_table(load_vessel(str(folder), settings=boats.WITHOUT_DRAG), file)
    engine = OpenWater(vessel, step=STEP)
    # it points to north and is carried east, across the jet, by its sway
    engine.reset(State(v=1.5))
    engine.advance(400)
    surge_added = 0.6
    assert engine.state.v == pytest.approx(1.5, abs=1e-12)
    gained = surge_added / (MASS + surge_added) * 0.02 * engine.state.y
    assert engine.state.u == pytest.approx(gained, rel=1e-9)


def test_a_boat_held_in_water_that_speeds_up_feels_the_pressure_on_its_own_mass(
    tmp_path: Path,
) -> None:
    """Steady flow converges along x: (V grad) V acts on the displaced mass, and no added mass."""
    file = field_table(tmp_path, lambda x, y: (0.5 + 0.02 * x, -0.02 * y))
    vessel = in_table(boats.planar(tmp_path, settings=boats.WITHOUT_DRAG), file)
    engine = OpenWater(vessel)
    engine.reset(State(x=3.0))
    speed = 0.5 + 0.02 * 3.0
    ahead, _ = engine.acceleration()
    assert (MASS + 0.6) * ahead == pytest.approx(MASS * speed * 0.02)


def test_mujoco_and_the_compiled_engine_agree_in_a_table() -> None:
    start = State(x=3.0, y=-5.0, psi=0.4, u=0.3, r=0.1)
    for name in ("otter", "trial_boat"):
        vessel = in_table(load_vessel(name), str(TABLE), start=1.5)
        compiled, mujoco = ended(vessel, start, 5.0), ended(vessel, start, 5.0, Engine)
        assert mujoco == pytest.approx(compiled, abs=1e-9)


def test_a_batch_has_a_table_for_each_boat(tmp_path: Path) -> None:
    vessels = [
        in_table(boats.planar(tmp_path), str(TABLE), start=1.0, scale=scale)
        for scale in (0.0, 0.4, 1.0)
    ]
    batch = Batch(vessels, step=STEP)
    batch.reset()
    batch.advance({}, 300)
    for row, vessel in zip(batch.states, vessels, strict=True):
        alone = ended(vessel, State(), 3.0)
        assert row[[0, 1, 2]] == pytest.approx([alone.x, alone.y, alone.psi], abs=1e-12)


WAVES = {
    "irregular_sea": {"components": 12.0},
    "strip_wave_loads": {"components": 12.0, "hull_spacing": 0.79, "hull_beam": 0.25},
}


@pytest.mark.parametrize("sea", WAVES)
def test_waves_travel_on_accelerating_water(sea: str, tmp_path: Path) -> None:
    """The boat meets the same waves as on still water, at the same place in the water."""
    table = {"use": sea, "significant_height": 0.1, "modal_period": 2.0, "toward": 0.8}
    still = load_vessel("otter").with_effect(table | WAVES[sea])
    carried = in_table(still, ramp(tmp_path))
    start = State(psi=0.2, u=0.5)
    on_still, on_moving = ended(still, start, 4.0), ended(carried, start, 4.0)
    assert on_moving.psi == pytest.approx(on_still.psi, abs=1e-7)
    assert on_moving.phi == pytest.approx(on_still.phi, abs=1e-7)
    north, east = moved_water(4.0)
    moved = (on_still.x + north, on_still.y + east)
    assert (on_moving.x, on_moving.y) == pytest.approx(moved, abs=1e-7)
    here = wave_field(carried.effects).elevation(*moved, 4.0)
    assert here == pytest.approx(wave_field(still.effects).elevation(on_still.x, on_still.y, 4.0))


def test_a_mean_over_the_draught_of_the_vessel_unless_another_is_given(tmp_path: Path) -> None:
    rows = [(0.0, 0.6, 0.0), (0.2, 0.2, 0.0)]
    file = written(tmp_path, "depth_m,north_mps,east_mps", rows)
    boat = boats.planar(tmp_path)  # draught 0.1 m: the mean of 0.6 and 0.4
    assert OpenWater(in_table(boat, file)).water_velocity()[0] == pytest.approx(0.5)
    surface = in_table(boat, file, draught=0.0)
    assert OpenWater(surface).water_velocity()[0] == pytest.approx(0.6)


SCENARIO = """
vessel = "trial_boat"
duration = 4.0
log = 0.5
engine = "{engine}"

[controller]
use = "open_loop"

[[goal]]
thrust_port_N = 0.5
thrust_starboard_N = 0.4

[[effect]]
use = "current_table"
file = "tide.csv"
scale = 0.8
"""


@pytest.mark.parametrize("engine", ["mujoco", "compiled"])
def test_the_log_has_the_velocity_of_the_water_at_the_boat(engine: str, tmp_path: Path) -> None:
    (tmp_path / "tide.csv").write_text(TABLE.read_text())
    file = tmp_path / "drift.toml"
    file.write_text(SCENARIO.format(engine=engine))
    scenario = load(str(file))
    log = run(scenario).recording
    (effect,) = scenario.vessel.effects_of_type("current_table")
    for i, t in enumerate(log.t):
        place = float(log["x_m"][i]), float(log["y_m"][i])
        found = log["water_north_mps"][i], log["water_east_mps"][i]
        assert found == pytest.approx(effect.velocity_at(float(t), *place), abs=1e-12)
    assert np.ptp(log["water_north_mps"]) > 0.01
    assert log.unit("water_north_mps") == "m/s"


def test_a_table_is_required_and_a_bad_one_is_refused_when_the_vessel_is_loaded(
    tmp_path: Path,
) -> None:
    boat = boats.planar(tmp_path)
    with pytest.raises(BadInput, match="current_table needs file = a CSV file with the columns"):
        boat.with_effect({"use": "current_table"})
    with pytest.raises(BadInput, match="tides.csv: no such file"):
        in_table(boat, "tides.csv")


def test_the_speed_of_a_held_boat_through_the_water_is_that_of_the_table(tmp_path: Path) -> None:
    """Drag alone, at rest over ground: the force of the law at the local velocity."""
    file = field_table(tmp_path, lambda x, y: (0.3 + 0.01 * y, 0.0))
    boat = replace(boats.planar(tmp_path), effects=())
    vessel = boat.with_effect({"use": "linear_damping", "surge": 3.0, "sway": 10.0})
    engine = OpenWater(in_table(vessel, file))
    for heading in (0.0, 0.5 * pi, 2.0):
        engine.reset(State(y=20.0, psi=heading))
        force = engine.wrench()
        assert (force.X, force.Y) == pytest.approx((3.0 * 0.5 * cos(heading), -5.0 * sin(heading)))
        assert hypot(*engine.water_velocity()) == pytest.approx(0.5)
