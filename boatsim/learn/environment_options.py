"""Arguments of all environments, and the simulation that they define."""

from collections.abc import Mapping, Sequence
from typing import TypedDict, Unpack

from boatsim.errors import BadInput, unknown_name
from boatsim.learn.play import Made, Play, open_water
from boatsim.learn.tasks.base import Task
from boatsim.learn.tasks.berth import Berth
from boatsim.learn.tasks.follow_path import FollowPath
from boatsim.learn.tasks.hold_station import HoldStation
from boatsim.learn.tasks.joystick import Joystick
from boatsim.learn.variation import Variation, Vary, variation
from boatsim.simulate import scenario as scenarios
from boatsim.simulate.world import Tank

TASKS: Mapping[str, type[Task]] = {
    task.idea(): task for task in (Berth, HoldStation, FollowPath, Joystick)
}


class Told(TypedDict, total=False):
    """Optional arguments of an environment."""

    vessel: str  # by name or path, a patched.toml too
    scenario: str  # in its place: vessel, load, set values and effects are this one's
    load: Sequence[str]
    effects: Sequence[Mapping[str, object]]  # on top of the vessel's own, as [[effect]] tables
    # "effect.number" -> "uniform(low, high)", ...; "load" -> a list; "spread" -> factor of a
    # diagnosis'
    vary: Vary
    settings: Mapping[str, object]  # of the task: its tolerances
    period: float  # [s] of a control step
    step: float  # [s] of the integration
    duration: float  # [s] of an episode


def play(task: str, n: int, world: Made | None = None, **told: Unpack[Told]) -> Play:
    """Return a simulation of n boats at a task.

    Args:
        task: Name of the task.
        n: Number of boats.
        world: Creates the simulator; None for a compiled batch in open water.
        told: Further arguments, see `Told`.

    Raises:
        BadInput: An argument is unknown or wrong.
    """
    if task not in TASKS:
        raise BadInput(unknown_name("task", task, TASKS))
    if unknown := [key for key in told if key not in Told.__annotations__]:
        raise BadInput(unknown_name(f"{task}: argument", unknown[0], list(Told.__annotations__)))
    try:
        rules = TASKS[task].from_settings(told.get("settings", {}))
        varied, tank = _boats(told)
        times = (told.get("period", 0.2), told.get("step", 0.1), told.get("duration", 60.0))
        return Play(rules, varied, n, *times, world or open_water(), tank)
    except BadInput as error:
        raise BadInput(f"{task}: {error}") from None


def _boats(told: Told) -> tuple[Variation, Tank | None]:
    """Variation of the given vessel, or of that of a scenario, and the tank of the scenario."""
    if "scenario" in told:
        if clash := [key for key in ("load", "effects") if key in told]:
            raise BadInput(f"scenario and {clash[0]} are both given; a scenario has its own")
        file = scenarios.load(told["scenario"]).file
        varied = variation(file.vessel, file.load, file.effect, told.get("vary"), file.set)
        return varied, Tank(**file.tank.model_dump()) if file.tank else None
    if "vessel" not in told:
        raise BadInput("give a boat: vessel = its name, or scenario")
    return variation(
        told["vessel"], told.get("load", ()), told.get("effects", ()), told.get("vary")
    ), None
