"""Scenarios of a vessel whose commands come from outside: water and start of another scenario."""

from collections.abc import Mapping, Sequence
from itertools import starmap
from pathlib import Path

import tomlkit

from boatsim.errors import BadInput
from boatsim.files import MAX_TOML_BYTES, Value
from boatsim.physics.content import find_content_file, shipped_content_names
from boatsim.simulate.cases import ScenarioLocation, find_scenarios, read_scenario
from boatsim.simulate.scenario import OFF

REPEATED = "scenario.toml"  # file in the folder of a run that repeats the run by itself
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
# Goals and the time [s] from which each applies; None while the controller is off.
Goals = Sequence[tuple[float, Mapping[str, float] | None]]


def environment_table(
    vessel: str, scenario: str | None, load: Sequence[str], label: str
) -> tuple[dict[str, Value], ScenarioLocation]:
    """Return the table of a vessel in the water, wind and start of a scenario, or in open water.

    The task of the scenario (goals, duration, metrics) is not part of it.

    Args:
        vessel: Name, folder or file of the vessel.
        scenario: Name or file of the scenario; None for open water.
        load: Load conditions; empty for those of the scenario.
        label: Name of the table without a scenario, for messages.

    Raises:
        BadInput: There is no such vessel or scenario, or the scenario is for another vessel.
    """
    path = find_content_file("vessel", vessel)
    if scenario is None:
        table: dict[str, Value] = {
            "vessel": _vessel_reference(vessel, path),
            "load": list(load),
            "sensors": {"ideal": True},
        }
        return table, ScenarioLocation(Path(label))
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


def repeating_scenario(table: Mapping[str, Value], goals: Goals, duration: float) -> str | None:
    """Return the text of a scenario file that repeats a run by its goals.

    Args:
        table: Content of the scenario without goals.
        goals: Goals of the run.
        duration: Duration of the run [s].

    Returns:
        TOML text; None if it is larger than a scenario file may be.
    """
    top, tables = scenario_around_goals(table)
    rows = "".join(map("  {},\n".format, starmap(_goal_row, goals)))
    text = f"{top}duration = {duration!r}\ngoal = [\n{rows}]\n{tables}"
    if len(text.encode()) > MAX_TOML_BYTES:
        return None
    return text


def scenario_around_goals(table: Mapping[str, Value]) -> tuple[str, str]:
    """Return the text of a scenario file before and after its duration and goals.

    The goals are a top-level array, which must precede the first table.

    Args:
        table: Content of the scenario; its goals and duration are left out.
    """
    rest = {key: value for key, value in table.items() if key not in ("goal", "duration")}
    top, _, tables = tomlkit.dumps(rest).partition("\n[")
    if tables:
        tables = f"\n[{tables}"
    return f"{top.rstrip()}\n", tables


def _goal_row(t: float, goal: Mapping[str, float] | None) -> str:
    values = f"{OFF} = true"
    if goal is not None:
        values = ", ".join(f"{key} = {value!r}" for key, value in goal.items())
    return f"{{ from = {round(t, 9)!r}, {values} }}"
