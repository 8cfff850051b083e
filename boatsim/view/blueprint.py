"""Layout of logs in rerun's viewer: scene on the left, plots on the right, styles of the curves."""

import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain

import rerun as rr
import rerun.blueprint as rrb

from boatsim.physics.signals import COMPONENTS, POSE, RATES, measured_column_for_goal
from boatsim.recordings.notes import unit_of
from boatsim.recordings.readers.rrd import SIGNALS, TIMELINE
from boatsim.simulate.tracking_errors import GOAL
from boatsim.view.scene import Scene

WORLD = "world"
MISSING = {f"force_{component}": axis for axis, component in COMPONENTS.items()}
MOTION = tuple("off_m x_m y_m psi_rad phi_rad u_mps v_mps r_radps p_radps".split())
TITLES = {"off_m": "distance from the recording [m]"}
Colour = tuple[int, int, int]
PALETTE: tuple[Colour, ...] = (
    (31, 119, 180),
    (214, 39, 40),
    (44, 160, 44),
    (148, 103, 189),
    (140, 86, 75),
    (23, 190, 207),
)
HIGH, WIDE = 0.95, 1.0  # visible length and width below an eye, by its height above the water
ORANGE = (255, 127, 14)
GREY = (150, 150, 150)
SKY = (238, 242, 246)
# the same colour for the same thing in every plot; port red and starboard green as on the water
FIXED: dict[str, Colour] = {
    "u_mps": PALETTE[0],
    "v_mps": PALETTE[3],
    "r_radps": PALETTE[0],
    "p_radps": PALETTE[3],
    "reference_u_mps": ORANGE,
    "reference_v_mps": (227, 119, 194),
    "reference_r_radps": ORANGE,
}


def curve_style(
    name: str, number: int, boat: str = "", colour: Colour | None = None
) -> rr.SeriesLines:
    """Return the style of a signal's curve in rerun's viewer: colour, width and legend.

    Args:
        name: Column of the signal.
        number: Number of the signal, for its colour.
        boat: Name of the run in the legend; default: the signal.
        colour: Colour; default: by signal.
    """
    bound = name.endswith(("_low", "_high"))
    chosen = colour or _curve_colour(name, number)
    return rr.SeriesLines(
        colors=[chosen], widths=[1.0 if bound else 2.0], names=[boat or legend_text(name)]
    )


def sample_style(boat: str, colour: Colour) -> rr.SeriesPoints:
    """Return the style of recorded samples in rerun's viewer: dots, which do not hide curves."""
    return rr.SeriesPoints(colors=[colour], markers=["circle"], marker_sizes=[2.0], names=[boat])


def missing_force_style(name: str, flagged: Colour) -> rr.SeriesLines:
    """Return the style of a missing-force curve: the force, its 2-sd band, or its flagged part.

    Args:
        name: Column of the curve; its ending distinguishes the three.
        flagged: Colour of the flagged part.
    """
    for end, (label, colour, width) in {
        "_flagged": ("flagged", flagged, 4.0),
        "_low": ("- 2 sd", GREY, 1.0),
        "_high": ("+ 2 sd", GREY, 1.0),
    }.items():
        if name.endswith(end):
            return rr.SeriesLines(colors=[colour], widths=[width], names=[label])
    return rr.SeriesLines(colors=[SKY], widths=[2.0], names=["missing"])


def legend_text(name: str) -> str:
    """Return a signal's text in a legend: "actual thrust port [N]" for `actual_thrust_port_N`."""
    end = ""
    for bound in ("_low", "_high"):
        if name.endswith(bound):
            end = bound
    plain, unit = name.removesuffix(end), unit_of(name)
    if not unit:
        return f"{plain}{end}".replace("_", " ")
    stem = plain.rpartition("_")[0]
    return f"{stem}{end}".replace("_", " ") + f" [{unit}]"


