"""Arguments of all environments, and the simulation that they define."""

from collections.abc import Mapping, Sequence
from typing import TypedDict, Unpack

from boatsim.errors import BadInput, unknown_name_message
from boatsim.learn.play import MakeWorld, TaskSimulation, make_batch_world
from boatsim.learn.tasks.names import TASKS
from boatsim.learn.variation import Variation, Vary, make_variation
from boatsim.simulate import scenario as scenarios
from boatsim.simulate.tank import Tank


class EnvironmentOptions(TypedDict, total=False):
    """Optional arguments of a learning environment, such as vessel, effects and durations."""

    vessel: str  # name or path, also of a patched.toml
    scenario: str  # instead of a vessel; its vessel, load, set values and effects are used
    load: Sequence[str]
    effects: Sequence[Mapping[str, object]]  # in addition to the vessel's, as [[effect]] tables
    # "effect.parameter" -> "uniform(low, high)" and so on; "load" -> a list, or lists by the name
    # of the vessel; "spread" -> a factor of the uncertainty that a diagnosis found
    vary: Vary
    settings: Mapping[str, object]  # parameters of the task, such as its tolerances
    period: float  # [s] of a control step
    step: float  # [s] of the integration
    duration: float  # [s] of an episode


def make_simulation(
    task: str, n: int, world: MakeWorld | None = None, **options: Unpack[EnvironmentOptions]
) -> TaskSimulation:
    """Return a simulation of n boats at a learning task, such as berthing.

    Args:
        task: Name of the task.
        n: Number of boats.
        world: Creates the simulator; None for a compiled batch in open water.
        options: Further arguments, see `EnvironmentOptions`.

    Raises:
        BadInput: An argument is unknown or wrong.
    """
    if task not in TASKS:
        raise BadInput(unknown_name_message("task", task, TASKS))
    known = EnvironmentOptions.__annotations__
    for key in options:
        if key not in known:
            raise BadInput(unknown_name_message(f"{task}: argument", key, list(known)))
    try:
        rules = TASKS[task].from_settings(options.get("settings", {}))
        varied, tank = _make_variation_and_tank(options)
        return TaskSimulation(
            rules,
            varied,
            n,
            period=options.get("period", 0.2),
            step=options.get("step", 0.1),
            duration=options.get("duration", 60.0),
            world=world or make_batch_world(),
            tank=tank,
        )
    except BadInput as error:
        raise BadInput(f"{task}: {error}") from None


def _make_variation_and_tank(options: EnvironmentOptions) -> tuple[Variation, Tank | None]:
    """Variation of the given vessel, or variation and tank of the given scenario."""
    vary = options.get("vary")
    if "scenario" in options:
        for key in ("load", "effects"):
            if key in options:
                raise BadInput(f"scenario and {key} are both given; a scenario has its own")
        file = scenarios.load(options["scenario"]).file
        varied = make_variation(file.vessel, file.load, file.effect, vary, file.set)
        if file.tank is None:
            return varied, None
        return varied, Tank(**file.tank.model_dump())
    if "vessel" not in options:
        raise BadInput("give a boat: vessel = its name, or scenario")
    load = options.get("load", ())
    return make_variation(options["vessel"], load, options.get("effects", ()), vary), None
