"""A scenario steered by another controller than its own, and whether that one fits, told before anything runs."""

from collections.abc import Mapping

from boatsim.control.base import Sense
from boatsim.errors import BadInput
from boatsim.physics.content import find, load_class, names
from boatsim.simulate.cases import content
from boatsim.simulate.run import what_went_wrong
from boatsim.simulate.scenario import Scenario, from_table, load


def steered(given: str, controller: str | None = None) -> Scenario:
    """A scenario by name or path, steered by its own controller, or by another one with that one's defaults.

    A controller is given by name or by the path of its .py; named by the user, it may run. Where it is the scenario's
    own, the scenario's settings of it stay. Raises BadInput.
    """
    if controller is None:
        return load(given)
    load_class("controller", controller, named=True)
    use = controller if controller in names("controller") else str(find("controller", controller))
    said, place = content(given)
    own = said.get("controller")
    if isinstance(own, Mapping) and own.get("use") == use:
        return from_table(said, place)
    try:
        found = from_table({**said, "controller": {"use": use}}, place)
        _rehearse(found)
    except BadInput as error:
        raise BadInput(f"controller {controller} does not fit {place.name}: {error}") from None
    return found


def _rehearse(scenario: Scenario) -> None:
    """One step of the controller under each of its goals, of a boat at rest. Raises BadInput for a goal it misses."""
    readings = {n: 0.0 for sensor in scenario.aboard for n in type(sensor).columns}
    at_rest = dict.fromkeys(("psi", "r", "ax", "ay", "u", "v", "x", "y", "phi", "p"), 0.0)
    for goal in scenario.file.goal or [{}]:
        t = float(begin) if isinstance(begin := goal.get("from", 0.0), float) else 0.0
        scenario.controller.reset()
        try:
            scenario.controller.step(Sense(t, **at_rest, more=readings), scenario.goal_at(t))
        except KeyError as error:
            if error.args and error.args[0] in type(scenario.controller).goals:
                raise BadInput(what_went_wrong(error, scenario.controller)) from None
        except Exception:  # of a boat that never was; what goes wrong in a run is told there
            continue
    scenario.controller.reset()
