"""Runs as rerun logs: streamed to a viewer and a `.rrd` while they run, overlaid for a diagnosis, and read back.

Every column of a recording is logged as float64 scalars under `signals/`, so a log holds what `recording.csv` holds;
the 3D scene is drawn from the same columns. rerun is imported here and in `blueprint.py` only (0.5 s).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import NamedTuple, Self, TypedDict

import numpy as np
import rerun as rr

from boatsim.physics.signals import POSE, Array
from boatsim.recordings.readers.rrd import SIGNALS, TIMELINE
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED, MetricEntry
from boatsim.simulate.tracking_errors import GOAL
from boatsim.view import blueprint
from boatsim.view.blueprint import WORLD
from boatsim.view.scene import OUTBOARD, Scene, Solid
from boatsim.view.stream import Stream

# rows kept back before they are written, unless somebody watches: small chunks make large files
BUFFER = 1000
# [s] after which they are written all the same: a process that is killed loses no more than a
# second
OFTEN = 0.5
TRAIL_STEP = 0.1  # [s] between points of the path drawn
ABOVE = 0.02  # [m] arrows and paths lie this far above the water
COLOURS = {
    "thrust": (235, 120, 20),
    "wind": (60, 150, 220),
    "force": (200, 40, 60),
    "path": (30, 60, 120),
    "camera": (240, 190, 30),
    "wall": (150, 155, 160),
    "water": (150, 190, 215),
    "flagged": (230, 0, 40),
}
# as in the report; told apart by colour-blind readers too, on dark plots and on the light scene
BOATS = {
    "recording": (165, 173, 180),
    "nominal": (230, 105, 25),
    "recalibrated": (45, 140, 225),
    "patched": (0, 165, 120),
}
VERDICTS = {REPRODUCED: "(the same)", MISSED: "(differs)", NO_TOLERANCE: ""}
# [s] between the end of one stretch, a gap, and the begin of the next at the same time
PARTING = 1e-9


class Flagged(TypedDict):
    """An interval of diagnosis.json in which the missing force of an axis is flagged."""

    axis: str
    from_s: float
    to_s: float


class RerunLog:
    """A run's log: `add_rows` takes new rows while it runs, `finish` the norms; leaving the `with` block keeps all of it.

    `path` is the `.rrd` to write, `viewer` the address of one that is fed (None: none).
    """

    def __init__(self, path: Path | str | None, scene: Scene, viewer: str | None = None) -> None:
        """Raises OSError, as whatever writes does."""
        self.scene, self.live = scene, viewer is not None
        self._waiting: list[Recording] = []
        self._written = monotonic()  # when something last was
        # time and place of the last point of the path
        self._trail: tuple[float, Array] | None = None
        self._known: set[str] = set()
        self.stream = Stream("boatsim", path, viewer)
        if self.stream.heard:
            _begin(self.stream)
            _draw_tank(self.stream, scene)
            _draw_hull(self.stream, scene, "boat")
            self._say("Norms follow when the run is over.")
            self.stream.keep()

    def add_rows(self, rows: Recording) -> None:
        """Log new rows, which follow those logged before."""
        if len(rows) and self.stream.heard:
            self._waiting.append(rows)
        if (
            self.live
            or sum(map(len, self._waiting)) >= BUFFER
            or monotonic() - self._written >= OFTEN
        ):
            self._write()

    def finish(self, norms: Mapping[str, MetricEntry]) -> None:
        """Add the table of norms: name -> value, unit, published, verdict, guard [low, high], ok."""
        self._write()
        if self.stream.heard:
            self._say(norms_table(norms))

    def close(self) -> None:
        """Write what is waiting and end the file."""
        try:
            self._write()
        finally:
            self.stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self.close()

    def _say(self, text: str) -> None:
        self.stream.log("norms", rr.TextDocument(text, media_type="text/markdown"), static=True)

    def _write(self) -> None:
        if not self._waiting:
            return
        rows = _joined(self._waiting)
        self._waiting, self._written = [], monotonic()
        if new := rows.signals.keys() - self._known:
            self._known |= new
            for number, name in enumerate(n for n in rows.signals if n in new):
                self.stream.log(f"{SIGNALS}/{name}", blueprint.style(name, number), static=True)
            self.stream.send_blueprint(blueprint.of_run(self.scene, sorted(self._known)))
        _log_signals(self.stream, rows, SIGNALS)
        _move(self.stream, rows, self.scene, "boat")
        _log_arrows(self.stream, rows, self.scene)
        self._trail = _log_path(self.stream, rows, "path", COLOURS["path"], self._trail)
        _log_camera(self.stream, rows)
        self.stream.keep()


def log_overlay(
    path: Path | str,
    boats: Mapping[str, Sequence[Recording]],
    missing: Recording | None,
    intervals: Sequence[Flagged],
    scene: Scene,
) -> None:
    """diagnosis.rrd: all boats in one scene on one time line, the missing force per axis with its band.

    `boats` are "recording", "nominal", "recalibrated", "patched", the first of them drawn as a hull and the others as
    its outline, so that boats a few centimetres apart can be told; each comes in stretches, and nothing is drawn from
    the end of one to the begin of the next. `missing` has `force_X_N` (and `_Y_N`, `_K_Nm`, `_N_Nm`) with `..._low`
    and `..._high`; `intervals` are `where.intervals` of diagnosis.json (from_s, to_s, axis).
    """
    stream = Stream("boatsim_diagnosis", path)
    _begin(stream)
    _draw_tank(stream, scene)
    for number, (boat, stretches) in enumerate(boats.items()):
        colour = BOATS.get(boat, blueprint.PALETTE[number % len(blueprint.PALETTE)])
        if number == 0:
            _draw_hull(stream, scene, f"boats/{boat}", colour)
        _draw_outline(stream, scene, boat, number, colour)
        apart = _apart(stretches)
        for stretch in apart:
            _move(stream, stretch, scene, f"boats/{boat}")
            _log_path(stream, stretch, f"paths/{boat}", colour, None, _above(scene, number))
        for name in stretches[0].signals:
            look = (
                blueprint.dots(boat, colour)
                if number == 0
                else blueprint.style(name, number, boat, colour)
            )
            stream.log(f"{SIGNALS}/{boat}/{name}", look, static=True)
        _log_signals(stream, _with_gaps(apart), f"{SIGNALS}/{boat}")
    if missing is not None:
        marked = replace(missing, signals={**missing.signals, **_flagged(missing, intervals)})
        for name in marked.signals:
            stream.log(
                f"missing/{name}", blueprint.band_style(name, COLOURS["flagged"]), static=True
            )
        _log_signals(stream, marked, "missing")
    names = [name for run in reversed(list(boats.values())) for name in run[0].signals]
    times = [r.t for run in boats.values() for r in run] + (
        [missing.t] if missing is not None else []
    )
    span = (
        min((float(t[0]) for t in times), default=0.0),
        max((float(t[-1]) for t in times), default=1.0),
    )
    forces = missing.signals if missing is not None else {}
    stream.send_blueprint(blueprint.of_overlay(scene, list(boats), names, forces, span))
    stream.close()


class Boat(NamedTuple):
    """One of several runs in a log of all of them."""

    recording: Recording
    scene: Scene
    # what its goals are called; "": they are not drawn, as those of a boat with the same ones are
    goals: str


def log_side_by_side(path: Path | str, boats: Mapping[str, Boat], norms: str) -> None:
    """compare.rrd: whole runs of several boats in one scene, each in its own colour, and their signals plot by plot.

    `boats` are by the names that stand beside the hulls and in the legends, letters, digits and _ only; `norms` is
    their table in Markdown. The first is drawn as a hull in its tank, the others as outlines: so boats that are close
    to each other can be told.
    """
    stream = Stream("boatsim_compare", path)
    _begin(stream)
    scene = next(iter(boats.values())).scene
    _draw_tank(stream, scene)
    for number, (name, boat) in enumerate(boats.items()):
        colour = blueprint.PALETTE[number % len(blueprint.PALETTE)]
        if number == 0:
            _draw_hull(stream, scene, f"boats/{name}", colour)
        _draw_outline(stream, boat.scene, name, number, colour)
        _move(stream, boat.recording, boat.scene, f"boats/{name}")
        _log_path(stream, boat.recording, f"paths/{name}", colour, None, _above(boat.scene, number))
        shown = {
            n: x for n, x in boat.recording.signals.items() if boat.goals or not n.startswith(GOAL)
        }
        for signal in shown:
            is_goal = signal.startswith(GOAL)
            legend, hue = (boat.goals, blueprint.paler(colour)) if is_goal else (name, colour)
            stream.log(
                f"{SIGNALS}/{name}/{signal}",
                blueprint.style(signal, number, legend, hue),
                static=True,
            )
        _log_signals(stream, replace(boat.recording, signals=shown), f"{SIGNALS}/{name}")
    stream.log("norms", rr.TextDocument(norms, media_type="text/markdown"), static=True)
    signals = {name: list(boat.recording.signals) for name, boat in boats.items()}
    stream.send_blueprint(blueprint.of_several(scene, signals))
    stream.close()


def _begin(stream: Stream) -> None:
    stream.log(WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)


def norms_table(norms: Mapping[str, MetricEntry]) -> str:
    """Markdown table norm, what it is, value, guard, met, published with the verdict on it; what counts first."""
    if not norms:
        return "This scenario has no norms.\n"
    lines = ["| norm | is | value | guard | met | published |", "|:---|:---|---:|---:|:---:|:---|"]
    for name, norm in norms.items():
        ok, ends = norm.get("ok"), [_short(end) for end in norm.get("guard") or (None, None)]
        met = "" if ok is None else "yes" if ok else "**no**"
        span = (
            " to ".join(ends)
            if all(ends)
            else f"at least {ends[0]}"
            if ends[0]
            else f"at most {ends[1]}"
        )
        value = (
            norm.get("lacking") or f"{_short(norm.get('value'))} {norm.get('unit') or ''}".strip()
        )
        said = (
            f"{_short(norm.get('published'))} {VERDICTS.get(norm.get('verdict') or '', '')}".strip()
        )
        guard = span if any(ends) else ""
        lines.append(f"| {name} | {norm.get('kind', '')} | {value} | {guard} | {met} | {said} |")
    return "\n".join(lines) + "\n"


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _joined(parts: Sequence[Recording]) -> Recording:
    names = list(dict.fromkeys(name for part in parts for name in part.signals))
    signals = {
        n: np.concatenate([p.signals.get(n, np.full(len(p), math.nan)) for p in parts])
        for n in names
    }
    return Recording(parts[0].name, np.concatenate([p.t for p in parts]), signals, Notes())


def _apart(stretches: Sequence[Recording]) -> list[Recording]:
    """Stretches whose ends come just before the begin of the next one, which may have the same time."""
    ends = [next_one.t[0] - 2 * PARTING for next_one in stretches[1:]]
    times = [
        np.append(s.t[:-1], min(s.t[-1], end)) for s, end in zip(stretches, ends, strict=False)
    ]
    return [replace(s, t=t) for s, t in zip(stretches, [*times, stretches[-1].t], strict=True)]


def _with_gaps(stretches: Sequence[Recording]) -> Recording:
    """Stretches as one recording, with a row of nan before each begin but the first: curves break there."""
    parts = [stretches[0]]
    for stretch in stretches[1:]:
        parts += [
            Recording(
                "", stretch.t[:1] - PARTING, {n: np.full(1, np.nan) for n in stretch.signals}
            ),
            stretch,
        ]
    return _joined(parts)


def _when(t: Array) -> list[rr.TimeColumn]:
    return [rr.TimeColumn(TIMELINE, duration=np.round(t * 1e9).astype("timedelta64[ns]"))]


def _log_signals(stream: Stream, rows: Recording, under: str) -> None:
    when = _when(rows.t)
    for name, values in rows.signals.items():
        stream.send_columns(f"{under}/{name}", when, rr.Scalars.columns(scalars=values))


def _flat(x: Array, y: Array, z: float = 0.0) -> Array:
    """SNAME x, y as points (N, 3) of the picture, whose z points up and y to port."""
    return np.column_stack([x, -y, np.full(len(x), z)])


def _draw_tank(stream: Stream, scene: Scene) -> None:
    length, width, x, y = scene.tank
    for solid in scene.solids:
        if solid.part == "tank":
            stream.log(f"{WORLD}/tank/{solid.name}", _mesh(_surface(solid)), static=True)
    if any(solid.part == "tank" for solid in scene.solids):
        return
    corners = [
        (x + i * length / 2, -y + j * width / 2, ABOVE)
        for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1))
    ]
    edge = rr.LineStrips3D([corners], colors=[COLOURS["wall"]], radii=[0.004 * max(length, width)])
    stream.log(f"{WORLD}/tank/walls", edge, static=True)
    water = rr.Mesh3D(
        vertex_positions=[(a, b, -0.01) for a, b, _ in corners[:4]],
        vertex_normals=[(0, 0, 1)] * 4,
        triangle_indices=[(0, 2, 1), (0, 3, 2)],
        albedo_factor=COLOURS["water"],
    )
    stream.log(f"{WORLD}/tank/water", water, static=True)


def _draw_hull(
    stream: Stream, scene: Scene, boat: str, tint: tuple[int, int, int] | None = None
) -> None:
    """The hull's shapes under the entity of a boat; outboards hang from entities of their own so that they can turn."""
    for solid in scene.solids:
        if solid.part != "tank":
            part = "hull" if solid.part == "hull" else solid.part
            stream.log(f"{WORLD}/{boat}/{part}/{solid.name}", _mesh(solid, tint), static=True)
    for thruster in scene.thrusters:
        at = rr.Transform3D(translation=(thruster.x, -thruster.y, 0.0))
        stream.log(f"{WORLD}/{boat}/{OUTBOARD}{thruster.name}", at, static=True)


