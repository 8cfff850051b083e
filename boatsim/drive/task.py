"""Task of a driver: a vessel in open water or in a scenario, and the file that repeats the run."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from boatsim.drive.stick_mapping import StickMappings, stick_mappings_for
from boatsim.errors import BadInput
from boatsim.files import Value
from boatsim.simulate.controllers import controller_table
from boatsim.simulate.scenario import Scenario, from_table
from boatsim.simulate.vessel_scenario import (
    REPEATED,
    Goals,
    environment_table,
    repeating_scenario,
    scenario_around_goals,
)

FILE = REPEATED
LONGEST = 3600.0  # [s] duration of a run that the driver does not end
# Step [s] for loading a scenario before its own step is known; it divides any control period.
SHORTEST = 1.01e-4
STEP = 0.02  # [s] largest integration step; shorter if the control period is
PASSED_ON = "open_loop"  # controller that passes the sticks to the channels


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
        offline: bool = False,
    ) -> None:
        """Load a task.

        Args:
            vessel: Name, folder or file of the vessel.
            scenario: Scenario that sets water, wind and start; None for open water.
            controller: Controller; None for that of the scenario, or none.
            load: Load conditions.
            seconds: Largest duration [s].
            offline: Whether the boat is simulated in the page, by the compiled engine.

        Raises:
            BadInput: A name is wrong, the sticks cannot steer the controller, or the page cannot
                simulate the scenario.
        """
        table, place = environment_table(vessel, scenario, load, "drive")
        table["controller"] = _controller_table(table.get("controller"), controller)
        table["duration"] = seconds
        loaded = from_table({"step": SHORTEST, **table}, place)
        if offline:
            _check_offline(loaded)
            table["engine"] = "compiled"
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
        return repeating_scenario(self._table, goals, duration)

    def scenario_around_goals(self) -> tuple[str, str]:
        """Return the text of that scenario file before and after its duration and goals."""
        return scenario_around_goals(self._table)


def _check_offline(scenario: Scenario) -> None:
    """Raise BadInput if a scenario needs more than the vessel's program, which a page can run."""
    file = scenario.file
    if file.tank:
        raise BadInput(
            f"{scenario.name} has a [tank]; the offline page has open water only, because walls "
            "need MuJoCo"
        )
    if file.controller["use"] != PASSED_ON:
        raise BadInput(
            f"controller {file.controller['use']} is written in Python, which the offline page "
            f"cannot run; --controller {PASSED_ON} lets the sticks set the channels"
        )


def _controller_table(own: Value, controller: str | None) -> Mapping[str, Value]:
    """The [controller] table: the given one, the scenario's, or one that passes commands on."""
    if controller is None:
        if isinstance(own, Mapping):
            return own
        return {"use": PASSED_ON}
    return controller_table(controller, own)
