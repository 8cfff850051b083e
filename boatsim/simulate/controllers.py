"""Scenarios with another controller than their own, checked before they run."""

from collections.abc import Mapping
from typing import Any

from boatsim.control.base import Sense
from boatsim.errors import BadInput
from boatsim.physics.content import find_content_file, load_class, shipped_content_names
from boatsim.physics.vessel import Vessel
from boatsim.simulate.cases import read_scenario
from boatsim.simulate.control_loop import controller_error
from boatsim.simulate.scenario import Scenario, from_table, load


def load_with_controller(
    given: str,
    controller: str | None = None,
    vessel: Vessel | None = None,
    changes: Mapping[str, object] | None = None,
) -> Scenario:
    """Load a scenario with its own controller or with another one in its place.

    Args:
        given: Name or path of the scenario.
        controller: Name of a controller, or path of its .py, which may run because the user names
            it. Another controller has its default settings; the scenario's own keeps its settings.
        vessel: Vessel in place of the scenario's.
        changes: Top-level keys of the scenario that are replaced.

    Raises:
        BadInput: If scenario, controller and vessel do not fit each other.
    """
    if controller is None:
        return load(given, changes, vessel)
    said, place = read_scenario(given)
    table: dict[str, object] = {**said, **(changes or {})}
    own = table.get("controller")
    wanted = controller_table(controller, own)
    if wanted is own:
        return from_table(table, place, vessel)
    try:
        found = from_table({**table, "controller": wanted}, place, vessel)
        _try_each_goal(found)
    except BadInput as error:
        raise BadInput(f"controller {controller} does not fit {place.name}: {error}") from None
    return found


def controller_table(controller: str, own: object) -> Mapping[str, Any]:
    """Return the table [controller] of a scenario file for a controller with default settings.

    The scenario's own table is returned if it is of this controller.

    Args:
        controller: Name of a controller, or path of its .py, which may run because the user names
            it.
        own: The scenario's [controller] table, which is returned if it is of this controller.

    Raises:
        BadInput: There is no such controller.
    """
    load_class("controller", controller, named=True)
    use = (
        controller
        if controller in shipped_content_names("controller")
        else str(find_content_file("controller", controller))
    )
    if isinstance(own, Mapping) and own.get("use") == use:
        return own
    return {"use": use}


def _try_each_goal(scenario: Scenario) -> None:
    """Let the controller act once under each goal, for a vessel at rest, to find missing goals."""
    readings = {n: 0.0 for sensor in scenario.additional_sensors for n in type(sensor).columns}
    at_rest = dict.fromkeys(("psi", "r", "ax", "ay", "u", "v", "x", "y", "phi", "p"), 0.0)
    for goal in scenario.file.goal or [{}]:
        t = float(begin) if isinstance(begin := goal.get("from", 0.0), float) else 0.0
        scenario.controller.reset()
        try:
            scenario.controller.step(Sense(t, **at_rest, more=readings), scenario.goal_at(t))
        except KeyError as error:
            if error.args and error.args[0] in type(scenario.controller).goals:
                raise BadInput(controller_error(error, scenario.controller)) from None
        except Exception:  # a run reports other errors; this one may be due to the artificial state
            continue
    scenario.controller.reset()
