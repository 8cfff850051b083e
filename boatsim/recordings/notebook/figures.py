"""Figures of recordings by matplotlib: the track from above, and signals over time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.signals import POSE, RATES
from boatsim.recordings.notebook.labels import column_in_words, display_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NEEDED = 'plot needs matplotlib: pip install "boatsim[notebook]"'
TRACK = ("x_m", "y_m")
WIDTH, PANEL_HEIGHT, LEAST_HEIGHT = 9.0, 1.5, 4.0  # [inch]
MARGIN = 0.05  # of the range of the drawn values, on each side
REACH = 0.5  # of that range, by which a curve that is not fitted in may widen the axes


@dataclass(frozen=True)
class Curve:
    """A curve of a figure.

    Attributes:
        name: Its name in the legend; "" for none.
        x: Abscissas (N,).
        y: Ordinates (N,); a curve is interrupted at nan.
        colour: Colour of matplotlib; "" for the next one of its cycle.
        width: Width of the line [points].
        held: Whether each value is in force until the next.
        fitted_in: Whether the axes show all of it.
    """

    name: str
    x: Array
    y: Array
    colour: str = ""
    width: float = 1.5
    held: bool = False
    fitted_in: bool = True


@dataclass(frozen=True)
class Panel:
    """A diagram over time: its label with the unit, and its curves."""

    label: str
    curves: tuple[Curve, ...]


def signal_panels(t: Array, signals: Mapping[str, Array]) -> list[Panel]:
    """Return the diagrams of signals: one for each coordinate, rates and commands by their unit.

    Angles are in degrees.

    Args:
        t: Times (N,) [s].
        signals: Name with the unit as suffix -> values (N,).
    """
    groups: dict[str, list[str]] = {}
    for name in signals:
        kind = f"other {display_unit(name)[0]}"
        if name in POSE:
            kind = name
        elif name in RATES:
            kind = f"rate {display_unit(name)[0]}"
        groups.setdefault(kind, []).append(name)
    panels = []
    for names in groups.values():
        curves = []
        for name in names:
            unit, factor = display_unit(name)
            held = name not in (*POSE, *RATES)
            curves.append(Curve(column_in_words(name), t, factor * signals[name], held=held))
        label = f"[{unit}]"
        if len(names) == 1:
            label = f"{curves[0].name} [{unit}]"
        panels.append(Panel(label, tuple(curves)))
    return panels


def draw_figure(title: str, track: Sequence[Curve], panels: Sequence[Panel]) -> "Figure":
    """Draw a track seen from above next to diagrams over time.

    Args:
        title: Title of the figure.
        track: Tracks, east or starboard over north or forward [m]; none for signals without
            positions.
        panels: Diagrams over time [s].

    Returns:
        The figure, which a notebook shows and `savefig` writes to a file.

    Raises:
        BadInput: If there is nothing to draw, or matplotlib is not installed.
    """
    if not track and not panels:
        raise BadInput(f"{title}: there are no signals to plot")
    try:
        from matplotlib import pyplot
    except ImportError:
        raise BadInput(NEEDED) from None
    height = max(LEAST_HEIGHT, PANEL_HEIGHT * len(panels))
    figure = pyplot.figure(figsize=(WIDTH, height), layout="constrained")
    pyplot.close(figure)  # else a notebook would show it twice
    figure.suptitle(title)
    columns = bool(track) + bool(panels)
    grid = figure.add_gridspec(max(len(panels), 1), columns)
    if track:
        _draw_track(figure.add_subplot(grid[:, 0]), track)
    above = None
    for row, panel in enumerate(panels):
        axes = figure.add_subplot(grid[row, -1], sharex=above)
        above = above or axes
        _draw_panel(axes, panel, row == len(panels) - 1)
    return figure


def _draw_track(axes: "Axes", track: Sequence[Curve]) -> None:
    _draw_curves(axes, track)
    axes.set_xlabel("y, east or starboard [m]")
    axes.set_ylabel("x, north or forward [m]")
    across = _limits([curve.x for curve in track], track)
    along = _limits([curve.y for curve in track], track)
    size = max(across[1] - across[0], along[1] - along[0])
    axes.set_xlim(*_centred(across, size))
    axes.set_ylim(*_centred(along, size))
    axes.set_aspect("equal")


def _centred(limits: tuple[float, float], size: float) -> tuple[float, float]:
    """Limits of this size with the same middle."""
    middle = (limits[0] + limits[1]) / 2
    return middle - size / 2, middle + size / 2


def _draw_panel(axes: "Axes", panel: Panel, last: bool) -> None:
    _draw_curves(axes, panel.curves)
    axes.set_ylabel(panel.label)
    axes.set_ylim(*_limits([curve.y for curve in panel.curves], panel.curves))
    axes.tick_params(labelbottom=last)
    if last:
        axes.set_xlabel("time [s]")


def _draw_curves(axes: "Axes", curves: Sequence[Curve]) -> None:
    for curve in curves:
        (line,) = axes.plot(curve.x, curve.y, linewidth=curve.width)
        line.set_label(curve.name or "_nolegend_")
        if curve.colour:
            line.set_color(curve.colour)
        if curve.held:
            line.set_drawstyle("steps-post")
    axes.grid(alpha=0.3)
    if len(curves) > 1:
        axes.legend(fontsize="small")


def _limits(values: Sequence[Array], curves: Sequence[Curve]) -> tuple[float, float]:
    """The limits of an axis: all of the curves to be fitted in, and the near part of others."""
    inside = []
    for part, curve in zip(values, curves, strict=True):
        if curve.fitted_in:
            inside.append(part)
    low, high = _range(inside or values)
    room = max(high - low, 1e-9)
    lowest, highest = _range(values)
    low = max(min(low, lowest), low - REACH * room)
    high = min(max(high, highest), high + REACH * room)
    return low - MARGIN * room, high + MARGIN * room


def _range(values: Sequence[Array]) -> tuple[float, float]:
    known = np.concatenate(values)
    known = known[np.isfinite(known)]
    if not len(known):
        return 0.0, 1.0
    return float(known.min()), float(known.max())