def run_layout(scene: Scene, names: Sequence[str]) -> rrb.Blueprint:
    """Return the layout of rerun's viewer for a run: scene, velocities and tabs of other signals.

    Args:
        scene: What is drawn.
        names: Columns of the run.
    """
    turning = "Yaw and roll rate" if "p_radps" in names else "Yaw rate"
    speed = select_signals_and_goals(
        ("u_mps", "v_mps", "reference_u_mps", "reference_v_mps"), names
    )
    rate = select_signals_and_goals(("r_radps", "reference_r_radps", "p_radps"), names)
    return _layout(
        rrb.Vertical(
            _scene_view(scene, ["path", "camera"]),
            rrb.TextDocumentView(origin="norms", name="Metrics"),
            row_shares=[5, 3],
        ),
        _signal_plot("Surge and sway velocity", speed),
        _signal_plot(turning, rate),
        rrb.Tabs(*_signal_tabs(names)),
    )


def select_signals_and_goals(signals: Sequence[str], names: Iterable[str]) -> list[str]:
    """Select from column names those of given signals and of goals for these signals."""
    found: list[str] = []
    for name in names:
        is_goal = (
            name.startswith(GOAL) and measured_column_for_goal(name.removeprefix(GOAL)) in signals
        )
        if is_goal or name in signals:
            found.append(name)
    return found


def diagnosis_layout(
    scene: Scene,
    boats: Sequence[str],
    names: Iterable[str],
    missing: Mapping[str, object],
    span: tuple[float, float],
) -> rrb.Blueprint:
    """Return the layout of rerun's viewer for a diagnosis.

    It shows the view from above, the motion in tabs, and the missing force of each axis.

    Args:
        scene: What is drawn.
        boats: Names of recording and models.
        names: Columns of their motion.
        missing: Columns of the missing force.
        span: First and last time of all plots [s].
    """
    there = set(names)
    motion: list[rrb.TimeSeriesView] = []
    for name in MOTION:
        if name in there:
            curves = [f"{boat}/{name}" for boat in boats]
            motion.append(_signal_plot(TITLES.get(name, legend_text(name)), curves, span=span))
    forces: list[rrb.TimeSeriesView] = []
    for name, axis in MISSING.items():
        if name in missing:
            kind = "force [N]" if axis in ("surge", "sway", "heave") else "moment [N m]"
            curves = [name, f"{name}_low", f"{name}_high", f"{name}_flagged"]
            forces.append(_signal_plot(f"Missing {axis} {kind}", curves, "missing", span))
    length, width, x, y = scene.tank
    height = max(length / HIGH, width / WIDE)
    eye = (x - 0.15 * height, -y, height)
    if "x_m" not in there:  # a vessel that only rolls is seen from astern
        eye = (-1.2 * scene.length, 0.0, 0.4 * scene.length)
    size = f", drawn {scene.times:.2g} times their size" if scene.times > 1.0 else ""
    title = f"{scene.vessel}: {', '.join(boats)}{size}"
    view = _scene_view(scene, [f"paths/{boat}" for boat in boats], eye, title)
    return _layout(view, rrb.Tabs(*motion), *forces)


def comparison_layout(scene: Scene, boats: Mapping[str, Sequence[str]]) -> rrb.Blueprint:
    """Return the layout of rerun's viewer for a comparison of several runs.

    It shows the scene above the metrics, and a plot per signal.

    Args:
        scene: What is drawn.
        boats: Columns of each run by name.
    """
    names = list(dict.fromkeys(chain.from_iterable(boats.values())))

    def signal_plot(signal: str) -> rrb.TimeSeriesView:
        curves: list[str] = []
        for boat, own in boats.items():
            curves += [f"{boat}/{name}" for name in select_signals_and_goals([signal], own)]
        return _signal_plot(legend_text(signal), curves)

    motion = [n for n in (*RATES, *POSE) if n in names]
    motion.sort(
        key=lambda n: len(select_signals_and_goals([n], names)) < 2
    )  # those with a goal come first
    drives = [n for n in names if n.startswith("actual_")]
    eye = None
    if scene.open:
        length, width, x, y = scene.tank
        eye = (x - 0.2 * length, -y, 0.65 * max(length, width))
    trails = [f"paths/{boat}" for boat in boats]
    left = rrb.Vertical(
        _scene_view(scene, trails, eye, ", ".join(boats)),
        rrb.TextDocumentView(origin="norms", name="Metrics"),
        row_shares=[3, 2],
    )
    plots = [
        rrb.Tabs(*map(signal_plot, part)) for part in (motion[::2], motion[1::2], drives) if part
    ]
    return _layout(left, *plots)


