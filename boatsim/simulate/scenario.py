"""Scenarios: vessel, water, start, controller, goals, duration and evaluation of a run."""

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise
from math import degrees, pi, sin, sqrt
from pathlib import Path
from typing import Annotated, Literal, Self, TypeVar

import numpy as np
from pydantic import Field, field_validator, model_validator

from boatsim.arguments import check_instance, checked_name
from boatsim.control.base import Controller
from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Table, validate_table
from boatsim.physics import vessel as vessels
from boatsim.physics.content import load_class
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import STATE, Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate import tracking_errors
from boatsim.simulate.camera import Camera, make_camera
from boatsim.simulate.camera_metric import CameraMetricSet
from boatsim.simulate.cases import ScenarioLocation, read_scenario
from boatsim.simulate.metric import MetricSet
from boatsim.simulate.sensing import Sensor, Sensors
from boatsim.simulate.vessel_model import introduce_vessel

T = TypeVar("T")
M = TypeVar("M", Controller, MetricSet, Sensor)
# key of a [[goal]] during which commands are neutral; the controller is reset at its end
OFF = "off"
RESERVED = ("from", OFF)  # keys of a [[goal]] that are not goals
# limit of a band, which may be infinite
End = Annotated[float, Field(allow_inf_nan=True)]
GOAL_TOLERANCE = 1e-9  # [s] by which rounding may shift the begin of a goal
FASTEST_FROUDE = 10.0  # of a goal: no boat reaches it, so that its unit is another one


class TankTable(Table):
    """Table [tank] of a scenario file: water with walls; without this table the water is open."""

    length: float = Field(gt=0)  # [m] along the start heading
    width: float = Field(gt=0)  # [m]
    depth: float = Field(default=1.0, gt=0)  # [m]
    centre: tuple[float, float] = (0.0, 0.0)  # [m] from the start, ahead and to starboard


class StartTable(Table):
    """Table [start] of a scenario file: pose, velocities and commands at the start, SNAME."""

    x: float = 0.0  # [m]
    y: float = 0.0  # [m]
    psi: float = 0.0  # [rad]
    phi: float = 0.0  # [rad]
    u: float = 0.0  # [m/s]
    v: float = 0.0  # [m/s]
    p: float = 0.0  # [rad/s]
    r: float = 0.0  # [rad/s]
    z: float = 0.0  # [m]
    theta: float = 0.0  # [rad]
    w: float = 0.0  # [m/s]
    q: float = 0.0  # [rad/s]
    # at which the actuators are settled; others are the controller's initial ones, or neutral
    commands: dict[str, float] = {}

    def initial_state_values(self) -> dict[str, float]:
        """Return pose and velocities at the start, keyed by their symbols in the engine's state."""
        return {s.symbol: float(getattr(self, s.symbol)) for s in STATE}


class UntilTable(Table):
    """Table [until] of a scenario file: conditions that end the run early once one is reached."""

    starboard: float | None = Field(default=None, gt=0)  # [m] travelled to starboard of the start
    turned: float | None = Field(default=None, gt=0)  # [rad] turned either way


class MetricTable(Table):
    """Published value of a metric in a scenario file, and the regression band around its value."""

    published: float | None = None
    # of the published value, to either side, as the publication states it
    tolerance: float | None = Field(default=None, gt=0)
    guard: tuple[End, End] | None = None  # regression band: low, high
    unit: str | None = None  # of these values; None: that of the metric

    def unit_factor(self, unit: str) -> float:
        """Return the factor from the stated unit of the values to the unit of the metric.

        Args:
            unit: Unit of the metric.

        Raises:
            BadInput: The stated unit is another one. Radians may stand for degrees.
        """
        if self.unit in (None, unit):
            return 1.0
        radians = unit.replace("deg", "rad")
        if self.unit == radians:
            return degrees(1.0)
        allowed = " or ".join(f'"{one}"' for one in dict.fromkeys((unit, radians)))
        raise BadInput(f'unit = "{self.unit}"; allowed is {allowed}')

    @model_validator(mode="after")
    def _check_order(self) -> Self:
        if self.guard is not None and not self.guard[0] <= self.guard[1]:
            raise ValueError(
                f"guard = {list(self.guard)}; allowed are its lower end and its upper one"
            )
        if self.tolerance is not None and self.published is None:
            raise ValueError("tolerance needs published")
        return self


class CheckTable(Table):
    """Table [[check]] of a scenario file: an upper bound of the norm of a logged signal."""

    signal: str
    norm: Literal["inf", "rms", "l2", "l1"]
    below: float = Field(gt=0)
    source: str = ""


