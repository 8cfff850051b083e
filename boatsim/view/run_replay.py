"""The replay of a run: the boat on its path seen from above, or its motion over time."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.base import Array
from boatsim.recordings.notes import unit_of
from boatsim.view.formatting import convenient_unit, format_number
from boatsim.view.replay import (
    MARK,
    MARK_SIZE,
    SECTION,
    SECTION_SIZE,
    Animation,
    Boat,
    Outline,
    Readout,
    Replay,
    axis_limits_with_margin,
    playback_speed,
    rounded_or_none,
    scaled_outline,
)
from boatsim.view.run_figures import MOTION, Curve, Plot, signal_panel
from boatsim.view.scene import Scene
from boatsim.view.svg_plots import (
    SQUARE,
    Line,
    Panel,
    axis_limits,
    evenly_spaced_rows,
    legend,
    stack_panels,
)
from boatsim.view.thinned_log import Samples

FRAMES = 800
# smallest length of the drawn boat, relative to the height of the figure; a smaller one is enlarged
SMALLEST = 0.06
ROOM = 0.6  # [lengths] around the path that the figure shows
WAYPOINTS = 60  # most different positions that count as waypoints; more are a reference track
# signals that are animated over time where there is no path, the first one that the run has
WITHOUT_PATH = ("phi_rad", "psi_rad", "theta_rad", "z_m", "u_mps", "r_radps")
READOUTS = {"u_mps": "surge", "v_mps": "sway", "psi_rad": "heading", "phi_rad": "roll"}


def run_replay(samples: Samples, scene: Scene) -> Replay | None:
    """Return the animated replay of a run: the boat seen from above, or a signal over time.

    Args:
        samples: Samples of its log.
        scene: Shape of the vessel, and the water.

    Returns:
        The boat seen from above, or a signal over time where the run has no path; None where it has
        neither.
    """
    if {"x_m", "y_m"} <= samples.first.keys():
        return _path(samples, scene)
    for signal in WITHOUT_PATH:
        if signal in samples.first:
            return _signal_over_time(samples, signal)
    return None


def _path(samples: Samples, scene: Scene) -> Replay:
    """Return the path seen from above, x up and y to the right, to scale."""
    x, y = samples.first["x_m"], samples.first["y_m"]
    lines = [Line("path", y, x, "path", t=samples.t)]
    dots, looks = [], {"path": "path"}
    room = ROOM * scene.length * np.array([[-1.0], [1.0]])  # for the boat at the ends of its path
    across, up = [y + room], [x + room]
    goal = _goal_positions(samples)
    if goal is not None:
        goal_x, goal_y = goal
        looks["one goal"] = "reference track"
        if len(goal_x) <= WAYPOINTS:
            looks = {"path": "path", "waypoint": "waypoint of the scenario"}
            dots.append(Line("waypoint", goal_y, goal_x))
        else:
            lines.insert(0, Line("one goal", goal_y, goal_x, "reference track"))
        across.append(goal_y)
        up.append(goal_x)
    if not scene.open:
        corners_y, corners_x = _basin(scene)
        looks["wall"] = "walls of the basin"
        lines.insert(0, Line("wall", corners_y, corners_x, "wall"))
        across.append(corners_y)
        up.append(corners_x)
    left, right = axis_limits(across, False)
    bottom, top = axis_limits(up, False)
    height = max(top - bottom, (right - left) / SQUARE)
    panel = Panel(
        "x, forward or north [m]",
        tuple(lines),
        axis_limits_with_margin(_about_middle(left, right, SQUARE * height)),
        axis_limits_with_margin(_about_middle(bottom, top, height)),
        "y, to starboard or east [m]",
        shape=SQUARE,
        dots=tuple(dots),
        about="Path of the boat seen from above.",
    )
    height = panel.y[1] - panel.y[0]
    scale = 1.0
    if scene.open:
        scale = max(1.0, SMALLEST * height / scene.length)
    about = "Seen from above, to scale."
    if scale > 1.0:
        about += f" The boat is drawn {format_number(scale, 2)} times its size."
    return Replay(
        "Path of the boat",
        f"{about} The plots below show the time of the replay.",
        legend(looks),
        stack_panels([panel]),
        _film(samples, (y, x), height, _hull_outline(scene, scale), None),
    )


def _signal_over_time(samples: Samples, signal: str) -> Replay:
    """Return a replay of a signal over time, for a vessel without a path."""
    name = "motion"
    for signals in MOTION.values():
        name = signals.get(signal, name)
    panel = signal_panel(samples, Plot(name, (Curve(signal, "path", name),)))
    height = panel.y[1] - panel.y[0]
    panel = replace(panel, x=axis_limits_with_margin(panel.x))
    outline = scaled_outline(MARK, MARK_SIZE * height, MARK_SIZE * height)
    if signal == "phi_rad":
        outline = scaled_outline(SECTION, SECTION_SIZE * height, SECTION_SIZE * height)
    return Replay(
        f"{name.capitalize()} of the boat over time",
        "The plots below show the time of the replay.",
        "",
        stack_panels([panel]),
        _film(samples, (samples.t, samples.first[signal]), height, outline, signal),
    )


def _goal_positions(samples: Samples) -> tuple[Array, Array] | None:
    """Return the different positions that the goals of a run lead to; None without such goals."""
    if not {"goal_x_m", "goal_y_m"} <= samples.first.keys():
        return None
    x, y = samples.first["goal_x_m"], samples.first["goal_y_m"]
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    if not len(x):
        return None
    changed = np.append(True, (np.diff(x) != 0.0) | (np.diff(y) != 0.0))
    return x[changed], y[changed]


def _basin(scene: Scene) -> tuple[Array, Array]:
    """Return y and x of the corners of the basin."""
    length, width, x, y = scene.tank
    right = y + 0.5 * width * np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
    up = x + 0.5 * length * np.array([-1.0, -1.0, 1.0, 1.0, -1.0])
    return right, up


def _about_middle(low: float, high: float, size: float) -> tuple[float, float]:
    """Return limits of this size about the middle of the given ones."""
    return (low + high) / 2 - size / 2, (low + high) / 2 + size / 2


def _hull_outline(scene: Scene, scale: float) -> Outline:
    """Return the outline of the hull from above, to starboard and astern."""
    found = []
    for x, y in scene.hull_outline().tolist():  # forward and to port
        found.append((float(f"{-scale * y:.4g}"), float(f"{-scale * x:.4g}")))
    return found


def _film(
    samples: Samples,
    place: tuple[Array, Array],
    height: float,
    outline: Outline,
    signal: str | None,
) -> Animation:
    """Return the frames of a replay.

    Args:
        samples: Samples of the run's log.
        place: Where the boat is, to the right and up (B,).
        height: Range of the vertical axis, which sets the rounding.
        outline: Outline of the boat.
        signal: Signal that is shown over time; None for a view from above.
    """
    rows = evenly_spaced_rows(len(samples.t), FRAMES)
    decimals = max(0, 4 - math.floor(math.log10(height)))
    turned, unit, factor = np.zeros(len(rows)), "m", 1.0
    if signal is None and "psi_rad" in samples.first:
        turned = samples.first["psi_rad"][rows]
    if signal is not None:
        largest = float(np.nanmax(np.abs(samples.first[signal]), initial=0.0))
        unit, factor = convenient_unit(unit_of(signal), largest)
        if signal in ("phi_rad", "psi_rad"):
            turned = samples.first[signal][rows]
    boat: Boat = {
        "look": "boat",
        "name": "boat",
        "x": rounded_or_none(place[0][rows], decimals),
        "y": rounded_or_none(factor * place[1][rows], decimals),
        "turned": rounded_or_none(turned, 3),
    }
    return {
        "t": np.round(samples.t[rows], 3).tolist(),
        "start": 0,
        "rate": playback_speed(float(samples.t[-1] - samples.t[0])),
        "plan": signal is None,
        "unit": unit,
        "outline": outline,
        "boats": [boat],
        "readouts": _readouts(samples, rows),
        "cursor": True,
    }


def _readouts(samples: Samples, rows: NDArray[np.int64]) -> list[Readout]:
    """Return the numbers below the figure: speeds and angles of each frame."""
    found: list[Readout] = []
    for signal, name in READOUTS.items():
        if signal not in samples.first:
            continue
        values = samples.first[signal]
        largest = float(np.nanmax(np.abs(values), initial=0.0))
        unit, factor = convenient_unit(unit_of(signal), largest)
        decimals = 1
        if not unit.startswith("°") and largest > 0.0:
            decimals = max(0, min(4, 2 - math.floor(math.log10(factor * largest))))
        shown = factor * values[rows]
        if signal == "psi_rad":
            shown = np.mod(shown, 360.0)
        found.append(
            {
                "name": name,
                "unit": unit,
                "decimals": decimals,
                "values": rounded_or_none(shown, decimals),
            }
        )
    return found
