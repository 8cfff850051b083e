"""Builds the MuJoCo model of a vessel in a tank. Axes are MuJoCo's: z up, y to port."""

import math
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TypeAlias
from warnings import catch_warnings, filterwarnings

import mujoco
import numpy as np

from boatsim.errors import BadInput, BadPhysics, unknown_name_message
from boatsim.physics.content import content_root
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.hull_assets import check_assets
from boatsim.simulate.hull_xml_check import check_hull_file, check_hull_text
from boatsim.simulate.tank import Tank

Model: TypeAlias = mujoco.MjModel  # for modules that must not import mujoco
WALL = 0.02  # [m] half of a wall's thickness
RIM = 0.08  # [m] wall above the water
DRAWN = math.hypot(0.75, 1.5)  # [m] from the middle to a corner of the tank in tank.xml
# solref: time constant [s] (two steps of 20 ms), critically damped. A wall only pushes, so that the
# hull leaves it with e^-2 = 0.14 of its speed, or 0.10 to 0.18 with steps as long as the time
# constant
SOFT_WALL = (0.04, 1.0)
# degree of freedom -> name, kind and axis of its joint; yaw, pitch and roll turn in this order
JOINTS = {
    "surge": ("x", mujoco.mjtJoint.mjJNT_SLIDE, (1, 0, 0)),
    "sway": ("y", mujoco.mjtJoint.mjJNT_SLIDE, (0, 1, 0)),
    "heave": ("z", mujoco.mjtJoint.mjJNT_SLIDE, (0, 0, 1)),
    "yaw": ("psi", mujoco.mjtJoint.mjJNT_HINGE, (0, 0, 1)),
    "pitch": ("theta", mujoco.mjtJoint.mjJNT_HINGE, (0, 1, 0)),
    "roll": ("phi", mujoco.mjtJoint.mjJNT_HINGE, (1, 0, 0)),
}
HALF_TURN = (0.0, 1.0, 0.0, 0.0)  # about x, exact in floating point


def open_water(vessel: Vessel) -> Tank:
    """Return the water of a simulation without walls, drawn with a size of ten vessel lengths."""
    return Tank(10.0 * vessel.length, 10.0 * vessel.length, vessel.length, walls=False)


def build_model(
    vessel: Vessel,
    tank: Tank | None = None,
    step: float = 0.02,
    userdata: int = 0,
    *,
    show: bool = True,
    wall_solref: tuple[float, float] | None = None,
    friction: float = 0.0,
) -> mujoco.MjModel:
    """Compile the MuJoCo model of a vessel in a tank, with a joint per degree of freedom.

    The model has no forces and no gravity: buoyancy and restoring effects include it.

    Args:
        vessel: The vessel.
        tank: The tank; default: open water.
        step: Integration step [s].
        userdata: Size of MuJoCo's userdata.
        show: Whether to include parts that are only drawn; without them the model is faster.
        wall_solref: MuJoCo's contact parameters of the walls, (-stiffness, -damping) or (time
            constant [s], damping ratio); default: critically damped.
        friction: Friction coefficient of the walls.

    Returns:
        The model.

    Raises:
        BadInput: If MuJoCo cannot build the hull.
        BadPhysics: If MuJoCo does not store the full mass matrix.
    """
    tank = tank or open_water(vessel)
    spec = mujoco.MjSpec.from_file(str(content_root() / "models" / "tank.xml"))
    spec.option.timestep = step
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.gravity = (0, 0, 0)
    # the engine reports a diverging motion as an error
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    spec.nuserdata = userdata
    set_tank_geometry(spec, tank, vessel)
    with _without_warnings():
        hull = add_hull(spec, vessel)
        set_inertia(hull, vessel)
        add_joints(hull, vessel)
        if tank.walls:
            add_contacts(spec, wall_solref or SOFT_WALL, friction)
        if not show:
            remove_visual_parts(spec)
        model = _compile(spec, vessel)
    check_mass_matrix(model, vessel)
    return model