class CourseTable(Table):
    """Goal in a scenario file that changes with the time tau [s] since it began.

    The goal is mean + slope tau + amplitude sin(2 pi tau / period).
    """

    mean: float = 0.0
    slope: float = 0.0  # [1/s]
    amplitude: float = 0.0
    period: float = Field(default=1.0, gt=0)  # [s]

    def goal_value(self, tau: float) -> float:
        """Return the value of a time-varying goal at the time tau [s] since it began."""
        return self.mean + self.slope * tau + self.amplitude * sin(2.0 * pi * tau / self.period)


class ScenarioFile(Table):
    """Validated content of a scenario file (TOML), with the defaults of all keys."""

    about: str = ""
    vessel: str
    load: list[str] = []
    duration: float = Field(gt=0, le=86400)  # [s]
    step: float = Field(default=0.02, gt=1e-4, le=1.0)  # [s]
    seed: int = Field(default=0, ge=0)
    # the compiled engine works in open water; "twin" is its old name
    engine: Literal["mujoco", "compiled", "twin"] = "mujoco"
    tank: TankTable | None = None
    start: StartTable = StartTable()
    until: UntilTable = UntilTable()
    controller: dict[str, object]
    sensors: dict[str, object] = {}
    sensor: list[dict[str, object]] = []  # in addition to the usual ones
    camera: dict[str, object] = {}
    goal: list[dict[str, float | CourseTable]] = []
    set: dict[str, dict[str, object]] = {}
    effect: list[dict[str, object]] = []
    # constant values of the vessel's measured channels, such as the wind
    measured: dict[str, float] = {}
    measure: str | dict[str, object] | None = None
    log: float = Field(default=0.0, ge=0)  # [s] between rows of the log; 0: every step
    norms: dict[str, MetricTable] = {}
    noise_widens_guards: bool = False
    check: list[CheckTable] = []

    @field_validator("goal", mode="before")
    @classmethod
    def _number_of_off(cls, tables: object) -> object:
        """The goals with `off = true` as a number, the only truth value among them."""
        if not isinstance(tables, list):
            return tables
        found: list[object] = []
        for table in tables:
            if isinstance(table, dict) and isinstance(table.get(OFF), bool):
                table = table | {OFF: float(table[OFF])}
            found.append(table)
        return found

    @property
    def is_compiled(self) -> bool:
        """Whether the scenario is simulated by the compiled engine instead of MuJoCo."""
        return self.engine != "mujoco"


@dataclass(frozen=True)
class Scenario:
    """A scenario ready to run: its file, vessel, controller, sensors, camera and metric set."""

    name: str
    file: ScenarioFile
    vessel: Vessel
    controller: Controller
    sensors: Sensors
    camera: Camera
    measure: MetricSet | None = None
    additional_sensors: tuple[Sensor, ...] = ()
    address: str = ""  # what it is found by again

    @classmethod
    def from_settings(
        cls, *, vessel: Vessel, name: str = "scenario", **settings: object
    ) -> "Scenario":
        """Build a scenario from Python values of the keys of a scenario file.

        Args:
            vessel: The vessel.
            name: Name of the scenario.
            settings: Keys of a scenario file, such as `duration`, `controller` and `goal`.

        Raises:
            BadInput: For keys and values that are not allowed.
        """
        check_instance("vessel", vessel, Vessel, "a Vessel")
        name = checked_name("name", name)
        return from_table(settings, ScenarioLocation(Path(f"{name}.toml")), vessel)

    @cached_property
    def _goal_begin_times(self) -> list[float]:
        return [_goal_begin_time(g) for g in self.file.goal]

    @cached_property
    def _split_goals(self) -> list[tuple[dict[str, float], dict[str, CourseTable]]]:
        """Constant and time-varying values of each [[goal]]."""
        goals: list[tuple[dict[str, float], dict[str, CourseTable]]] = []
        for goal in self.file.goal:
            constant: dict[str, float] = {}
            courses: dict[str, CourseTable] = {}
            for key, value in goal.items():
                if isinstance(value, CourseTable):
                    courses[key] = value
                elif key != "from":
                    constant[key] = value
            goals.append((constant, courses))
        return goals

    @property
    def goal_keys(self) -> list[str]:
        """Keys of all goals of the scenario, such as `u_mps`, in the order of the file."""
        keys: list[str] = []
        for goal in self.file.goal:
            keys += [key for key in goal if key not in RESERVED]
        return list(dict.fromkeys(keys))

    @property
    def has_off_goal(self) -> bool:
        """Whether the controller is off during a part of the scenario, by a goal `off = true`."""
        return any(goal.get(OFF) for goal in self.file.goal)

    def goal_at(self, t: float) -> Mapping[str, float]:
        """Return the controller's goals at a time, from the last [[goal]] that has begun.

        Args:
            t: Time [s].

        Returns:
            Value of each goal by its name; empty before the first [[goal]].
        """
        at = bisect_right(self._goal_begin_times, t + GOAL_TOLERANCE) - 1
        if at < 0:
            return {}
        constant, courses = self._split_goals[at]
        if not courses:
            return constant
        tau = t - self._goal_begin_times[at]
        return {**constant, **{key: course.goal_value(tau) for key, course in courses.items()}}

    def goal_spans(self, times: Array) -> Iterator[tuple[slice, Mapping[str, float]]]:
        """Yield the goals over ascending times: ranges of equal goals, and the goals.

        Args:
            times: Times (N,) [s].
        """
        changes = np.searchsorted(times + GOAL_TOLERANCE, self._goal_begin_times)
        bounds = sorted({0, *changes.tolist(), len(times)})
        for begin, end in pairwise(bounds):
            at = bisect_right(self._goal_begin_times, times[begin] + GOAL_TOLERANCE) - 1
            if at >= 0 and self._split_goals[at][1]:
                for row in range(begin, end):
                    yield slice(row, row + 1), self.goal_at(float(times[row]))
            else:
                yield slice(begin, end), self.goal_at(float(times[begin]))