def _above(scene: Scene, number: int) -> float:
    """Height [m] above everything on the hull, a little more for each boat: lines of different boats do not flicker."""
    top = max(
        (float(s.vertices[:, 2].max()) for s in scene.solids if s.part != "tank"), default=0.0
    )
    return top + (5 + number) * 0.002 * scene.length


def _draw_outline(
    stream: Stream, scene: Scene, boat: str, number: int, colour: tuple[int, int, int]
) -> None:
    """Outline of the hull from above with a line from its middle to the bow, and its name on one of its sides."""
    ring = scene.outline()
    height, bow, stern = _above(scene, number), float(ring[:, 0].max()), float(ring[:, 0].min())
    side = float(np.abs(ring[:, 1]).max())
    edge, middle = (
        np.column_stack([ring, np.full(len(ring), height)]),
        np.array([(0, 0, height), (bow, 0, height)]),
    )
    entity = f"{WORLD}/boats/{boat}/outline"
    stream.log(entity, rr.LineStrips3D([edge, middle], colors=[colour], radii=[-1.5]), static=True)
    place = [(stern, 0.0), (bow, side), (bow, -side), (stern, side)][number % 4]
    name = rr.Points3D([(*place, height)], colors=[colour], radii=[-2.0], labels=[boat])
    stream.log(f"{entity}/name", name, static=True)


