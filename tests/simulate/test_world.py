"""Laws of the world: what moves, what touches, what it weighs, where the load's fittings are, and
what one sees."""

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from boatsim.errors import BadInput, BadPhysics
from boatsim.physics import hullform, vessel
from boatsim.physics.content import content_root
from boatsim.simulate import world
from boatsim.simulate.tank import Tank

MODELS = content_root() / "models"
VESSELS = ("joystick_boat", "trial_boat", "kvlcc2_roll")
JOINTS = {
    "joystick_boat": ["x", "y", "psi"],
    "trial_boat": ["x", "y", "psi"],
    "kvlcc2_roll": ["phi"],
}
WALLS = {"wall_ahead", "wall_astern", "wall_port", "wall_starboard"}
RHO = 1000.0  # [kg/m^3] fresh water
WALLED = Tank(length=1.5, width=3.0, depth=0.1)


@pytest.fixture(autouse=True)
def no_callback() -> Iterator[None]:
    mujoco.set_mjcb_passive(None)  # the world by itself: no water
    yield


@pytest.fixture(scope="module")
def boat() -> vessel.Vessel:
    return vessel.load_vessel("joystick_boat")


def mass_matrix(model: mujoco.MjModel) -> np.ndarray:
    """Dense M, built column by column from M v: needs nothing of how MuJoCo stores it."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    columns = np.zeros((model.nv, model.nv))
    for i, unit in enumerate(np.eye(model.nv)):
        mujoco.mj_mulM(model, data, columns[i], unit)
    return columns.T


def corners(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    """(n, 3) vertices of the shape that touches, in world axes."""
    geom = model.geom("collision").id
    at, count = (
        model.mesh_vertadr[model.geom_dataid[geom]],
        model.mesh_vertnum[model.geom_dataid[geom]],
    )
    return (
        data.geom_xpos[geom]
        + model.mesh_vert[at : at + count] @ data.geom_xmat[geom].reshape(3, 3).T
    )


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (m, 3) of an OBJ file."""
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([[float(x) for x in row[1:]] for row in rows if row[0] == "v"])
    return points, np.array([[int(i) - 1 for i in row[1:]] for row in rows if row[0] == "f"])


# --- mass and freedoms
# ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", VESSELS)
def test_joints_follow_the_freedoms_in_order(name: str) -> None:
    model = world.build_model(vessel.load_vessel(name), WALLED)
    assert [model.joint(i).name for i in range(model.njnt)] == JOINTS[name]
    assert model.nu == 0 and not model.opt.gravity.any()
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4


@pytest.mark.parametrize(
    "show", [True, False]
)  # a hull without child bodies is what MuJoCo calls simple
@pytest.mark.parametrize(
    "dof", [("surge", "sway", "yaw"), ("roll",), ("surge", "sway", "roll", "yaw")]
)
def test_mass_matrix_stores_its_whole_lower_triangle(
    boat: vessel.Vessel, dof: tuple[str, ...], show: bool
) -> None:
    level = boat.geometry | {
        "cg_above_keel": boat.draught
    }  # mass centre in the waterline: nothing offset
    model = world.build_model(replace(boat, dof=dof, geometry=level), WALLED, show=show)
    n = len(dof)
    assert model.M_rownnz.tolist() == list(range(1, n + 1))
    assert mujoco.MjData(model).M.shape == (n * (n + 1) // 2,)


def test_a_model_that_would_lose_added_mass_is_refused(boat: vessel.Vessel) -> None:
    simple = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>'
        '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody></mujoco>'
    )
    with pytest.raises(BadPhysics, match="joystick_boat: mass matrix"):
        world.check_mass_matrix(simple, boat)


@pytest.mark.parametrize("loads", [(), ("heavy",)])
def test_mass_and_inertia_are_those_of_the_vessel_about_its_mass_centre(
    loads: tuple[str, ...],
) -> None:
    boat = replace(vessel.load_vessel("joystick_boat", loads), dof=("surge", "sway", "roll", "yaw"))
    body = boat.body
    expected = np.diag([body.mass, body.mass, body.yaw_inertia, body.roll_inertia])
    assert mass_matrix(world.build_model(boat, WALLED)) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", VESSELS)