def load(
    name: str, overrides: Mapping[str, object] | None = None, vessel: Vessel | None = None
) -> Scenario:
    """Load a scenario from its file, with optional changes.

    Args:
        name: Name ("vessel/case") or path ("my.toml", "my.toml:case").
        overrides: Top-level keys of the file that are replaced.
        vessel: Vessel in place of the scenario's; see `from_table`.

    Raises:
        BadInput: One line with file, key, value found, what is allowed and the nearest valid name.
    """
    table, place = read_scenario(name)
    return from_table({**table, **(overrides or {})}, place, vessel)


def from_table(
    raw: Mapping[str, object], place: ScenarioLocation, vessel: Vessel | None = None
) -> Scenario:
    """Return a scenario that is ready to run from the content of a scenario file.

    Args:
        raw: Content of the file.
        place: Name of the scenario, and the file from which relative paths start.
        vessel: Vessel in place of the scenario's, in its own load condition; [set], [[effect]] and
            [measured] of the scenario apply to it.

    Raises:
        BadInput: One line with file, key, value found, what is allowed and the nearest valid name.
    """
    label, path = place.label, place.path
    if vessel is not None:
        raw = {**raw, "vessel": vessel.name, "load": list(vessel.load)}
    file = validate_table(ScenarioFile, raw, label)
    try:
        vessel = _scenario_vessel(file, path.parent, vessel)
        controller = _create_content(Controller, "controller", file.controller, path.parent)
        sensors = _create_with_context("sensors", lambda: Sensors.from_settings(file.sensors))
        aboard = _additional_sensors(file.sensor, path.parent)
        camera = _create_with_context("camera", lambda: make_camera(vessel, file.camera))
        measure = _load_metric_set(file.measure, path.parent)
        introduce_vessel(controller, vessel)
        _check_goals(file, vessel, controller)
        _check_shape(file, controller)
        _check_metrics(file, camera, measure)
    except BadInput as error:
        raise BadInput(f"{label}: {error}") from None
    return Scenario(
        name=place.name,
        file=file,
        vessel=vessel,
        controller=controller,
        sensors=sensors,
        camera=camera,
        measure=measure,
        additional_sensors=aboard,
        address=place.address,
    )


def _scenario_vessel(file: ScenarioFile, folder: Path, vessel: Vessel | None) -> Vessel:
    """The scenario's vessel, or another one, with the changes that the scenario makes."""
    if vessel is None:
        vessel = vessels.load_vessel(file.vessel, file.load, file.set, file.effect, folder)
        return vessel.with_measured(file.measured)
    if file.set:
        vessel = vessel.with_parameters(file.set)
    for table in file.effect:
        vessel = vessel.with_effect(vessels.effect_from_table(table, vessel.name, folder))
    return vessel.with_measured(file.measured)


def _create_content(base: type[M], kind: str, table: Mapping[str, object], folder: Path) -> M:
    """Create the controller, metric set or sensor that a table asks for."""
    use = table.get("use")
    if not isinstance(use, str):
        raise BadInput(f"[{kind}] needs use = its name")
    found: type[M] = load_class(kind, use, folder)
    return found.from_settings({k: v for k, v in table.items() if k != "use"})


def _additional_sensors(tables: Sequence[Mapping[str, object]], folder: Path) -> tuple[Sensor, ...]:
    """The sensors of the [[sensor]] tables, which must have different readings."""
    sensors: list[Sensor] = []
    for table in tables:
        sensor = _create_content(Sensor, "sensor", table, folder)
        for other in sensors:
            if twice := [name for name in type(other).columns if name in type(sensor).columns]:
                raise BadInput(
                    f"[[sensor]] {table['use']}: {twice[0]} is read by another sensor already"
                )
        sensors.append(sensor)
    return tuple(sensors)


