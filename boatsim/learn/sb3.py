"""Vector environment for stable-baselines3."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from boatsim.learn.vector import BoatVectorEnv
from boatsim.physics.signals import Array


class BoatVecEnv(VecEnv):
    """Vector environment of many boats with the interface of stable-baselines3.

    It wraps a `BoatVectorEnv`; `infos` hold return and length of an episode as Monitor's do.
    """

    def __init__(self, boats: BoatVectorEnv) -> None:
        """Wrap an environment.

        Args:
            boats: Environment with `autoreset_mode="SameStep"`.
        """
        self.boats = boats
        super().__init__(boats.num_envs, boats.single_observation_space, boats.single_action_space)
        shape = boats.action_space.shape or ()
        self._actions: NDArray[np.float32] = np.zeros(shape, dtype=np.float32)
        self._returns = np.zeros(boats.num_envs)
        self._lengths = np.zeros(boats.num_envs, dtype=np.int64)
        self._empty_infos: list[dict[str, Any]] = [{} for _ in range(boats.num_envs)]

    def reset(self) -> NDArray[np.float32]:
        """Begin new episodes of all boats.

        Returns:
            Observations (n, S).
        """
        seed = self._seeds[0] if self._seeds else None
        observations, _ = self.boats.reset(seed=seed)
        self._returns[:] = 0.0
        self._lengths[:] = 0
        self._reset_seeds()
        return observations

    def step_async(self, actions: NDArray[np.float32]) -> None:
        """Store the actions of all boats for the following `step_wait`.

        Args:
            actions: Actions (n, A).
        """
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], Array, NDArray[np.bool_], list[dict[str, Any]]]:
        """Simulate one control step of all boats with the stored actions.

        Returns:
            Observations (n, S), rewards (n,), whether episodes ended (n,), and infos.
        """
        observations, reward, terminated, truncated, info = self.boats.step(self._actions)
        self._returns += reward
        self._lengths += 1
        over = terminated | truncated
        infos = self._empty_infos.copy()
        for boat in np.flatnonzero(over).tolist():
            entry: dict[str, Any] = {}
            for name, values in info["final_info"].items():
                if not name.startswith("_"):
                    entry[name] = values[boat].item()
            entry["terminal_observation"] = info["final_obs"][boat]
            entry["TimeLimit.truncated"] = bool(truncated[boat])
            length = int(self._lengths[boat])
            entry["episode"] = {"r": float(self._returns[boat]), "l": length, "t": 0.0}
            infos[boat] = entry
        self._returns[over] = 0.0
        self._lengths[over] = 0
        return observations, reward.astype(np.float32), over, infos

    def close(self) -> None:
        """Close the wrapped vector environment and free its resources."""
        self.boats.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Return an attribute of the wrapped vector environment, once for each boat.

        Args:
            attr_name: Name of the attribute.
            indices: The boats; None for all.
        """
        return [getattr(self.boats, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of the wrapped vector environment.

        Args:
            attr_name: Name of the attribute.
            value: Value of the attribute.
            indices: Ignored; the boats share the attribute.
        """
        setattr(self.boats, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the wrapped vector environment, once for all boats.

        Args:
            method_name: Its name.
            method_args: Positional arguments.
            indices: Ignored.
            method_kwargs: Keyword arguments.
        """
        return [getattr(self.boats, method_name)(*method_args, **method_kwargs)]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """Return False for each boat: single boats have no Gymnasium wrappers.

        Args:
            wrapper_class: Ignored.
            indices: The boats; None for all.
        """
        return [False] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[Any]:
        """Return an empty list, because this vector environment renders no pictures."""
        return []