def test_hull_opens_alone_and_agrees_with_the_vessel_file(name: str) -> None:
    boat, model = (
        vessel.load_vessel(name),
        mujoco.MjModel.from_xml_path(str(MODELS / name / "hull.xml")),
    )
    hull = model.body("hull")
    assert model.numeric("drawn_for").data.tolist() == [boat.length, boat.beam, boat.draught]
    assert hull.mass[0] == boat.body.mass
    assert (hull.inertia[0], hull.inertia[2]) == (boat.body.roll_inertia, boat.body.yaw_inertia)
    height = boat.geometry["cg_above_keel"] - boat.draught
    assert hull.ipos == pytest.approx((boat.geometry["cg_from_transom"], 0, height))


@pytest.mark.parametrize("name", VESSELS)
def test_what_is_drawn_weighs_and_touches_nothing(name: str) -> None:
    model = world.build_model(vessel.load_vessel(name), WALLED)
    assert (
        not model.geom_contype.any() and not model.geom_conaffinity.any()
    )  # contacts only by explicit pair
    pairs = {
        (model.geom(a).name, model.geom(b).name)
        for a, b in zip(model.pair_geom1, model.pair_geom2, strict=True)
    }
    assert {n for pair in pairs for n in pair} == {"collision"} | WALLS and len(pairs) == 4
    assert model.body_mass.sum() == vessel.load_vessel(name).body.mass


def test_leaving_out_what_is_only_seen_changes_no_motion(boat: vessel.Vessel) -> None:
    ends = []
    for show in (True, False):
        model = world.build_model(boat, WALLED, show=show)
        data = mujoco.MjData(model)
        data.qvel[:] = (0.2, -0.3, 0.4)
        mujoco.mj_step(model, data, nstep=500)
        ends.append(data.qpos.copy())
    assert (ends[0] == ends[1]).all()
    assert model.ngeom == 5  # the hull's shape and four walls


# --- walls
# ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "velocity", [(0.3, 0, 0), (-0.3, 0, 0), (0, 0.3, 0), (0, -0.3, 0), (0.2, 0.3, 0.5)]
)
def test_boat_thrown_at_a_wall_stays_inside(
    boat: vessel.Vessel, velocity: tuple[float, float, float]
) -> None:
    tank = Tank(length=1.6, width=2.0, centre=(0.1, 0.2))
    model = world.build_model(boat, tank)
    data = mujoco.MjData(model)
    data.qvel[:] = velocity
    touched = 0
    for _ in range(1000):
        mujoco.mj_step(model, data)
        touched += data.ncon
        reach = np.abs(corners(model, data)[:, :2] - (tank.centre[0], -tank.centre[1])).max(0)
        assert reach[0] < tank.length / 2 + 0.01 and reach[1] < tank.width / 2 + 0.01
    assert touched > 0


def restitution(boat: vessel.Vessel, speed: float, step: float) -> float:
    """Share of its speed [m/s] with which a boat that coasts ahead comes back from the wall."""
    model = world.build_model(boat, Tank(2.5 * boat.length, 2.5 * boat.length, boat.length), step)
    data = mujoco.MjData(model)
    data.qvel[0] = speed
    for _ in range(round(2.0 * boat.length / speed / step)):
        mujoco.mj_step(model, data)
    assert data.ncon == 0
    return float(-data.qvel[0] / speed)


def test_a_wall_sends_a_hull_back_with_the_share_of_a_critically_damped_spring(
    boat: vessel.Vessel,
) -> None:
    """Spring and damper that cannot pull: v e^-wt (1 - wt) until the force is zero at wt = 2, so e^-2."""
    assert restitution(boat, 0.5, 0.001) == pytest.approx(math.exp(-2.0), abs=0.02)