def _load_metric_set(given: str | Mapping[str, object] | None, folder: Path) -> MetricSet | None:
    """The metric set of a scenario."""
    if given is None:
        return None
    table = {"use": given} if isinstance(given, str) else given
    return _create_content(MetricSet, "measure", table, folder)


def _goal_begin_time(goal: Mapping[str, float | CourseTable]) -> float:
    """Time at which a goal begins [s]."""
    begin = goal.get("from", 0.0)
    if isinstance(begin, CourseTable):
        raise BadInput("[[goal]] from is a table; allowed is a time in s")
    return begin


def _create_with_context(key: str, create: Callable[[], T]) -> T:
    """Create sensors or camera; an error names the table."""
    try:
        return create()
    except BadInput as error:
        raise BadInput(f"[{key}] {error}") from None


def _check_goals(file: ScenarioFile, vessel: Vessel, controller: Controller) -> None:
    """Check that the controller knows the goals, or that they are the vessel's command channels."""
    allowed = type(controller).goals or tuple(vessel.commands)
    for goal in file.goal:
        for key in goal:
            if key not in RESERVED and key not in allowed:
                raise BadInput(unknown_name_message("[[goal]] key", key, [*RESERVED, *allowed]))
            channel, value = vessel.commands.get(key), goal[key]
            if channel and isinstance(value, float) and not channel.low <= value <= channel.high:
                raise BadInput(
                    f"[[goal]] {key} = {value:g}; allowed {channel.low:g} to {channel.high:g}"
                )
            if not channel and isinstance(value, float):
                _check_goal_size(key, value, vessel.length)
    starts = [_goal_begin_time(g) for g in file.goal]
    if starts != sorted(starts):
        raise BadInput(f"[[goal]] from = {starts}; allowed are times in ascending order")
    if starts and starts[-1] >= file.duration:
        raise BadInput(
            f"[[goal]] from = {starts[-1]:g} s; the run ends at duration = {file.duration:g} s"
        )
    if unknown := [c for c in controller.channels() if c not in vessel.commands]:
        raise BadInput(
            f"controller {file.controller['use']} sets {unknown[0]}; "
            f"{vessel.unknown_command_message(unknown[0])}"
        )


def _check_goal_size(key: str, value: float, length: float) -> None:
    """Check that a goal is not far beyond what any boat does, as it is in a wrong unit."""
    speed = FASTEST_FROUDE * sqrt(GRAVITY * length)
    limits = {"_mps": speed, "_radps": speed / length, "_rad": 2.0 * pi}
    for ending, most in limits.items():
        if key.endswith(ending) and abs(value) > most:
            raise BadInput(f"[[goal]] {key} = {value:g}; allowed {-most:.3g} to {most:.3g}")


def _check_shape(file: ScenarioFile, controller: Controller) -> None:
    """Check that the start lies in the tank and the controller's period is at least one step."""
    if controller.period < file.step - 1e-12:
        raise BadInput(
            f"step = {file.step:g} s; "
            f"allowed is at most the controller's period, {controller.period:g} s"
        )
    if file.tank and file.is_compiled:
        raise BadInput(
            f'engine = "{file.engine}" with a [tank]; the compiled engine has open water only, '
            "walls need MuJoCo"
        )
    if file.tank:
        dx, dy = file.start.x - file.tank.centre[0], file.start.y - file.tank.centre[1]
        if abs(dx) > file.tank.length / 2 or abs(dy) > file.tank.width / 2:
            raise BadInput(
                f"start x, y = {file.start.x:g}, {file.start.y:g} m lies outside the tank"
            )


def _check_metrics(file: ScenarioFile, camera: Camera, measure: MetricSet | None) -> None:
    """Check that the metrics with bands are computed and that the camera delivers their frames."""
    units = tracking_errors.error_units(chain.from_iterable(file.goal))
    if measure:
        units = {name: measure.unit(name) for name in type(measure).units} | units
    for name, table in file.norms.items():
        if name not in units:
            raise BadInput(unknown_name_message("[norms] key", name, units))
        try:
            table.unit_factor(units[name])
        except BadInput as error:
            raise BadInput(f"[norms.{name}] {error}") from None
    if isinstance(measure, CameraMetricSet):
        measure.check_camera(camera)


__all__ = [
    "CheckTable",
    "MetricTable",
    "Scenario",
    "ScenarioFile",
    "UntilTable",
    "from_table",
    "load",
]
