"""Plots over time of a run's log: motion with goals, commands, actuators, forces and estimates."""

from collections.abc import Collection, Sequence
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.signals import COMPONENTS, measured_column_for_goal
from boatsim.recordings.notes import unit_of
from boatsim.simulate.tracking_errors import GOAL
from boatsim.view.formatting import capitalize, convenient_unit, name_in_words
from boatsim.view.svg_plots import Line, Panel, axis_limits, figure
from boatsim.view.thinned_log import Samples

REFERENCE = "reference_"  # prefix of the columns of a controller's reference model
SENT, ACTUAL, ESTIMATE = "sent_", "actual_", "estimate_"
LOOKS = ("one", "two", "three", "four")  # classes of the style sheet, one for each signal of a plot
MOTION = {  # title of a plot -> signals that it shows, with their names
    "Velocity": {"u_mps": "surge", "v_mps": "sway", "w_mps": "heave"},
    "Heading": {"psi_rad": "heading"},
    "Yaw rate": {"r_radps": "yaw rate"},
    "Roll": {"phi_rad": "roll"},
    "Pitch": {"theta_rad": "pitch"},
    "Heave": {"z_m": "heave, down"},
    "Waves": {"wave_elevation_m": "elevation of the sea at the vessel, up"},
    "Current": {"water_north_mps": "north", "water_east_mps": "east"},
}


FORCES = {"force_": "", "wind_": ", of the wind"}  # prefix of a column -> words


class Curve(NamedTuple):
    """A curve of a plot: column of the log, class of the style sheet, and name."""

    column: str
    look: str
    name: str


class Plot(NamedTuple):
    """Signals of one unit that are drawn over time in one plot."""

    title: str
    curves: tuple[Curve, ...]


def run_figures(samples: Samples, channels: Collection[str]) -> list[str]:
    """Draw the signals of a run over time, angles in degrees.

    Args:
        samples: Samples of the run's log.
        channels: Command channels of the vessel.

    Returns:
        Figures as mark-up.
    """
    drawn = []
    for plot in select_plots(samples, channels):
        shafts = not {curve.column for curve in plot.curves}.isdisjoint(_columns_of(channels))
        panel = signal_panel(samples, plot, shafts)
        names = {}
        if len(plot.curves) > 1:
            names = {curve.look: curve.name for curve in plot.curves}
        drawn.append(figure([panel], plot.title, key=names))
    return drawn


def select_plots(samples: Samples, channels: Collection[str]) -> list[Plot]:
    """Choose the signals of a run that are plotted, and those that share a plot.

    Args:
        samples: Samples of the run's log.
        channels: Command channels of the vessel.
    """
    known = [name for name, values in samples.first.items() if np.isfinite(values).any()]
    plots = [_motion_plot(title, signals, known) for title, signals in MOTION.items()]
    used = {curve.column for plot in plots for curve in plot.curves}
    plots += _command_plots(known, channels)
    plots += _plots_by_unit("Actuators", _without_prefix(ACTUAL, known, channels))
    plots += _plots_by_unit("On the hull", _force_names(known))
    control = {}
    for name in known:
        if not name.startswith((REFERENCE, ESTIMATE, GOAL)) or name in used:
            continue
        goal = name.removeprefix(GOAL)
        if name.endswith(("_low", "_high")) or goal in channels or goal in ("x_m", "y_m"):
            continue
        control[name] = _plain_name(name)
    plots += _plots_by_unit("Controller", control)
    return [plot for plot in plots if plot.curves]


def _force_names(known: Sequence[str]) -> dict[str, str]:
    """Return the columns of forces on the hull, with the names of their axes."""
    found = {}
    for prefix, words in FORCES.items():
        for axis, component in COMPONENTS.items():
            if f"{prefix}{component}" in known:
                found[f"{prefix}{component}"] = f"{axis}{words}"
    return found


def _motion_plot(title: str, signals: dict[str, str], known: Sequence[str]) -> Plot:
    """Signals of the motion with their goals and references, in the colour of the signal."""
    curves = []
    shown = [signal for signal in signals if signal in known]
    for look, signal in zip(LOOKS, shown, strict=False):
        curves.append(Curve(signal, look, signals[signal]))
        for name in known:
            goal = measured_column_for_goal(name.removeprefix(GOAL))
            if name.startswith(GOAL) and goal == signal:
                curves.append(Curve(name, f"{look} goal", f"goal of {signals[signal]}"))
        if f"{REFERENCE}{signal}" in known:
            name = f"reference of {signals[signal]}"
            curves.append(Curve(f"{REFERENCE}{signal}", f"{look} reference", name))
    return Plot(title, tuple(curves))