@pytest.mark.parametrize(
    ("name", "speed"), [("joystick_boat", 0.1), ("joystick_boat", 0.5), ("mariner", 0.5)]
)
def test_a_wall_gives_little_back_at_the_usual_step(name: str, speed: float) -> None:
    step = 0.02  # [s]
    assert (
        0.09
        < restitution(
            vessel.load_vessel(name), speed * max(1.0, vessel.load_vessel(name).length / 50), step
        )
        < 0.19
    )


def test_elastic_wall_without_friction_turns_a_head_on_velocity_round(boat: vessel.Vessel) -> None:
    model = world.build_model(boat, WALLED, step=0.001, wall_solref=(-2000.0, 0.0))
    data = mujoco.MjData(model)
    data.qvel[:] = (0.1, 0.02, 0.0)
    mujoco.mj_step(model, data, nstep=3000)
    assert data.qvel == pytest.approx((-0.1, 0.02, 0.0), abs=1e-3)


def test_friction_slows_the_slide_along_a_wall(boat: vessel.Vessel) -> None:
    left = []
    for friction in (0.0, 0.5):
        model = world.build_model(boat, Tank(length=30.0, width=1.0), friction=friction)
        data = mujoco.MjData(model)
        data.qvel[:2] = (0.5, 0.3)
        mujoco.mj_step(model, data, nstep=500)
        left.append(data.qvel[0])
    assert left[0] == pytest.approx(0.5, abs=1e-9) and left[1] < 0.4


def test_open_water_never_stops_the_boat(boat: vessel.Vessel) -> None:
    model = world.build_model(boat, Tank(1.5, 3.0, walls=False))
    data = mujoco.MjData(model)
    data.qvel[:2] = (0.3, -0.4)
    mujoco.mj_step(model, data, nstep=1000)
    assert data.qpos == pytest.approx((6.0, -8.0, 0.0), abs=1e-9) and data.ncon == 0


def test_port_is_up_in_mujoco_and_the_tank_lies_where_start_axes_put_it(
    boat: vessel.Vessel,
) -> None:
    model = world.build_model(
        boat, Tank(length=2.0, width=4.0, centre=(0.3, 0.9))
    )  # most of the water to starboard
    ends = {name: model.geom(name).pos for name in WALLS}
    assert ends["wall_ahead"][0] == pytest.approx(1.3) and ends["wall_astern"][0] == pytest.approx(
        -0.7
    )
    assert ends["wall_port"][1] == pytest.approx(1.1) and ends["wall_starboard"][
        1
    ] == pytest.approx(-2.9)
    assert (
        model.body("fan").pos[1] > 1.1
    )  # the fan stands behind the port wall and blows to starboard


@pytest.mark.parametrize("name", ["joystick_boat", "mariner", "kvlcc2_full_scale"])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (-2.0, 3.0)])
def test_all_of_the_water_lies_before_the_sun(name: str, centre: tuple[float, float]) -> None:
    """What lies behind the plane of the sun is drawn in shadow, whose edge would cross the
    water."""
    boat = vessel.load_vessel(name)
    side = 10.0 * boat.length
    where = (centre[0] * boat.length, centre[1] * boat.length)
    model = world.build_model(boat, Tank(side, side, boat.length, walls=False, centre=where))
    sun, way = model.light("sun").pos, model.light("sun").dir
    for x in (-side / 2, side / 2):
        for y in (-side / 2, side / 2):
            corner = np.array([where[0] + x, -where[1] + y, boat.length])  # as high as any mast
            assert (corner - sun) @ way > boat.length


def test_tank_without_size_and_hull_without_body_are_refused(
    boat: vessel.Vessel, tmp_path: Path
) -> None:
    with pytest.raises(BadInput, match="tank.width = 0 m"):
        Tank(length=1.5, width=0.0)
    (tmp_path / "hull.xml").write_text('<mujoco><worldbody><body name="hul"/></worldbody></mujoco>')
    with pytest.raises(BadInput, match="did you mean 'hul'"):
        world.build_model(replace(boat, path=tmp_path))
    (tmp_path / "hull.xml").write_text("no XML")
    with pytest.raises(BadInput, match="hull.xml"):
        world.build_model(replace(boat, path=tmp_path))


