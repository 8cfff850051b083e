"""Recordings of simulated runs with random commands, with an effect that the vessel's file lacks."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import boatsim
from boatsim.recordings.table import Recording


def simulated(
    vessel: str,
    commands: Mapping[str, tuple[float, float]],
    seed: int,
    effects: Sequence[Mapping[str, Any]] = (),
    duration: float = 60.0,
    hold: float = 3.0,
    measured: Mapping[str, float] | None = None,
) -> Recording:
    """What the camera of a run shows of a vessel under random commands.

    Args:
        vessel: Name of the vessel.
        commands: Range of each command.
        seed: Seed of commands and camera.
        effects: Effects in addition to the vessel's own.
        duration: Length of the recording [s].
        hold: Time for which a command is held [s].
        measured: Constant values of the vessel's measured quantities.
    """
    rng = np.random.default_rng(seed)
    goals = []
    for k in range(round(duration / hold)):
        goal = {name: float(rng.uniform(*bounds)) for name, bounds in commands.items()}
        goals.append({"from": k * hold, **goal})
    boat = boatsim.load_vessel(vessel)
    for effect in effects:
        boat = boat.with_effect(dict(effect))
    keys: dict[str, Any] = {"goal": goals, "duration": duration, "engine": "compiled"}
    keys["seed"] = seed
    if measured:
        keys["measured"] = dict(measured)
    scenario = boatsim.load_scenario("otter/turn", vessel=boat, **keys)
    camera = boatsim.run(scenario).camera
    return replace(camera, name=f"run_{seed}")
