"""Gymnasium vector environment of many boats, simulated in one call on all cores."""

from typing import Any, Unpack

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn import episode_random
from boatsim.learn.backends import Boats
from boatsim.learn.environment_options import Told, play
from boatsim.learn.play import Flags, Seen, Step, open_water
from boatsim.learn.spaces import boxes
from boatsim.physics.signals import Array


class BoatVectorEnv(VectorEnv[Seen, NDArray[np.float32], Array]):
    """Boats at a task; boat i, reset with a seed, plays the episodes of a single environment reset with seed + i.

    What is over begins anew as `autoreset_mode` says: at the next step (Gymnasium's default), in the same one, with the
    last observations in `info["final_obs"]`, or when `reset(options={"reset_mask": mask})` asks for it. Norms of the
    episodes that end are in `info`, in the same step under `info["final_info"]`: arrays with a mask `_name` each.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
        *,
        render_mode: str | None = None,
        normalised: bool = True,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
        max_episode_steps: int | None = None,
        **told: Unpack[Told],
    ) -> None:
        """Create an environment.

        Args:
            task: Name of the task.
            num_envs: Number of boats.
            render_mode: Must be None.
            normalised: Whether observations are divided by their bounds.
            autoreset_mode: When finished episodes restart.
            threads: Threads that share the boats; None for one per core.
            max_episode_steps: Ignored; Gymnasium passes it.
            told: Further arguments, see `Told`.

        Raises:
            BadInput: An argument is wrong.
        """
        if render_mode is not None:
            raise BadInput("many boats draw no pictures; allowed is render_mode = None")
        self.mode = AutoresetMode(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.mode}
        self.play = play(task, num_envs, open_water(threads), **told)
        self.num_envs, self.normalised = num_envs, normalised
        self.signals, self.controls = self.play.signals, self.play.controls
        self.single_observation_space, self.single_action_space = boxes(self.play, normalised)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._seeds = np.zeros(num_envs, dtype=np.uint64)
        self._numbers = np.zeros(num_envs, dtype=np.uint64)
        self._over, self._drawn = np.zeros(num_envs, dtype=bool), False

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Seen, dict[str, Any]]:
        """Begin episodes of all boats, or of those of `options["reset_mask"]`."""
        super().reset(seed=seed if isinstance(seed, int) else None)
        everyone = np.arange(self.num_envs)
        mask = (options or {}).get("reset_mask")
        boats = everyone if mask is None else np.flatnonzero(mask)
        if isinstance(seed, int):
            self._seed(everyone, np.uint64(seed) + everyone.astype(np.uint64))
        elif seed is not None:
            told = [i for i, one in enumerate(seed) if one is not None]
            self._seed(np.array(told), np.array([seed[i] for i in told], dtype=np.uint64))
        elif not self._drawn:
            self._seed(
                everyone, self.np_random.integers(2**63, size=self.num_envs).astype(np.uint64)
            )
        self._begin(boats)
        self._over[boats] = False
        return self.play.observations(self.normalised), {}

    def step(  # type: ignore[override]
        self, actions: NDArray[np.float32]
    ) -> tuple[Seen, Array, Flags, Flags, dict[str, Any]]:
        """One control step of all boats."""
        waiting = np.flatnonzero(self._over)
        done = self.play.step(np.asarray(actions, dtype=float))
        info: dict[str, Any] = {}
        if self.mode is AutoresetMode.NEXT_STEP and len(waiting):
            done = self._waited(done, waiting)
        seen = self.play.observations(self.normalised)
        if len(done.over):
            info = self._told(done)
        self._over = done.ended | done.late
        if self.mode is AutoresetMode.SAME_STEP and len(done.over):
            info = {
                "final_obs": seen,
                "_final_obs": self._over.copy(),
                "final_info": info,
                "_final_info": self._over,
            }
            self._begin(done.over)
            seen = seen.copy()
            seen[done.over] = self.play.observations(self.normalised, done.over)
            self._over = np.zeros(self.num_envs, dtype=bool)
        return seen, done.reward, done.ended, done.late, info

    def _waited(self, done: Step, waiting: Boats) -> Step:
        """Restart boats whose episodes had ended; their step has no reward and no end."""
        self._begin(waiting)
        for row in (done.reward, done.ended, done.late):
            row[waiting] = 0
        kept = ~np.isin(done.over, waiting)
        return done._replace(
            over=done.over[kept], norms={n: x[kept] for n, x in done.norms.items()}
        )

    def _told(self, done: Step) -> dict[str, Any]:
        """Metrics of finished episodes, each with its mask."""
        info: dict[str, Any] = {}
        for name, values in done.norms.items():
            info[name] = np.zeros(self.num_envs, dtype=values.dtype)
            info[name][done.over] = values
            info[f"_{name}"] = done.ended | done.late
        return info

    def _seed(self, boats: Boats, seeds: episode_random.Seeds) -> None:
        self._seeds[boats], self._numbers[boats], self._drawn = seeds, 0, True

    def _begin(self, boats: Boats) -> None:
        self.play.begin(episode_random.episode(self._seeds[boats], self._numbers[boats]), boats)
        self._numbers[boats] += np.uint64(1)
