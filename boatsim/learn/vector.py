"""Gymnasium vector environment of many boats, simulated in one call on all cores."""

from typing import Any, Unpack

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.learn import episode_random
from boatsim.learn.backends import Boats
from boatsim.learn.environment_options import EnvironmentOptions, make_simulation
from boatsim.learn.play import Flags, Observations, Step, make_batch_world
from boatsim.learn.spaces import make_spaces
from boatsim.physics.signals import Array


class BoatVectorEnv(VectorEnv[Observations, NDArray[np.float32], Array]):
    """Gymnasium vector environment of many boats at one task.

    Boat i, reset with a seed, has the episodes of a single environment that is reset with seed + i.
    `autoreset_mode` determines when a finished episode is followed by the next one: at the next
    step (Gymnasium's default), in the same step, with the last observations in `info["final_obs"]`,
    or at `reset(options={"reset_mask": mask})`. Metrics of finished episodes are in `info`, or in
    `info["final_info"]` if the next episode begins in the same step: arrays with a mask `_name`
    each.
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
        **options: Unpack[EnvironmentOptions],
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
            options: Further arguments, see `EnvironmentOptions`.

        Raises:
            BadInput: An argument is wrong.
        """
        if render_mode is not None:
            raise BadInput("many boats draw no pictures; allowed is render_mode = None")
        self.mode = AutoresetMode(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.mode}
        self.play = make_simulation(task, num_envs, make_batch_world(threads), **options)
        self.num_envs = num_envs
        self.normalised = normalised
        self.signals = self.play.signals
        self.controls = self.play.controls
        self.single_observation_space, self.single_action_space = make_spaces(self.play, normalised)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._seeds = np.zeros(num_envs, dtype=np.uint64)
        self._numbers = np.zeros(num_envs, dtype=np.uint64)
        self._over = np.zeros(num_envs, dtype=bool)
        self._seeded = False

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin new episodes of all boats, or of those in `options["reset_mask"]`.

        Args:
            seed: Seed of boat 0, which the others count on from; or a seed for each boat, where
                None continues its sequence; or None to continue all.
            options: "reset_mask" with truth values (n,).

        Returns:
            Observations (n, S) and an empty dictionary.
        """
        super().reset(seed=seed if isinstance(seed, int) else None)
        all_boats = np.arange(self.num_envs)
        mask = (options or {}).get("reset_mask")
        boats = all_boats if mask is None else np.flatnonzero(mask)
        if isinstance(seed, int):
            self._set_seeds(all_boats, np.uint64(seed) + all_boats.astype(np.uint64))
        elif seed is not None:
            given = {boat: one for boat, one in enumerate(seed) if one is not None}
            seeds = np.array(list(given.values()), dtype=np.uint64)
            self._set_seeds(np.array(list(given)), seeds)
        elif not self._seeded:
            seeds = self.np_random.integers(2**63, size=self.num_envs).astype(np.uint64)
            self._set_seeds(all_boats, seeds)
        self._begin_episodes(boats)
        self._over[boats] = False
        return self.play.observations(self.normalised), {}

    def step(  # type: ignore[override]
        self, actions: NDArray[np.float32]
    ) -> tuple[Observations, Array, Flags, Flags, dict[str, Any]]:
        """Simulate one control step of all boats.

        Args:
            actions: Actions (n, A) from -1 to 1.

        Returns:
            Observations (n, S), rewards, terminated and truncated (n,), and `info`.
        """
        waiting = np.flatnonzero(self._over)
        done = self.play.step(np.asarray(actions, dtype=float))
        info: dict[str, Any] = {}
        if self.mode is AutoresetMode.NEXT_STEP and len(waiting):
            done = self._restart_ended_boats(done, waiting)
        observations = self.play.observations(self.normalised)
        if len(done.finished):
            info = self._episode_metrics(done)
        self._over = done.terminated | done.truncated
        if self.mode is AutoresetMode.SAME_STEP and len(done.finished):
            info = {
                "final_obs": observations,
                "_final_obs": self._over.copy(),
                "final_info": info,
                "_final_info": self._over,
            }
            self._begin_episodes(done.finished)
            observations = observations.copy()
            observations[done.finished] = self.play.observations(self.normalised, done.finished)
            self._over = np.zeros(self.num_envs, dtype=bool)
        return observations, done.reward, done.terminated, done.truncated, info

    def _restart_ended_boats(self, done: Step, waiting: Boats) -> Step:
        """Restart boats whose episodes had ended; their step has no reward and no end."""
        self._begin_episodes(waiting)
        for row in (done.reward, done.terminated, done.truncated):
            row[waiting] = 0
        kept = ~np.isin(done.finished, waiting)
        metrics = {name: values[kept] for name, values in done.metrics.items()}
        return done._replace(finished=done.finished[kept], metrics=metrics)

    def _episode_metrics(self, done: Step) -> dict[str, Any]:
        """Metrics of finished episodes, each with its mask."""
        info: dict[str, Any] = {}
        for name, values in done.metrics.items():
            info[name] = np.zeros(self.num_envs, dtype=values.dtype)
            info[name][done.finished] = values
            info[f"_{name}"] = done.terminated | done.truncated
        return info

    def _set_seeds(self, boats: Boats, seeds: episode_random.Seeds) -> None:
        self._seeds[boats] = seeds
        self._numbers[boats] = 0
        self._seeded = True

    def _begin_episodes(self, boats: Boats) -> None:
        self.play.begin_episodes(
            episode_random.episode_seeds(self._seeds[boats], self._numbers[boats]), boats
        )
        self._numbers[boats] += np.uint64(1)