def _command_plots(known: Sequence[str], channels: Collection[str]) -> list[Plot]:
    """Commands by unit; the position of an actuator is a line, the command to it is dashed."""
    plots = []
    for names in _by_unit(channels).values():
        for some in _in_fours(names):
            curves = []
            what = "Commands"
            for look, channel in zip(LOOKS, some, strict=False):
                name, sent = _plain_name(channel), f"{SENT}{channel}"
                if sent not in known:
                    sent = channel
                if f"{ACTUAL}{channel}" in known:
                    curves.append(Curve(f"{ACTUAL}{channel}", look, f"{name}, actual"))
                    look, name, what = f"{look} goal", f"{name}, command", "Actuators"
                if sent in known:
                    curves.append(Curve(sent, look, name))
            shared = _shared_words([_plain_name(channel) for channel in some])
            title = f"{what}: {shared}" if shared else what
            plots.append(Plot(title, tuple(curves)))
    return plots


def _shared_words(names: Sequence[str]) -> str:
    """Return the words with which all names begin."""
    shared = names[0].split()
    for name in names[1:]:
        same = takewhile(lambda pair: pair[0] == pair[1], zip(shared, name.split(), strict=False))
        shared = [word for word, _ in same]
    return " ".join(shared)


def _without_prefix(prefix: str, known: Sequence[str], channels: Collection[str]) -> dict[str, str]:
    """Return the columns with a prefix that are no channels, with their names."""
    found = {}
    for name in known:
        plain = name.removeprefix(prefix)
        if name.startswith(prefix) and plain not in channels:
            found[name] = _plain_name(plain)
    return found


def _plots_by_unit(title: str, columns: dict[str, str]) -> list[Plot]:
    """Return plots of columns, those of one unit in one plot of four at most."""
    plots = []
    for unit, names in _by_unit(columns).items():
        for some in _in_fours(names):
            curves = []
            for look, name in zip(LOOKS, some, strict=False):
                curves.append(Curve(name, look, columns[name]))
            plots.append(Plot(_title(title, unit), tuple(curves)))
    return plots


def _by_unit(names: Collection[str]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for name in names:
        found.setdefault(unit_of(name), []).append(name)
    return found


def _in_fours(names: Sequence[str]) -> list[Sequence[str]]:
    """Divide names into groups that one plot can distinguish."""
    return [names[first : first + len(LOOKS)] for first in range(0, len(names), len(LOOKS))]


def _title(what: str, unit: str) -> str:
    """Return the title of a plot of signals with this unit."""
    words = {"N": "force", "N m": "moment", "rad": "angle", "rad/s": "rate", "m": "position"}
    if what == "On the hull":
        return f"{capitalize(words.get(unit, 'force'))} on the hull, sum of all effects"
    if unit not in words:
        return what
    return f"{what}: {words[unit]}"


def _plain_name(column: str) -> str:
    """Return the name of a column in words, without its unit."""
    if unit_of(column):
        column = column.rpartition("_")[0]
    return name_in_words(column)


def _finite_pieces(values: Array) -> list[slice]:
    """Return the parts of a curve without nan, as where a goal is in force."""
    finite = np.isfinite(values).astype(int)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], finite, [0]])))
    return [slice(first, end) for first, end in zip(edges[::2], edges[1::2], strict=True)]


def _columns_of(channels: Collection[str]) -> list[str]:
    """Return the columns of command channels in a log."""
    return [prefix + channel for channel in channels for prefix in ("", SENT, ACTUAL)]


def signal_panel(samples: Samples, plot: Plot, shafts: bool = False) -> Panel:
    """Draw some signals of a run over time, in a convenient unit.

    Args:
        samples: Samples of the run's log.
        plot: The signals.
        shafts: Whether the signals are of actuators: the speed of a shaft stays in rad/s.
    """
    drawn = [samples.thinned_curve(curve.column) for curve in plot.curves]
    largest = max(float(np.nanmax(np.abs(values), initial=0.0)) for _, values in drawn)
    unit, factor = convenient_unit(unit_of(plot.curves[0].column), largest)
    if shafts and unit == "°/s":
        unit, factor = "rad/s", 1.0
    lines = []
    for curve, (t, values) in zip(plot.curves, drawn, strict=True):
        for piece in _finite_pieces(values):
            lines.append(Line(curve.look, t[piece], factor * values[piece], curve.name))
    label = plot.title.partition(",")[0]
    if len(plot.curves) == 1:
        label = capitalize(plot.curves[0].name)
    if unit:
        label = f"{label} [{unit}]"
    names = ", ".join(curve.name for curve in plot.curves)
    limits = (-1.0, 1.0)  # of a signal that stays zero
    if largest > 0.0:
        limits = axis_limits([line.y for line in lines], zero=unit not in ("°", "m"))
    return Panel(
        label,
        tuple(lines),
        (float(samples.t[0]), max(samples.end, float(samples.t[0]) + 1e-9)),
        limits,
        "time [s]",
        about=f"{label} over time: {names}",
    )
