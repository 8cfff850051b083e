"""Runs as rerun logs: streamed while they run, overlaid for a diagnosis, or side by side.

Every column of a recording is logged as float64 scalars under `signals/`, so that a log holds the
data of `recording.csv`; the 3D scene is drawn from the same columns. Importing this module takes
0.5 s, because it imports rerun.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain, pairwise
from pathlib import Path
from time import monotonic
from types import TracebackType
from typing import NamedTuple, Self, TypedDict

import numpy as np
import rerun as rr

from boatsim.physics.signals import POSE, Array
from boatsim.physics.waves.field import WaveField
from boatsim.recordings.readers.rrd import SIGNALS, TIMELINE
from boatsim.recordings.table import Notes, Recording
from boatsim.simulate.evaluation import MISSED, NO_TOLERANCE, REPRODUCED, MetricEntry, RunEntry
from boatsim.simulate.tracking_errors import GOAL
from boatsim.view import blueprint
from boatsim.view.blueprint import WORLD
from boatsim.view.scene import OUTBOARD, Scene, Solid
from boatsim.view.stream import Stream
from boatsim.view.wave_surface import WaveSurface

# [rows] that are collected before they are written, because small chunks make large files
BUFFER = 1000
# [s] after which rows are written in any case: a process that is killed loses less than a second
OFTEN = 0.5
TRAIL_STEP = 0.1  # [s] between points of the path drawn
# height of the arrows by the length of the vessel, different so that both are visible
HEIGHTS = {"force": 0.2, "wind": 0.35}
ABOVE = 0.02  # [m] height of arrows and paths above the water
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
# as in the report; distinguishable for colour-blind readers on dark plots and in the light scene
BOATS = {
    "recording": (165, 173, 180),
    "before": (230, 105, 25),
    "retuned": (45, 140, 225),
    "corrected": (0, 165, 120),
}
MET = {None: "", True: "yes", False: "**no**"}
VERDICTS = {REPRODUCED: "(the same)", MISSED: "(differs)", NO_TOLERANCE: ""}
# [s] by which the end of a segment is moved before the next one that begins at the same time
PARTING = 1e-9


class Flagged(TypedDict):
    """Interval of a diagnosis.json in which the missing force of an axis is significant."""

    axis: str
    from_s: float
    to_s: float


class RerunLog:
    """3D log of a run in progress, written to a rerun file, a viewer or both.

    Leaving its `with` block writes the rest.
    """

    def __init__(
        self,
        path: Path | str | None,
        scene: Scene,
        viewer: str | None = None,
        waves: WaveField | None = None,
    ) -> None:
        """Open the log.

        Args:
            path: The `.rrd` file; None: none.
            scene: What is drawn.
            viewer: Address of a viewer that is fed; None: none.
            waves: Waves that move the surface of the water; None: it is still.

        Raises:
            OSError: If the file cannot be written; all methods may raise it.
        """
        self.scene, self.live = scene, viewer is not None
        self._waiting: list[Recording] = []
        self._written = monotonic()  # time of the last write
        # time and place of the last point of the path
        self._trail: tuple[float, Array] | None = None
        self._known: set[str] = set()
        self._surface: WaveSurface | None = None
        self._surface_time = -math.inf  # [s] of the last frame of the surface
        if waves is not None and len(waves):
            self._surface = WaveSurface.for_scene(waves, scene)
        self.stream = Stream("boatsim", path, viewer)
        if self.stream.has_receiver:
            _send_axes(self.stream)
            _draw_tank(self.stream, scene, still=self._surface is None)
            if self._surface is not None:
                _draw_surface(self.stream)
            _draw_hull(self.stream, scene, "boat")
            self._write_text("Metrics follow when the run is over.")
            self.stream.flush()

    def add_rows(self, rows: Recording) -> None:
        """Add the next rows of a run's log to the 3D log.

        Args:
            rows: Rows that follow those added before.
        """
        if len(rows) and self.stream.has_receiver:
            self._waiting.append(rows)
        if (
            self.live
            or sum(map(len, self._waiting)) >= BUFFER
            or monotonic() - self._written >= OFTEN
        ):
            self._write()

    def finish(self, result: RunEntry) -> None:
        """Add the table of the run's metrics to the 3D log.

        Args:
            result: Content of norms.json.
        """
        self._write()
        if self.stream.has_receiver:
            self._write_text(metrics_table(result["norms"]))

    def close(self) -> None:
        """Write the remaining rows of the 3D log and close its file."""
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

    def _write_text(self, text: str) -> None:
        self.stream.log("norms", rr.TextDocument(text, media_type="text/markdown"), static=True)

    def _write(self) -> None:
        if not self._waiting:
            return
        rows = _join_recordings(self._waiting)
        self._waiting, self._written = [], monotonic()
        new = [name for name in rows.signals if name not in self._known]
        if new:
            self._known.update(new)
            for number, name in enumerate(new):
                self.stream.log(
                    f"{SIGNALS}/{name}", blueprint.curve_style(name, number), static=True
                )
            self.stream.send_blueprint(blueprint.run_layout(self.scene, sorted(self._known)))
        _log_signals(self.stream, rows, SIGNALS)
        _log_motion(self.stream, rows, self.scene, "boat")
        _log_arrows(self.stream, rows, self.scene)
        self._trail = _log_path(self.stream, rows, "path", COLOURS["path"], self._trail)
        _log_camera(self.stream, rows)
        if self._surface is not None:
            self._surface_time = _log_surface(self.stream, rows, self._surface, self._surface_time)
        self.stream.flush()


def write_diagnosis_log(
    path: Path | str,
    boats: Mapping[str, Sequence[Recording]],
    missing: Recording | None,
    intervals: Sequence[Flagged],
    scene: Scene,
) -> None:
    """Write the 3D log of a diagnosis, diagnosis.rrd: recording, models and missing force.

    Recording and models are drawn in one scene; the missing force is plotted per axis.

    Args:
        path: The file.
        boats: Segments of the motion by name: "recording", "before", "retuned", "corrected".
            The first is drawn as a hull, the others as outlines, so that small distances are
            visible. Segments are not connected.
        missing: The missing force with its band: `force_X_N` (and `_Y_N`, `_K_Nm`, `_N_Nm`) with
            `..._low` and `..._high`; None: none.
        intervals: `where.intervals` of diagnosis.json.
        scene: What is drawn.

    Raises:
        OSError: If the file cannot be written.
    """
    stream = Stream("boatsim_diagnosis", path)
    _send_axes(stream)
    _draw_tank(stream, scene)
    for number, (boat, segments) in enumerate(boats.items()):
        colour = BOATS.get(boat, blueprint.PALETTE[number % len(blueprint.PALETTE)])
        if number == 0:
            _draw_hull(stream, scene, f"boats/{boat}", colour)
        _draw_outline(stream, scene, boat, number, colour)
        apart = _separate_segment_ends(segments)
        for segment in apart:
            _log_motion(stream, segment, scene, f"boats/{boat}")
            _log_path(stream, segment, f"paths/{boat}", colour, None, _line_height(scene, number))
        for name in segments[0].signals:
            style: rr.SeriesLines | rr.SeriesPoints = blueprint.sample_style(boat, colour)
            if number > 0:
                style = blueprint.curve_style(name, number, boat, colour)
            stream.log(f"{SIGNALS}/{boat}/{name}", style, static=True)
        _log_signals(stream, _join_with_gaps(apart), f"{SIGNALS}/{boat}")
    if missing is not None:
        marked = replace(missing, signals={**missing.signals, **_flagged_force(missing, intervals)})
        for name in marked.signals:
            stream.log(
                f"missing/{name}",
                blueprint.missing_force_style(name, COLOURS["flagged"]),
                static=True,
            )
        _log_signals(stream, marked, "missing")
    firsts = [segments[0].signals for segments in reversed(list(boats.values()))]
    names = list(chain.from_iterable(firsts))
    recordings = list(chain.from_iterable(boats.values()))
    forces: Mapping[str, Array] = {}
    if missing is not None:
        recordings.append(missing)
        forces = missing.signals
    span = (0.0, 1.0)
    if recordings:
        begins, ends = zip(*(r.t[[0, -1]].tolist() for r in recordings), strict=True)
        span = (min(begins), max(ends))
    stream.send_blueprint(blueprint.diagnosis_layout(scene, list(boats), names, forces, span))
    stream.close()


class Boat(NamedTuple):
    """One of several runs that are drawn together in a 3D log.

    Attributes:
        recording: The run.
        scene: What is drawn.
        goals: Legend of its goals; "": they are not drawn, because another run has the same.
    """

    recording: Recording
    scene: Scene
    goals: str


def write_comparison_log(path: Path | str, boats: Mapping[str, Boat], metrics: str) -> None:
    """Write compare.rrd: several runs in one scene, each in its own colour, and their signals.

    The first vessel is drawn as a hull in its tank, the others as outlines, so that small distances
    are visible.

    Args:
        path: The file.
        boats: Runs by the name in labels and legends, with letters, digits and _ only.
        metrics: Their metrics as a table in Markdown.

    Raises:
        OSError: If the file cannot be written.
    """
    stream = Stream("boatsim_compare", path)
    _send_axes(stream)
    scene = next(iter(boats.values())).scene
    _draw_tank(stream, scene)
    for number, (name, boat) in enumerate(boats.items()):
        colour = blueprint.PALETTE[number % len(blueprint.PALETTE)]
        if number == 0:
            _draw_hull(stream, scene, f"boats/{name}", colour)
        _draw_outline(stream, boat.scene, name, number, colour)
        _log_motion(stream, boat.recording, boat.scene, f"boats/{name}")
        _log_path(
            stream, boat.recording, f"paths/{name}", colour, None, _line_height(boat.scene, number)
        )
        signals: dict[str, Array] = {}
        for signal, values in boat.recording.signals.items():
            style = blueprint.curve_style(signal, number, name, colour)
            if signal.startswith(GOAL):
                if not boat.goals:
                    continue
                style = blueprint.curve_style(
                    signal, number, boat.goals, blueprint.lighten_colour(colour)
                )
            signals[signal] = values
            stream.log(f"{SIGNALS}/{name}/{signal}", style, static=True)
        _log_signals(stream, replace(boat.recording, signals=signals), f"{SIGNALS}/{name}")
    stream.log("norms", rr.TextDocument(metrics, media_type="text/markdown"), static=True)
    columns = {name: list(boat.recording.signals) for name, boat in boats.items()}
    stream.send_blueprint(blueprint.comparison_layout(scene, columns))
    stream.close()


def _send_axes(stream: Stream) -> None:
    stream.log(WORLD, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)


def metrics_table(metrics: Mapping[str, MetricEntry]) -> str:
    """Return the metrics of a run as a Markdown table.

    Args:
        metrics: Metrics by name, as in norms.json.
    """
    if not metrics:
        return "This scenario has no metrics.\n"
    lines = ["| metric | is | value | band | met | published |", "|:---|:---|---:|---:|:---:|:---|"]
    for name, entry in metrics.items():
        value = f"{_format_value(entry.get('value'))} {entry.get('unit') or ''}".strip()
        verdict = VERDICTS.get(entry.get("verdict") or "", "")
        cells = [
            name,
            entry.get("kind", ""),
            entry.get("lacking") or value,
            _format_band(entry.get("guard")),
            MET[entry.get("ok")],
            f"{_format_value(entry.get('published'))} {verdict}".strip(),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _format_band(ends: Sequence[float | None] | None) -> str:
    low, high = map(_format_value, ends or (None, None))
    if low and high:
        return f"{low} to {high}"
    if low:
        return f"at least {low}"
    if high:
        return f"at most {high}"
    return ""


def _format_value(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _join_recordings(parts: Sequence[Recording]) -> Recording:
    signals: dict[str, Array] = {}
    for name in dict.fromkeys(chain.from_iterable(part.signals for part in parts)):
        pieces = [part.signals.get(name, np.full(len(part), math.nan)) for part in parts]
        signals[name] = np.concatenate(pieces)
    return Recording(parts[0].name, np.concatenate([p.t for p in parts]), signals, Notes())


def _separate_segment_ends(segments: Sequence[Recording]) -> list[Recording]:
    """Segments whose end is moved just before the begin of the next one."""
    found: list[Recording] = []
    for segment, following in pairwise(segments):
        end = min(segment.t[-1], following.t[0] - 2 * PARTING)
        found.append(replace(segment, t=np.append(segment.t[:-1], end)))
    return [*found, segments[-1]]


def _join_with_gaps(segments: Sequence[Recording]) -> Recording:
    """Segments as one recording, separated by rows of nan, at which curves break."""
    parts = [segments[0]]
    for segment in segments[1:]:
        gap = dict.fromkeys(segment.signals, np.full(1, np.nan))
        parts += [Recording("", segment.t[:1] - PARTING, gap), segment]
    return _join_recordings(parts)


def _time_columns(t: Array) -> list[rr.TimeColumn]:
    return [rr.TimeColumn(TIMELINE, duration=np.round(t * 1e9).astype("timedelta64[ns]"))]


def _log_signals(stream: Stream, rows: Recording, under: str) -> None:
    when = _time_columns(rows.t)
    for name, values in rows.signals.items():
        stream.send_columns(f"{under}/{name}", when, rr.Scalars.columns(scalars=values))


def _picture_points(x: Array, y: Array, z: float = 0.0) -> Array:
    """SNAME x, y as points (N, 3) of the picture, z up and y to port."""
    return np.column_stack([x, -y, np.full(len(x), z)])


def _draw_tank(stream: Stream, scene: Scene, still: bool = True) -> None:
    """Draw the tank; the water only where it is still."""
    length, width, x, y = scene.tank
    for solid in scene.solids:
        if solid.part == "tank" and (still or solid.name != "water"):
            stream.log(f"{WORLD}/tank/{solid.name}", _make_mesh(_upper_side(solid)), static=True)
    if "tank" in {solid.part for solid in scene.solids}:
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


def _draw_surface(stream: Stream) -> None:
    """Draw what does not change of the surface of the sea."""
    look = rr.Mesh3D.from_fields(
        triangle_indices=WaveSurface.triangles(), albedo_factor=COLOURS["water"]
    )
    stream.log(f"{WORLD}/sea", look, static=True)


def _log_surface(stream: Stream, rows: Recording, surface: WaveSurface, after: float) -> float:
    """Log the frames of the surface of the sea in some rows; return the time of the last frame."""
    zero = np.zeros(len(rows))
    x, y = rows.signals.get("x_m", zero), rows.signals.get("y_m", zero)
    due = surface.rows_of_frames(rows.t, after)
    if not len(due):
        return after
    frames = [surface.vertices(float(x[i]), float(y[i]), float(rows.t[i])) for i in due]
    points, normals = map(np.concatenate, zip(*frames, strict=True))
    count = len(points) // len(due)
    columns = rr.Mesh3D.columns(vertex_positions=points, vertex_normals=normals)
    stream.send_columns(
        f"{WORLD}/sea", _time_columns(rows.t[due]), columns.partition([count] * len(due))
    )
    return float(rows.t[due[-1]])


def _draw_hull(
    stream: Stream, scene: Scene, boat: str, tint: tuple[int, int, int] | None = None
) -> None:
    """Draw the hull; outboards are entities of their own, so that they can turn."""
    for solid in scene.solids:
        if solid.part != "tank":
            entity = f"{WORLD}/{boat}/{solid.part}/{solid.name}"
            stream.log(entity, _make_mesh(solid, tint), static=True)
    for thruster in scene.thrusters:
        at = rr.Transform3D(translation=(thruster.x, -thruster.y, 0.0))
        stream.log(f"{WORLD}/{boat}/{OUTBOARD}{thruster.name}", at, static=True)


def _line_height(scene: Scene, number: int) -> float:
    """Height [m] above the hull, different for each vessel, so that their lines do not flicker."""
    top = max(
        (float(s.vertices[:, 2].max()) for s in scene.solids if s.part != "tank"), default=0.0
    )
    return top + (5 + number) * 0.002 * scene.length


def _draw_outline(
    stream: Stream, scene: Scene, boat: str, number: int, colour: tuple[int, int, int]
) -> None:
    """Draw the outline of the hull from above, a line from its middle to the bow, and its name."""
    ring = scene.hull_outline()
    height, bow, stern = (
        _line_height(scene, number),
        float(ring[:, 0].max()),
        float(ring[:, 0].min()),
    )
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


def _upper_side(solid: Solid) -> Solid:
    """The upper side of a transparent solid such as water, whose bottom would flicker."""
    if solid.colour[3] >= 1.0:
        return solid
    corners = solid.vertices[solid.triangles]
    upward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 1e-12
    return solid._replace(triangles=solid.triangles[upward])


def _make_mesh(solid: Solid, tint: tuple[int, int, int] | None = None) -> rr.Mesh3D:
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


def _log_motion(stream: Stream, rows: Recording, scene: Scene, boat: str) -> None:
    """Pose of the hull and angles of the outboards; a boat that only rolls stays at the origin."""
    zero = np.zeros(len(rows))
    pose = np.stack([rows.signals.get(name, zero) for name in POSE])
    known = np.isfinite(pose).all(axis=0)  # rows without a measurement are skipped
    x, y, z, phi, theta, psi = pose[:, known]
    points = _picture_points(x, y)
    points[:, 2] -= z  # z is down
    place = rr.Transform3D.columns(
        translation=points, quaternion=_attitude_quaternions(psi, phi, theta)
    )
    stream.send_columns(f"{WORLD}/{boat}", _time_columns(rows.t[known]), place)
    for thruster in scene.thrusters:
        if (steer := rows.signals.get(thruster.steer)) is not None:
            # a steering angle a turns the force by a to starboard
            turned = rr.Transform3D.columns(quaternion=_attitude_quaternions(steer, zero))
            stream.send_columns(
                f"{WORLD}/{boat}/{OUTBOARD}{thruster.name}", _time_columns(rows.t), turned
            )


def _attitude_quaternions(psi: Array, phi: Array, theta: Array | float = 0.0) -> Array:
    """Quaternions (N, 4) x, y, z, w of heading, pitch and roll [rad] in axes of the picture."""
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
            vector = _picture_points(thrust * np.cos(steer), thrust * np.sin(steer))
            at = _picture_points(zero + thruster.x, zero + thruster.y, ABOVE)
            _log_arrow(
                stream, rows.t, f"thrust_{thruster.name}", scene, vector, at, COLOURS["thrust"]
            )
    for what in HEIGHTS:
        if f"{what}_X_N" in rows.signals and f"{what}_Y_N" in rows.signals:
            vector = _picture_points(rows[f"{what}_X_N"], rows[f"{what}_Y_N"])
            height = scene.length * HEIGHTS[what]
            _log_arrow(
                stream,
                rows.t,
                what,
                scene,
                vector,
                _picture_points(zero, zero, height),
                COLOURS[what],
            )


def _log_arrow(
    stream: Stream,
    t: Array,
    name: str,
    scene: Scene,
    newtons: Array,
    at: Array,
    colour: tuple[int, int, int],
) -> None:
    """Log arrows of forces (N, 3) [N] in axes of the hull."""
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
        entity, _time_columns(t), rr.Arrows3D.columns(vectors=scene.reach * newtons, origins=at)
    )


def _log_path(
    stream: Stream,
    rows: Recording,
    name: str,
    colour: tuple[int, int, int],
    last: tuple[float, Array] | None,
    height: float = ABOVE,
) -> tuple[float, Array] | None:
    """Log the path as short lines; return time and position of its last point.

    The view shows all lines up to its time.
    """
    if not {"x_m", "y_m"} <= rows.signals.keys():
        return last
    known = np.flatnonzero(np.isfinite(rows["x_m"]) & np.isfinite(rows["y_m"]))
    if not len(known):
        return last
    due = known[np.unique(np.floor(rows.t[known] / TRAIL_STEP + 1e-6), return_index=True)[1]]
    t, points = rows.t[due], _picture_points(rows["x_m"][due], rows["y_m"][due], height)
    if last is not None:
        t, points = np.append(last[0], t), np.vstack([last[1], points])
    entity = f"{WORLD}/{name}"
    if len(t) > 1:
        pairs = np.stack([points[:-1], points[1:]], axis=1)
        stream.log(entity, rr.LineStrips3D.from_fields(colors=[colour], radii=[-2.0]), static=True)
        stream.send_columns(
            entity, _time_columns(t[1:]), rr.LineStrips3D.columns(strips=list(pairs))
        )
    return float(t[-1]), points[-1]


def _log_camera(stream: Stream, rows: Recording) -> None:
    """Log the measurements of the camera at the rows with a new one."""
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
        points = rr.Points3D.columns(positions=_picture_points(x[fresh], y[fresh], 1.5 * ABOVE))
        stream.send_columns(entity, _time_columns(rows.t[fresh]), points)


def _flagged_force(missing: Recording, intervals: Sequence[Flagged]) -> dict[str, Array]:
    """The missing force in flagged intervals, nan elsewhere, as further signals."""
    found: dict[str, Array] = {}
    for name, axis in blueprint.MISSING.items():
        inside = np.zeros(len(missing), dtype=bool)
        for flagged in intervals:
            if flagged["axis"] == axis:
                inside |= (missing.t >= flagged["from_s"]) & (missing.t <= flagged["to_s"])
        if name in missing.signals and inside.any():
            found[f"{name}_flagged"] = np.where(inside, missing[name], math.nan)
    return found