def _surface(solid: Solid) -> Solid:
    """Of something one can see through, such as water, only what faces up: its floor would flicker with the tank's."""
    if solid.colour[3] >= 1.0:
        return solid
    corners = solid.vertices[solid.triangles]
    upward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 1e-12
    return solid._replace(triangles=solid.triangles[upward])


def _mesh(solid: Solid, tint: tuple[int, int, int] | None = None) -> rr.Mesh3D:
    """Flat-shaded triangles: rerun lights only meshes with normals."""
    corners = solid.vertices[solid.triangles]  # (T, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    colour = [round(255 * c) for c in solid.colour] if tint is None else [*tint, 255]
    return rr.Mesh3D(
        vertex_positions=corners.reshape(-1, 3),
        vertex_normals=np.repeat(normals, 3, axis=0),
        albedo_factor=colour,
    )


def _move(stream: Stream, rows: Recording, scene: Scene, boat: str) -> None:
    """Pose of the hull and angles of the outboards; a boat that only rolls stays at the origin."""
    zero = np.zeros(len(rows))
    pose = np.stack([rows.signals.get(name, zero) for name in POSE])
    known = np.isfinite(pose).all(axis=0)  # where nothing was measured, the boat stays where it was
    x, y, z, phi, theta, psi = pose[:, known]
    points = _flat(x, y)
    points[:, 2] -= z  # z is down
    place = rr.Transform3D.columns(translation=points, quaternion=_attitude(psi, phi, theta))
    stream.send_columns(f"{WORLD}/{boat}", _when(rows.t[known]), place)
    for thruster in scene.thrusters:
        if (steer := rows.signals.get(thruster.steer)) is not None:
            # the force points a to starboard when the leg is turned by a, clockwise seen from above
            turned = rr.Transform3D.columns(quaternion=_attitude(steer, zero))
            stream.send_columns(f"{WORLD}/{boat}/{OUTBOARD}{thruster.name}", _when(rows.t), turned)