def _compile(spec: mujoco.MjSpec, vessel: Vessel) -> mujoco.MjModel:
    """Compile a specification; raises BadInput for sizes, masses and meshes of the hull."""
    try:
        return spec.compile()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:  # the tank is ours
        reason = " ".join(str(error).split())
        raise BadInput(
            f"{Path(vessel.path) / vessel.hull}: no hull that MuJoCo can build: {reason}"
        ) from None


@contextmanager
def _without_warnings() -> Iterator[None]:
    """Drop MuJoCo's warnings that options of a hull differ from those of the tank, which apply.

    MuJoCo would print them and write them to a file in the working folder.
    """
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(_ignore_warning)
    try:
        with catch_warnings():
            filterwarnings("ignore", message=r"(?s).*when attaching")
            yield
    finally:
        mujoco.set_mju_user_warning(before)


def _ignore_warning(_: str) -> None:
    """Drop a warning of MuJoCo."""


def set_tank_geometry(spec: mujoco.MjSpec, tank: Tank, vessel: Vessel) -> None:
    """Set size and position of water, walls, fan and cameras in a MuJoCo specification."""
    a, b, d = tank.length / 2, tank.width / 2, tank.depth
    middle, high = (RIM - d) / 2, (RIM + d) / 2  # walls stand on the floor and rise above the water
    boxes = {
        "side_ahead": ((a + WALL, 0, middle), (WALL, b + 2 * WALL, high)),
        "side_astern": ((-a - WALL, 0, middle), (WALL, b + 2 * WALL, high)),
        "side_port": ((0, b + WALL, middle), (a, WALL, high)),
        "side_starboard": ((0, -b - WALL, middle), (a, WALL, high)),
        "floor": ((0, 0, -d - 0.01), (a, b, 0.01)),
        "water": ((0, 0, -d / 2), (a, b, d / 2)),
        "wall_ahead": ((a, 0, 0), None),
        "wall_astern": ((-a, 0, 0), None),
        "wall_port": ((0, b, 0), None),
        "wall_starboard": ((0, -b, 0), None),
    }
    middle_of_tank = np.array([tank.centre[0], -tank.centre[1], 0])
    for name, (pos, size) in boxes.items():
        geom = spec.geom(name)
        geom.pos = middle_of_tank + pos
        if size:
            geom.size = size
        if not tank.walls and name.startswith(("wall", "side")):
            spec.delete(geom)
    x, y, _ = middle_of_tank
    spec.body("fan").pos = (x, y + b + 2 * WALL + 0.1, 0.2)
    # all of the water lies before the sun: what is behind it MuJoCo draws as if in shadow
    spec.light("sun").pos = middle_of_tank + spec.light("sun").pos * max(
        1.0, math.hypot(a, b) / DRAWN
    )
    aim_cameras(spec, tank, vessel)


def aim_cameras(spec: mujoco.MjSpec, tank: Tank, vessel: Vessel) -> None:
    """Aim the cameras of a MuJoCo model at the tank, at most six vessel lengths about the start."""
    most = 6 * vessel.length
    long, wide = min(tank.length, most), min(tank.width, most)
    x = tank.centre[0] if tank.length <= most else 0.0
    y = -tank.centre[1] if tank.width <= most else 0.0
    target = np.array([x, y, 0.0])
    above, oblique = spec.camera("above"), spec.camera("oblique")
    half = math.tan(math.radians(above.fovy) / 2)
    above.pos = target + (0, 0, 1.2 * max(long / 2, wide / 2 * 3 / 4) / half + vessel.draught)
    eye = target + np.array([-0.72, -0.40, 0.62]) * math.hypot(long, wide) * 1.12
    oblique.pos = eye
    oblique.alt.xyaxes = camera_axes(eye, target)


def camera_axes(eye: Array, target: Array) -> Array:
    """Return the axes (6,), MuJoCo's `xyaxes`, of a camera at `eye` that looks at `target`.

    The horizon is level.
    """
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0, 0, 1))
    right = right / np.linalg.norm(right)
    return np.concatenate([right, np.cross(right, forward)])


