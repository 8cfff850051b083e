"""Controllers at a task: each boat has its own controller, which receives its true motion."""

from collections.abc import Callable, Mapping, Sequence
from math import nan
from typing import Protocol

import numpy as np

from boatsim.control.base import Sense
from boatsim.errors import BadInput
from boatsim.learn.episode_random import Seeds
from boatsim.learn.play import Play
from boatsim.physics.signals import Array


class Pilot(Protocol):
    """What steers one boat."""

    def step(self, sense: Sense) -> Mapping[str, float]:
        """Commands for the next control step, by name."""


def piloted(play: Play, seeds: Seeds, made: Callable[[], Pilot]) -> dict[str, Array]:
    """Norms (n,) of an episode of each boat of a play, by their seeds (n,)."""
    play.begin(seeds, np.arange(play.n))
    pilots = [made() for _ in range(play.n)]
    names = list(play.vessel.commands)
    commands = play.commands.copy()
    found: dict[str, Array] = {}
    open_yet = np.ones(play.n, dtype=bool)
    while open_yet.any():
        t, rows = play.t, np.column_stack(play.motion).tolist()
        for i in np.flatnonzero(open_yet).tolist():
            commands[i] = _row(pilots[i].step(_sense(float(t[i]), rows[i])), names, play)
        done = play.step_commands(commands)
        new = open_yet[done.over]
        for name, values in done.norms.items():
            found.setdefault(name, np.zeros(play.n, dtype=values.dtype))[done.over[new]] = values[
                new
            ]
        open_yet[done.over] = False
    return found


def _sense(t: float, row: Sequence[float]) -> Sense:
    x, y, psi, u, v, r = row
    return Sense(t, psi, r, nan, nan, u, v, x, y)


def _row(sent: Mapping[str, float], names: Sequence[str], play: Play) -> list[float]:
    if unknown := [name for name in sent if name not in names]:
        raise BadInput(play.vessel.unknown_command(unknown[0]))
    neutral = [c.neutral for c in play.vessel.commands.values()]
    return [sent.get(name, usual) for name, usual in zip(names, neutral, strict=True)]