def _attitude(psi: Array, phi: Array, theta: Array | float = 0.0) -> Array:
    """(N, 4) quaternions x, y, z, w of heading (clockwise), pitch (bow up) and roll, for the picture's z-up axes."""
    cz, sz, cx, sx = np.cos(psi / 2), -np.sin(psi / 2), np.cos(phi / 2), np.sin(phi / 2)
    cy, sy = np.cos(theta / 2), -np.sin(theta / 2)
    return np.column_stack(
        [
            cz * cy * sx - sz * sy * cx,
            cz * sy * cx + sz * cy * sx,
            sz * cy * cx - cz * sy * sx,
            cz * cy * cx + sz * sy * sx,
        ]
    )


def _log_arrows(stream: Stream, rows: Recording, scene: Scene) -> None:
    zero = np.zeros(len(rows))
    for thruster in scene.thrusters:
        if (thrust := rows.signals.get(thruster.thrust)) is not None:
            steer = rows.signals.get(thruster.steer, zero)
            vector = _flat(thrust * np.cos(steer), thrust * np.sin(steer))
            at = _flat(zero + thruster.x, zero + thruster.y, ABOVE)
            _arrow(stream, rows.t, f"thrust_{thruster.name}", scene, vector, at, COLOURS["thrust"])
    for what in ("force", "wind"):
        if f"{what}_X_N" in rows.signals and f"{what}_Y_N" in rows.signals:
            vector = _flat(rows[f"{what}_X_N"], rows[f"{what}_Y_N"])
            height = scene.length * (
                0.2 if what == "force" else 0.35
            )  # one above the other, so that both can be read
            _arrow(stream, rows.t, what, scene, vector, _flat(zero, zero, height), COLOURS[what])