def add_hull(spec: mujoco.MjSpec, vessel: Vessel) -> mujoco.MjsBody:
    """Add the hull of a vessel to a MuJoCo specification; return its body.

    The drawing is scaled to the vessel's length and draught, with the origin at the CG.
    """
    drawing, (length, draught) = read_drawing(Path(vessel.path) / vessel.hull, vessel)
    stretch = vessel.length / length
    for mesh in drawing.meshes:
        if not mesh.name.startswith("outboard"):
            mesh.scale = (stretch, 1, 1)
    shift = np.array([-vessel.geometry.get("cg_from_transom", 0.0), 0, draught - vessel.draught])
    hull = drawing.body("hull")
    for part in (*hull.geoms, *hull.sites, *hull.bodies):
        part.pos = part.pos * (stretch, 1, 1) + shift
    place_fittings(drawing, vessel.geometry, vessel.marks, shift)
    spec.attach(drawing, prefix="boat/", frame=spec.worldbody.add_frame())
    for part in (*spec.bodies, *spec.geoms, *spec.sites):
        part.name = part.name.removeprefix("boat/")
    return spec.body("hull")


def read_drawing(path: Path, vessel: Vessel) -> tuple[mujoco.MjSpec, tuple[float, float]]:
    """Read the drawing of a vessel's hull, a MuJoCo XML file.

    Args:
        path: The file.
        vessel: The vessel.

    Returns:
        The specification of the drawing, and the length and draught [m] it was drawn for, by
        default the vessel's.

    Raises:
        BadInput: If it does not exist, MuJoCo cannot read it or it has no hull.
    """
    if vessel.hull_xml:
        check_hull_text(vessel.hull_xml, path)
    else:
        if not os.path.isfile(path):  # False for a name that no file can have, too
            raise BadInput(
                f"{vessel.file}: hull = {vessel.hull!r}: there is no file {path}; allowed is the "
                "name of a MuJoCo XML file in that folder, such as 'hull.xml'"
            )
        check_hull_file(path)
    try:
        if vessel.hull_xml:
            drawing = mujoco.MjSpec.from_string(vessel.hull_xml)
        else:
            drawing = mujoco.MjSpec.from_file(str(path))
        bodies = [body.name for body in drawing.bodies]
        for part in (*drawing.geoms, *drawing.sites, *drawing.meshes):
            _ = part.name  # raises an error unless it is UTF-8
        check_assets(drawing, path)
    except (ValueError, TypeError) as error:  # a TypeError for a path that is not UTF-8
        reason = " ".join(str(error).split())
        if isinstance(error, TypeError):
            reason = "its path is not UTF-8"
        raise BadInput(f"{path}: no hull that MuJoCo can read: {reason}") from None
    if drawing.body("hull") is None:
        raise BadInput(
            unknown_name_message(
                f"{path}: body", "hull", (name for name in bodies if name != "world")
            )
        )
    drawn_for = drawing.numeric("drawn_for")
    if drawn_for is None:
        return drawing, (vessel.length, vessel.draught)
    data = list(drawn_for.data)
    if len(data) != 3 or not all(0.0 < x < math.inf for x in data):
        raise BadInput(f"{path}: drawn_for = {data}; allowed are length, beam and draught in m")
    length, _, draught = data
    drawing.delete(drawn_for)
    return drawing, (length, draught)