@pytest.mark.parametrize("name", ["x", ".", "hull\0.xml", "h" * 300, "nowhere/hull.xml"])
def test_hull_that_is_no_file_is_refused_with_the_vessel_file_and_the_key(
    name: str, boat: vessel.Vessel
) -> None:
    with pytest.raises(BadInput) as refused:
        world.build_model(replace(boat, hull=name))
    assert str(refused.value).startswith(f"{boat.file}: hull = {name!r}: there is no file")


# --- loads
# ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("loads", "half"), [((), 0.19), (("wide",), 0.28), (("heavy", "wide"), 0.28)]
)
def test_outboards_stand_where_the_load_has_them(loads: tuple[str, ...], half: float) -> None:
    boat = vessel.load_vessel("joystick_boat", loads)
    model = world.build_model(boat, WALLED)
    aft = -boat.geometry["cg_from_transom"]
    assert model.body("outboard_port").pos == pytest.approx((aft, half, 0), abs=0.006)
    assert model.body("outboard_starboard").pos == pytest.approx((aft, -half, 0), abs=0.006)
    assert model.geom("mount").size[1] == half


def test_ballast_is_there_only_when_it_weighs_something() -> None:
    light, heavy = (
        world.build_model(vessel.load_vessel("joystick_boat", loads)) for loads in ((), ("heavy",))
    )
    names = [light.geom(i).name for i in range(light.ngeom)]
    assert "ballast" not in names and "led" in names
    assert heavy.geom("ballast").pos[0] == pytest.approx(
        0.9 - 0.571
    )  # bayless 2017: 0.9 m from the transom


@pytest.mark.parametrize(("loads", "length"), [((), 1.2), (("heavy",), 1.25)])
def test_hull_reaches_from_transom_to_bow_about_its_mass_centre(
    loads: tuple[str, ...], length: float
) -> None:
    boat = vessel.load_vessel("joystick_boat", loads)
    model = world.build_model(boat, WALLED)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    x = corners(model, data)[:, 0]
    aft = boat.geometry["cg_from_transom"]
    assert (x.min(), x.max()) == pytest.approx((-aft, length - aft), abs=1e-5)
    assert corners(model, data)[:, 2].min() == pytest.approx(-boat.draught, abs=1e-5)


# --- lines of the hull
# ---------------------------------------------------------------------------------------------


def test_committed_meshes_are_the_ones_the_particulars_give(tmp_path: Path) -> None:
    hullform.main([str(tmp_path)])
    files = sorted(p.name for p in tmp_path.glob("*.obj"))
    assert files == sorted(p.name for p in (MODELS / "joystick_boat").glob("*.obj"))
    for name in files:
        (points, faces), (points_now, faces_now) = (
            read_obj(folder / name) for folder in (MODELS / "joystick_boat", tmp_path)
        )
        assert points == pytest.approx(points_now, abs=2e-5) and (faces == faces_now).all()


def test_hull_has_the_published_length_beam_draught_and_deadrise() -> None:
    points, _ = read_obj(MODELS / "joystick_boat" / "shell.obj")
    assert np.ptp(points, axis=0)[:2] == pytest.approx((1.2, 0.30), abs=1e-3)
    assert points[:, 2].min() == pytest.approx(-0.06, abs=1e-4)
    x = np.unique(points[:, 0])
    middle = points[points[:, 0] == x[np.abs(x - 0.6).argmin()]]
    keel = middle[:, 2].min()
    bottom = middle[(middle[:, 1] > 0.01) & (middle[:, 1] < 0.10)]
    angles = np.degrees(np.arctan2(bottom[:, 2] - keel, bottom[:, 1]))
    assert len(angles) >= 2 and angles == pytest.approx(25.0, abs=0.1)