def _arrow(
    stream: Stream,
    t: Array,
    name: str,
    scene: Scene,
    newtons: Array,
    at: Array,
    colour: tuple[int, int, int],
) -> None:
    """Arrows (N, 3) N in axes of the hull, one a row."""
    entity = f"{WORLD}/boat/{name}"
    words = {"force": "total force"}.get(name, name.replace("_", " "))
    look = rr.Arrows3D.from_fields(
        colors=[colour],
        radii=[0.012 * scene.length],
        labels=[words],
        show_labels=not name.startswith("thrust"),
    )
    stream.log(entity, look, static=True)
    stream.send_columns(
        entity, _when(t), rr.Arrows3D.columns(vectors=scene.reach * newtons, origins=at)
    )


def _log_path(
    stream: Stream,
    rows: Recording,
    name: str,
    colour: tuple[int, int, int],
    last: tuple[float, Array] | None,
    height: float = ABOVE,
) -> tuple[float, Array] | None:
    """One short line for each step; the view shows all up to its time. Returns the last point's time and place."""
    if not {"x_m", "y_m"} <= rows.signals.keys():
        return last
    known = np.flatnonzero(np.isfinite(rows["x_m"]) & np.isfinite(rows["y_m"]))
    if not len(known):
        return last
    due = known[np.unique(np.floor(rows.t[known] / TRAIL_STEP + 1e-6), return_index=True)[1]]
    t, points = rows.t[due], _flat(rows["x_m"][due], rows["y_m"][due], height)
    if last is not None:
        t, points = np.append(last[0], t), np.vstack([last[1], points])
    entity = f"{WORLD}/{name}"
    if len(t) > 1:
        pairs = np.stack([points[:-1], points[1:]], axis=1)
        stream.log(entity, rr.LineStrips3D.from_fields(colors=[colour], radii=[-2.0]), static=True)
        stream.send_columns(entity, _when(t[1:]), rr.LineStrips3D.columns(strips=list(pairs)))
    return float(t[-1]), points[-1]


def _log_camera(stream: Stream, rows: Recording) -> None:
    """What the camera measured, at the rows in which it measured something new."""
    if not {"camera_x_m", "camera_y_m"} <= rows.signals.keys():
        return
    x, y = rows["camera_x_m"], rows["camera_y_m"]
    fresh = (
        np.isfinite(x)
        & np.isfinite(y)
        & (np.append(True, np.diff(x) != 0) | np.append(True, np.diff(y) != 0))
    )
    if fresh.any():
        entity = f"{WORLD}/camera"
        stream.log(
            entity, rr.Points3D.from_fields(colors=[COLOURS["camera"]], radii=[-1.2]), static=True
        )
        points = rr.Points3D.columns(positions=_flat(x[fresh], y[fresh], 1.5 * ABOVE))
        stream.send_columns(entity, _when(rows.t[fresh]), points)


def _flagged(missing: Recording, intervals: Sequence[Flagged]) -> dict[str, Array]:
    """The missing force where it was flagged, nan elsewhere, as signals of their own."""
    found: dict[str, Array] = {}
    for name, axis in blueprint.MISSING.items():
        inside = np.zeros(len(missing), dtype=bool)
        for flagged in intervals:
            if flagged["axis"] == axis:
                inside |= (missing.t >= flagged["from_s"]) & (missing.t <= flagged["to_s"])
        if name in missing.signals and inside.any():
            found[f"{name}_flagged"] = np.where(inside, missing[name], math.nan)
    return found
