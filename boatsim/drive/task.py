"""Task of a driver: a vessel in open water or in a scenario, and the file that repeats the run."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import starmap
from pathlib import Path

import tomlkit

from boatsim.drive.stick_mapping import StickMappings, stick_mappings_for
from boatsim.errors import BadInput
from boatsim.files import MAX_TOML_BYTES, Value
from boatsim.physics.content import find_content_file, shipped_content_names
from boatsim.simulate.cases import ScenarioLocation, find_scenarios, read_scenario
from boatsim.simulate.controllers import controller_table
from boatsim.simulate.scenario import OFF, Scenario, from_table

FILE = "scenario.toml"
LONGEST = 3600.0  # [s] duration of a run that the driver does not end
# Step [s] for loading a scenario before its own step is known; it divides any control period.
SHORTEST = 1.01e-4
STEP = 0.02  # [s] largest integration step; shorter if the control period is
PASSED_ON = "open_loop"  # controller that passes the sticks to the channels
# Keys of a scenario that define its own task.
TASK_KEYS = (
    "goal",
    "until",
    "measure",
    "norms",
    "noise_widens_guards",
    "check",
    "duration",
)
# Goals and the time [s] from which each applies; None while no driver holds the sticks.
Goals = Sequence[tuple[float, Mapping[str, float] | None]]


class DriveTask:
    """Scenario of a run that a driver steers, with its vessel and the mapping of the sticks.

    Attributes:
        vessel: The vessel.
        dials: Goals or channels that the sticks set.
        scenario: The scenario.
    """

    def __init__(
        self,
        vessel: str,
        scenario: str | None = None,
        controller: str | None = None,
        load: Sequence[str] = (),
        seconds: float = LONGEST,
    ) -> None:
        """Load a task.

        Args:
            vessel: Name, folder or file of the vessel.
            scenario: Scenario that sets water, wind and start; None for open water.
            controller: Controller; None for that of the scenario, or none.
            load: Load conditions.
            seconds: Largest duration [s].

        Raises:
            BadInput: A name is wrong, or the sticks cannot steer the controller.
        """
        table, place = _environment_table(vessel, scenario, load)
        table["controller"] = _controller_table(table.get("controller"), controller)
        table["duration"] = seconds
        loaded = from_table({"step": SHORTEST, **table}, place)
        self.vessel = loaded.vessel
        use = str(loaded.file.controller["use"])
        self.dials: StickMappings = stick_mappings_for(
            self.vessel, loaded.controller, Path(use).stem
        )
        self._table = {"step": min(STEP, loaded.controller.period), **table}
        water = ""
        if scenario:
            water = f", in {place.name}"
        self._table["about"] = f"{self.vessel.name} driven by hand{water}."
        self.scenario: Scenario = replace(
            from_table({**self._table, "goal": [{**self.dials.neutral}]}, place),
            name=f"{self.vessel.name}/drive",
            address="",
        )

    def scenario_with_address(self, folder: Path) -> Scenario:
        """Return the driven scenario with the address of its file in an output folder.

        Args:
            folder: Output folder.
        """
        return replace(self.scenario, address=str(folder.resolve() / FILE))

    def scenario_toml(self, goals: Goals, duration: float) -> str | None:
        """Return the text of a scenario file that repeats a driven run without the driver.

        Args:
            goals: Goals of the run.
            duration: Duration of the run [s].

        Returns:
            TOML text; None if it is larger than a scenario file may be.
        """
        table = {key: value for key, value in self._table.items() if key != "goal"}
        head = tomlkit.dumps({**table, "duration": duration})
        rows = "".join(map("  {},\n".format, starmap(_goal_row, goals)))
        # The goals are a top-level array, which must precede the first table.
        top, _, tables = head.partition("\n[")
        text = f"{top.rstrip()}\ngoal = [\n{rows}]\n"
        if tables:
            text += f"\n[{tables}"
        if len(text.encode()) > MAX_TOML_BYTES:
            return None
        return text


def _goal_row(t: float, goal: Mapping[str, float] | None) -> str:
    values = f"{OFF} = true"
    if goal is not None:
        values = ", ".join(f"{key} = {value!r}" for key, value in goal.items())
    return f"{{ from = {round(t, 9)!r}, {values} }}"


def _environment_table(
    vessel: str, scenario: str | None, load: Sequence[str]
) -> tuple[dict[str, Value], ScenarioLocation]:
    """Table of vessel, water and wind: those of a scenario without its own task, or open water."""
    path = find_content_file("vessel", vessel)
    if scenario is None:
        table: dict[str, Value] = {
            "vessel": _vessel_reference(vessel, path),
            "load": list(load),
            "sensors": {"ideal": True},
        }
        return table, ScenarioLocation(Path("drive"))
    own, place = read_scenario(_scenario_address(vessel, scenario))
    name = own.get("vessel")
    if (
        not isinstance(name, str)
        or find_content_file("vessel", name, place.path.parent).resolve() != path.resolve()
    ):
        raise BadInput(f"--scenario {scenario} is for {name}, not for {vessel}")
    table = {key: value for key, value in own.items() if key not in TASK_KEYS}
    if load:
        table["load"] = list(load)
    return table, place


def _vessel_reference(name: str, path: Path) -> str:
    """Name of a vessel of the library, or its absolute path."""
    if name in shipped_content_names("vessel"):
        return name
    return str(path.resolve())


def _scenario_address(vessel: str, scenario: str) -> str:
    """Address of a scenario given by name, by its name for this vessel, or by file."""
    own = f"{vessel}/{scenario}"
    if own in shipped_content_names("scenario"):
        return own
    found = find_scenarios(scenario)
    if len(found) > 1:
        raise BadInput(
            f"--scenario {scenario} matches {len(found)}: {', '.join(found[:3])} ...; name one"
        )
    return found[0]


def _controller_table(own: Value, controller: str | None) -> Mapping[str, Value]:
    """The [controller] table: the given one, the scenario's, or one that passes commands on."""
    if controller is None:
        if isinstance(own, Mapping):
            return own
        return {"use": PASSED_ON}
    return controller_table(controller, own)