def test_hull_displaces_its_mass_and_floats_level() -> None:
    points, _ = read_obj(MODELS / "joystick_boat" / "shell.obj")
    depths = np.linspace(-0.06, 0.0, 241)
    stations = np.unique(points[:, 0])
    areas = []
    for x in stations:
        side = np.unique(points[(points[:, 0] == x) & (points[:, 1] >= 0)], axis=0)
        side = side[
            (side[:, 1] > 0) | (side[:, 2] == side[:, 2].min())
        ]  # drop the transom's centreline
        side = side[np.lexsort((side[:, 1], side[:, 2]))]
        half = np.interp(depths, side[:, 2], side[:, 1], left=0.0)
        areas.append(2 * np.trapezoid(half, depths))
    volume = np.trapezoid(areas, stations)
    assert volume * RHO == pytest.approx(4.6, rel=0.02)  # table 27: 4.6 kg at 0.06 m
    assert np.trapezoid(areas * stations, stations) / volume == pytest.approx(
        0.5, abs=0.01
    )  # under the mass centre


@pytest.mark.parametrize("part", ["shell", "outboard_cowl", "collision"])
def test_surfaces_face_outwards(part: str) -> None:
    points, faces = read_obj(MODELS / "joystick_boat" / f"{part}.obj")
    a, b, c = (points[faces[:, i]] - points.mean(0) for i in range(3))
    assert (np.einsum("ij,ij->i", a, np.cross(b, c)) > -1e-9).mean() > 0.95
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0


# --- pictures
# ------------------------------------------------------------------------------------------------------

DRAW = """
import sys
import numpy as np
try:
    from mujoco.egl import GLContext
    GLContext(64, 64).make_current()
except Exception as error:
    print(error)
    sys.exit(77)
import mujoco
from boatsim.physics import vessel
from boatsim.simulate import tank, world
model = world.build_model(vessel.load_vessel("joystick_boat"), tank.Tank(1.5, 3.0, 0.1, centre=(0.1, 0.0)))
data = mujoco.MjData(model)
pictures = {}
with mujoco.Renderer(model, 240, 320) as renderer:
    for camera in ("above", "oblique"):
        for y in (0.0, -0.8):
            data.qpos[1] = y
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera)
            pictures[f"{camera}{y:g}"] = renderer.render().astype(int)
np.savez(sys.argv[1], **pictures)
"""


def test_both_cameras_show_the_boat_move_to_starboard(tmp_path: Path) -> None:
    file = tmp_path / "pictures.npz"
    done = subprocess.run(
        [sys.executable, "-c", DRAW, str(file)],
        env={**os.environ, "MUJOCO_GL": "egl", "PYTHONPATH": str(Path(world.__file__).parents[2])},
        capture_output=True,
        text=True,
    )
    if done.returncode == 77:
        pytest.skip(f"no EGL: {done.stdout.strip()}")
    assert done.returncode == 0, done.stderr
    pictures = np.load(file)
    for picture in pictures.values():
        red, _, blue = np.moveaxis(picture, -1, 0)
        assert (blue > red + 50).mean() > 0.2  # water

    def deck(name: str) -> tuple[float, float]:
        red, _, blue = np.moveaxis(pictures[name], -1, 0)
        rows, columns = np.nonzero((red > blue + 10) & (red > 120))
        assert len(rows) > 100
        return float(rows.mean()), float(columns.mean())

    (row, column), (row_after, column_after) = deck("above0"), deck("above-0.8")
    width = 1.2 * 3.0 * 4 / 4  # [m] seen across the picture on the water: 1.2 times the tank's 3 m
    assert column_after - column == pytest.approx(0.8 / width * 320, rel=0.05)
    assert row_after == pytest.approx(row, abs=2)
    assert math.dist(deck("oblique0"), deck("oblique-0.8")) > 20
