"""Controllers at a task: each boat has its own controller, which receives its true motion."""

from collections.abc import Callable, Mapping, Sequence
from math import nan
from typing import Protocol

import numpy as np

from boatsim.control.base import Sense
from boatsim.errors import BadInput
from boatsim.learn.episode_random import Seeds
from boatsim.learn.play import Flags, Step, TaskSimulation
from boatsim.physics.signals import Array


class Pilot(Protocol):
    """Interface of a controller that steers one boat through a learning task."""

    def step(self, sense: Sense) -> Mapping[str, float]:
        """Return a controller's commands for the next control step, by channel.

        Channels that are not named are neutral.

        Args:
            sense: True motion of the boat.
        """


def run_episodes(
    play: TaskSimulation, seeds: Seeds, make_pilot: Callable[[Array], Pilot]
) -> dict[str, Array]:
    """Run one episode of a learning task for each boat, steered by a controller.

    Args:
        play: The simulation of n boats.
        seeds: Seeds (n,) of the episodes.
        make_pilot: Creates the controller of a boat from the goal (`goals`,) of its episode.

    Returns:
        Metrics (n,) of the episodes by name.

    Raises:
        BadInput: A controller sends a command that the vessel does not have.
    """
    play.begin_episodes(seeds, np.arange(play.n))
    pilots = [make_pilot(goal) for goal in play.goals]
    commands = play.commands.copy()

    def step(running: Flags) -> Step:
        times = play.t
        motions = np.column_stack(play.motion).tolist()
        for boat in np.flatnonzero(running).tolist():
            sent = pilots[boat].step(_sense(float(times[boat]), motions[boat]))
            commands[boat] = _command_row(sent, play)
        return play.step_commands(commands)

    return play_to_end(play, step)


def play_to_end(play: TaskSimulation, step: Callable[[Flags], Step]) -> dict[str, Array]:
    """Simulate until the first episode of every boat has ended.

    Args:
        play: The simulation of n boats, whose episodes have begun.
        step: Simulates one control step; it gets whether the first episode of each boat (n,) lasts.

    Returns:
        Metrics (n,) of the episodes by name.
    """
    metrics: dict[str, Array] = {}
    running = np.ones(play.n, dtype=bool)
    while running.any():
        done = step(running)
        first_end = running[done.finished]
        for name, values in done.metrics.items():
            column = metrics.setdefault(name, np.zeros(play.n, dtype=values.dtype))
            column[done.finished[first_end]] = values[first_end]
        running[done.finished] = False
    return metrics


def _sense(t: float, motion: Sequence[float]) -> Sense:
    x, y, psi, u, v, r = motion
    return Sense(t, psi, r, nan, nan, u, v, x, y)


def _command_row(sent: Mapping[str, float], play: TaskSimulation) -> list[float]:
    """Value of each channel; neutral if it was not sent."""
    channels = play.vessel.commands
    for name in sent:
        if name not in channels:
            raise BadInput(play.vessel.unknown_command_message(name))
    return [sent.get(name, channel.neutral) for name, channel in channels.items()]