def _layout(scene: rrb.View | rrb.Container, *plots: rrb.View | rrb.Container) -> rrb.Blueprint:
    return rrb.Blueprint(
        rrb.Horizontal(scene, rrb.Vertical(*plots), column_shares=[5, 4]),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE),
        auto_layout=False,
        auto_views=False,
    )


def _scene_view(
    scene: Scene,
    trails: Sequence[str],
    eye: tuple[float, float, float] | None = None,
    title: str = "",
) -> rrb.Spatial3DView:
    """The scene seen from astern and above, or from `eye`; trails end at the time cursor."""
    so_far = rrb.VisibleTimeRanges(
        timeline=TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    return rrb.Spatial3DView(
        origin=WORLD,
        name=title or f"{scene.vessel} in {'open water' if scene.open else 'its tank'}",
        background=SKY,
        line_grid=False,
        eye_controls=_following_eye() if scene.open and eye is None else _fixed_eye(scene, eye),
        overrides={f"{WORLD}/{trail}": so_far for trail in trails},
    )


def _following_eye() -> rrb.EyeControls3D:
    """An eye for open water that follows the vessel and begins with a view of its whole path."""
    return rrb.EyeControls3D(tracking_entity=f"{WORLD}/boat", eye_up=(0.0, 0.0, 1.0))


def _fixed_eye(scene: Scene, eye: tuple[float, float, float] | None) -> rrb.EyeControls3D:
    """An eye that looks at the middle of the tank, by default from astern and above."""
    length, width, x, y = scene.tank
    place = eye or (x - 0.6 * max(length, width), -y, 0.6 * max(length, width))
    return rrb.EyeControls3D(position=place, look_target=(x, -y, 0.0), eye_up=(0.0, 0.0, 1.0))


def _signal_tabs(names: Sequence[str]) -> list[rrb.View | rrb.Container]:
    """Plots of the signals other than velocities, by subject."""
    actual = [name for name in names if name.startswith("actual_")]
    sent = [name.removeprefix("actual_") for name in actual]
    drives = [*filter(set(names).__contains__, sent), *actual]

    def names_matching(pattern: str) -> list[str]:
        return [name for name in names if re.fullmatch(pattern, name)]

    groups = {
        "Thrust": [name for name in drives if "thrust" in name],
        "Steering": [name for name in drives if "thrust" not in name],
        "PWM": names_matching("pwm_.*"),
        "Estimates": names_matching("estimate_.*"),
        "Forces": names_matching("(force|wind)_.*_N"),
        "Yaw moments": names_matching("(force|wind)_.*_Nm"),
        "Heading": names_matching(".*psi_rad"),
        "Waves": names_matching("wave_elevation_m"),
        "Current": names_matching("water_(north|east)_mps"),
        "Position": select_signals_and_goals(("x_m", "y_m", "camera_x_m", "camera_y_m"), names),
    }
    return [_signal_plot(title, members) for title, members in groups.items() if members]


def _signal_plot(
    title: str, names: Sequence[str], under: str = SIGNALS, span: tuple[float, float] | None = None
) -> rrb.TimeSeriesView:
    axis = None
    if span:
        first, last = (rrb.TimeRangeBoundary.absolute(seconds=end) for end in span)
        axis = rrb.TimeAxis(view_range=rrb.TimeRange(start=first, end=last))
    return rrb.TimeSeriesView(
        origin="/",
        name=title,
        contents=[f"/{under}/{name}" for name in names],
        plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop),
        axis_x=axis,
    )


def _curve_colour(name: str, number: int) -> Colour:
    if name.endswith(("_low", "_high")):
        return GREY
    for side, light, dark in (
        ("port", (240, 150, 150), (200, 30, 40)),
        ("starboard", (140, 210, 140), (20, 130, 50)),
    ):
        if side in name.split("_"):
            return dark if name.startswith("actual_") else light
    if name.startswith(GOAL):
        return lighten_colour(
            _curve_colour(measured_column_for_goal(name.removeprefix(GOAL)) or "", number)
        )
    return FIXED.get(name, PALETTE[number % len(PALETTE)])


def lighten_colour(colour: Colour) -> Colour:
    """Return a colour halfway to white, in which a goal is drawn next to its signal."""
    red, green, blue = colour
    return (red + 255) // 2, (green + 255) // 2, (blue + 255) // 2
