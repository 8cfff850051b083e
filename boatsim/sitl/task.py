"""Task of a run under an autopilot: a vessel in its surroundings, without a controller."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path

from boatsim.control.base import Controller
from boatsim.errors import BadInput
from boatsim.files import Value, array_of_tables
from boatsim.simulate.cases import ScenarioLocation
from boatsim.simulate.scenario import Scenario, from_table
from boatsim.simulate.vessel_scenario import (
    REPEATED,
    Goals,
    environment_table,
    repeating_scenario,
)
from boatsim.sitl.surroundings import Surroundings, surroundings_tables

STEP = 0.02  # [s] largest integration step; a longer frame is divided
LOG = 0.02  # [s] between two rows of the log; each change of the commands adds a row
PASSED_ON = "open_loop"  # controller of the scenario that repeats the run
NAME = "ardupilot"  # of the controller, on the page and in the metrics of the run
NEEDED = {"surge", "yaw"}  # degrees of freedom without which there is nothing to control


class SitlTask:
    """Vessel and surroundings of a run under an autopilot.

    Attributes:
        scenario: The scenario, with a controller that only stands in for the autopilot.
        folder_name: Name of the vessel, for the output folder.
    """

    def __init__(
        self,
        vessel: str,
        scenario: str | None = None,
        load: Sequence[str] = (),
        seconds: float = 3600.0,
        surroundings: Surroundings | None = None,
    ) -> None:
        """Load a task.

        Args:
            vessel: Name, folder or file of the vessel.
            scenario: Scenario that sets water, wind, waves, current and start; None for open water.
            load: Load conditions.
            seconds: Largest duration [s].
            surroundings: Wind, waves and current in addition.

        Raises:
            BadInput: A name or a value is wrong, or the vessel cannot surge and yaw.
        """
        label = "sitl"
        table, place = environment_table(vessel, scenario, load, label)
        table["controller"] = {"use": PASSED_ON}
        table["duration"] = seconds
        table.setdefault("step", STEP)
        table.setdefault("log", LOG)
        loaded = _loaded(table, place)
        if not set(loaded.vessel.dof) >= NEEDED:
            raise BadInput(
                f"{loaded.vessel.name} cannot surge and yaw; there is nothing to control"
            )
        settings, added = surroundings_tables(loaded.vessel, surroundings or Surroundings())
        _merge(table, settings, added)
        table["about"] = f"{loaded.vessel.name} under an autopilot."
        self._table = table
        found = _loaded(table, place)
        shown = found.file.model_copy(update={"controller": {"use": NAME}})
        self.scenario: Scenario = replace(
            found, name=f"{loaded.vessel.name}/sitl", address="", file=shown
        )

    def run_scenario(self, controller: Controller, folder: Path) -> Scenario:
        """Return the scenario of one run.

        Args:
            controller: Controller that passes on the commands of the autopilot.
            folder: Output folder, whose scenario file repeats the run.
        """
        address = str(folder.resolve() / REPEATED)
        return replace(self.scenario, controller=controller, address=address)

    def repeating_scenario(self, commands: Goals, duration: float, frame: float) -> str:
        """Return the text of a scenario file that repeats a run without the autopilot.

        Args:
            commands: Commands and the time [s] from which each applies.
            duration: Duration of the run [s].
            frame: Length of a frame [s]; the shortest one if they differ.

        Returns:
            TOML text, without commands if these are too many for a scenario file.
        """
        step = frame / ceil(frame / self.scenario.file.step - 1e-9)
        table: dict[str, Value] = {**self._table, "step": step}
        table["controller"] = {"use": PASSED_ON, "period": frame}
        begun = [(t, values) for t, values in commands if t < duration]
        text = repeating_scenario(table, begun, duration)
        return text or repeating_scenario(table, [], duration) or ""


def _loaded(table: Mapping[str, Value], place: ScenarioLocation) -> Scenario:
    """The scenario of a table; its controller is not used, so that it may have any step."""
    without: dict[str, Value] = {**table, "controller": {"use": PASSED_ON, "period": 10.0}}
    return from_table(without, place)


def _merge(
    table: dict[str, Value],
    settings: Mapping[str, Mapping[str, float]],
    added: Sequence[Mapping[str, Value]],
) -> None:
    """Put the changes of `surroundings_tables` into the table of a scenario."""
    measured = settings.get("measured", {})
    if measured:
        table["measured"] = {**_table_in(table, "measured"), **measured}
    effects = array_of_tables(table.get("effect", []))
    by_name = {str(effect.get("name", effect["use"])): effect for effect in effects}
    changed = _table_in(table, "set")
    for name, values in settings.items():
        if name in by_name:
            by_name[name].update(values)
        elif name != "measured":
            changed[name] = {**_table_in(changed, name), **values}
    if changed:
        table["set"] = changed
    if effects or added:
        table["effect"] = [*effects, *added]


def _table_in(table: Mapping[str, Value], key: str) -> dict[str, Value]:
    found = table.get(key)
    if isinstance(found, Mapping):
        return dict(found)
    return {}
