"""Vector environment for stable-baselines3."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from boatsim.learn.vector import BoatVectorEnv
from boatsim.physics.signals import Array


class BoatVecEnv(VecEnv):
    """Wraps a `BoatVectorEnv`; its infos hold the return and length of an episode as Monitor does."""

    def __init__(self, boats: BoatVectorEnv) -> None:
        """`boats` has `autoreset_mode="SameStep"`."""
        self.boats = boats
        super().__init__(boats.num_envs, boats.single_observation_space, boats.single_action_space)
        self._actions: NDArray[np.float32] = np.zeros(
            boats.action_space.shape or (), dtype=np.float32
        )
        self._returns, self._lengths = (
            np.zeros(boats.num_envs),
            np.zeros(boats.num_envs, dtype=np.int64),
        )
        self._nothing: list[dict[str, Any]] = [{} for _ in range(boats.num_envs)]

    def reset(self) -> NDArray[np.float32]:
        """Begin episodes of all boats."""
        seen, _ = self.boats.reset(seed=self._seeds[0] if self._seeds else None)
        self._returns[:], self._lengths[:] = 0.0, 0
        self._reset_seeds()
        return seen

    def step_async(self, actions: NDArray[np.float32]) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], Array, NDArray[np.bool_], list[dict[str, Any]]]:
        """One control step of all boats."""
        seen, reward, ended, late, told = self.boats.step(self._actions)
        self._returns += reward
        self._lengths += 1
        over, infos = ended | late, self._nothing.copy()
        for i in np.flatnonzero(over).tolist():
            norms = told["final_info"]
            infos[i] = {
                **{name: x[i].item() for name, x in norms.items() if not name.startswith("_")},
                "terminal_observation": told["final_obs"][i],
                "TimeLimit.truncated": bool(late[i]),
                "episode": {"r": float(self._returns[i]), "l": int(self._lengths[i]), "t": 0.0},
            }
        self._returns[over], self._lengths[over] = 0.0, 0
        return seen, reward.astype(np.float32), over, infos

    def close(self) -> None:
        """Close the wrapped environment."""
        self.boats.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """Of the boats, the same for each."""
        return [getattr(self.boats, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Of the boats together."""
        setattr(self.boats, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any
    ) -> list[Any]:
        """Of the boats together."""
        return [getattr(self.boats, method_name)(*method_args, **method_kwargs)]

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """Return False for each boat."""
        return [False] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[Any]:
        """Return no pictures."""
        return []