def place_fittings(
    drawing: mujoco.MjSpec,
    at: dict[str, float],
    marks: Mapping[str, tuple[float, float]],
    shift: Array,
) -> None:
    """Move outboards, mount, ballast and marks of a hull drawing to the places of a load."""
    for side, name in ((1, "outboard_port"), (-1, "outboard_starboard")):
        body = drawing.body(name)
        if body is not None and "motor_half_spacing" in at:
            body.pos = (
                _required_value(at, "motor_ahead_of_cg"),
                side * at["motor_half_spacing"],
                body.pos[2],
            )
    for name, (ahead, starboard) in marks.items():
        if (geom := drawing.geom(name)) is not None:
            geom.pos = (ahead, -starboard, geom.pos[2])
    if (mount := drawing.geom("mount")) is not None:
        mount.pos = (at.get("motor_ahead_of_cg", mount.pos[0]), 0, mount.pos[2])
        mount.size = (mount.size[0], at.get("motor_half_spacing", mount.size[1]), mount.size[2])
    if (ballast := drawing.geom("ballast")) is not None:
        if at.get("ballast_mass", 0.0) > 0:
            ballast.pos = (
                _required_value(at, "ballast_from_transom") + shift[0],
                0,
                ballast.pos[2],
            )
        else:
            drawing.delete(ballast)


def _required_value(geometry: Mapping[str, float], key: str) -> float:
    if key not in geometry:
        raise BadInput(f"geometry.{key} is missing; the hull that is drawn needs it")
    return geometry[key]


def set_inertia(hull: mujoco.MjsBody, vessel: Vessel) -> None:
    """Set mass, centre of mass and inertia of a vessel's body in a MuJoCo specification.

    The inertial frame is turned by 180 deg about x, which changes no number: MuJoCo stores only the
    diagonal of the mass matrix of a body whose inertial frame is its own, and added mass needs the
    whole lower triangle.
    """
    body = vessel.body
    hull.explicitinertial = True
    hull.mass = body.mass
    ahead, below = body.centre
    hull.ipos = (ahead, 0, origin_height(vessel) - below)
    hull.iquat = HALF_TURN
    hull.inertia = (body.roll_inertia, body.effective_pitch_inertia(), body.yaw_inertia)


def origin_height(vessel: Vessel) -> float:
    """Return the height of the vessel's origin of motion above the water [m], 0 by default."""
    above_keel = vessel.geometry.get("cg_above_keel")
    return 0.0 if above_keel is None else above_keel - vessel.draught


def add_joints(hull: mujoco.MjsBody, vessel: Vessel) -> None:
    """Add a MuJoCo joint to the hull for each degree of freedom of the vessel.

    Roll and pitch axes pass through the origin of motion.
    """
    for axis_name, (name, kind, axis) in JOINTS.items():
        if axis_name in vessel.dof:
            height = origin_height(vessel) if axis_name in ("roll", "pitch") else 0
            pos = (0, 0, height)
            hull.add_joint(name=name, type=kind, axis=axis, pos=pos)


def add_contacts(spec: mujoco.MjSpec, solref: tuple[float, float], friction: float) -> None:
    """Add contacts of the hull with the four walls of the tank to a MuJoCo specification.

    Explicit pairs are faster than bit masks.
    """
    touching = [g.name for g in spec.body("hull").geoms if g.name.startswith("collision")]
    for geom in touching:
        for wall in ("wall_ahead", "wall_astern", "wall_port", "wall_starboard"):
            pair = spec.add_pair(geomname1=geom, geomname2=wall)
            pair.solref = solref
            pair.condim = 3 if friction > 0 else 1
            pair.friction = (friction, friction, 0, 0, 0)


def remove_visual_parts(spec: mujoco.MjSpec) -> None:
    """Delete all parts of a MuJoCo specification that have no contacts and are only drawn.

    These are drawn geoms, marks, outboards, fan, cameras and lights.
    """
    in_contact = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    for geom in [g for g in spec.geoms if g.name not in in_contact]:
        spec.delete(geom)
    for body in [b for b in spec.bodies if b.name not in ("world", "hull")]:
        spec.delete(body)
    for part in (*spec.sites, *spec.cameras, *spec.lights):
        spec.delete(part)


def check_mass_matrix(model: mujoco.MjModel, vessel: Vessel) -> None:
    """Check that MuJoCo stores the mass matrix's lower triangle, which added mass needs."""
    stored, needed = model.M_rownnz.tolist(), list(range(1, model.nv + 1))
    if stored != needed:
        raise BadPhysics(
            f"{vessel.name}: mass matrix stores {stored} entries a row; needed {needed}"
        )
