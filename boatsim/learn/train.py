"""Trains a policy for a task: `python -m boatsim.learn.train boatsim/Berth-v0 --out out/berth`.

Proximal policy optimisation (PPO) of stable-baselines3 on many boats at once, with the same
settings for every task. The command writes the policy (`policy.onnx`) and its learning curve
(`curve.csv`). Needs `pip install "boatsim[train]"`.
"""

import argparse
import csv
import os
import resource
import sys
from pathlib import Path
from time import monotonic
from typing import Any

import gymnasium
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from torch import nn

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import replace_file
from boatsim.learn import registration
from boatsim.learn.policy_export import Layer, describe_policy, write_policy
from boatsim.learn.sb3 import BoatVecEnv

STEPS, BOATS = 8_000_000, 512  # control steps of all boats together; boats that learn side by side
LEAST_EPISODES = 500  # of a point of the learning curve
PRINTED = 5  # points of the curve for each line that is printed
# Settings of PPO that differ from those of stable-baselines3. Few long batches of many boats need
# larger steps than the defaults, which are for a single environment: N. Rudin et al., Learning to
# walk in minutes using massively parallel deep reinforcement learning, CoRL 2021.
RECIPE: dict[str, Any] = {
    "n_steps": 64,  # control steps of each boat between two updates, 12.8 s
    "batch_size": 4096,
    "n_epochs": 6,
    "learning_rate": 7e-4,
    "gamma": 0.995,  # a horizon of 40 s
    "policy_kwargs": {"net_arch": [64, 64], "log_std_init": -0.5},
}


class LearningCurve(BaseCallback):
    """Success and return of the episodes that end during the training.

    Attributes:
        rows: Control steps of all boats so far, share of successes and mean return.
    """

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[tuple[int, float, float]] = []
        self._ended: list[dict[str, Any]] = []

    def _on_step(self) -> bool:
        self._ended += [info for info in self.locals["infos"] if info]
        return True

    def _on_rollout_end(self) -> None:
        if len(self._ended) < LEAST_EPISODES:
            return
        success = float(np.mean([info["is_success"] for info in self._ended]))
        returns = float(np.mean([info["episode"]["r"] for info in self._ended]))
        self.rows.append((self.num_timesteps, success, returns))
        self._ended.clear()
        if len(self.rows) % PRINTED == 0:
            steps = self.num_timesteps / 1e6
            print(f"{steps:5.1f} million control steps: {success:6.1%} succeed", flush=True)


def train(
    name: str, vessel: str | None, steps: int, boats: int, seed: int
) -> tuple[PPO, BoatVecEnv, LearningCurve]:
    """Train a policy by PPO on many boats at once.

    Args:
        name: Id of the environment.
        vessel: Name or path of a vessel; None for that of the environment.
        steps: Control steps of all boats together.
        boats: Number of boats.
        seed: Seed of the episodes and of the learner.

    Returns:
        The learner, its environment, and the learning curve.
    """
    other: dict[str, Any] = {}
    if vessel is not None:
        other = {"vessel": vessel, "vary": {}}
    many = gymnasium.make_vec(
        name,
        num_envs=boats,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        threads=1,
        **other,
    )
    env = BoatVecEnv(many)  # type: ignore[arg-type]
    env.seed(seed)
    curve = LearningCurve()
    learner = PPO("MlpPolicy", env, seed=seed, device="cpu", **RECIPE)
    learner.learn(steps, callback=curve)
    return learner, env, curve


def actor_layers(learner: PPO) -> list[Layer]:
    """Return weights and biases of the layers that compute the mean actions of a PPO policy.

    Args:
        learner: The learner, whose network has tanh between its layers.
    """
    layers = []
    networks = (learner.policy.mlp_extractor.policy_net, learner.policy.action_net)
    for network in networks:
        for module in network.modules():
            if isinstance(module, nn.Linear):
                weights = module.weight.detach().numpy()
                layers.append((weights, module.bias.detach().numpy()))
    return layers


def write_curve(path: Path, curve: LearningCurve) -> None:
    """Write a learning curve as a table.

    Args:
        path: The CSV file.
        curve: The curve.
    """
    with replace_file(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("control_steps", "success", "return"))
        writer.writerows(curve.rows)


def main() -> None:
    """Train a policy of one environment and write its files."""
    parser = argparse.ArgumentParser(description="Trains a policy and writes it as ONNX")
    parser.add_argument("id", help="environment, such as boatsim/Berth-v0")
    parser.add_argument("--vessel", help="name or file of a vessel without variation of its own")
    parser.add_argument("--steps", type=int, default=STEPS, help="control steps of all boats")
    parser.add_argument("--boats", type=int, default=BOATS, help="boats that learn side by side")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True, help="folder of the files")
    given = parser.parse_args()
    try:
        train_and_write(given)
    except BadInput as error:
        print(f"boatsim: {error}", file=sys.stderr)
        raise SystemExit(2) from None


def train_and_write(given: argparse.Namespace) -> None:
    """Train a policy and write its files.

    Args:
        given: Arguments of the command line.

    Raises:
        BadInput: The environment or the vessel does not exist, or a number is not allowed.
    """
    if given.id not in registration.environment_ids():
        raise BadInput(
            unknown_name_message("environment", given.id, registration.environment_ids())
        )
    for option in ("steps", "boats"):
        if getattr(given, option) < 1:
            raise BadInput(f"--{option} {getattr(given, option)}: allowed is at least 1")
    given.out.mkdir(parents=True, exist_ok=True)
    start = monotonic()
    learner, env, curve = train(given.id, given.vessel, given.steps, given.boats, given.seed)
    usage = resource.getrusage(resource.RUSAGE_SELF)
    cores = len(os.sched_getaffinity(0))
    cpu = usage.ru_utime + usage.ru_stime
    print(f"trained in {monotonic() - start:.0f} s on {cores} cores, {cpu:.0f} s CPU")
    write_policy(given.out / "policy.onnx", actor_layers(learner), describe_policy(env.boats.play))
    write_curve(given.out / "curve.csv", curve)
    print(f"policy: {given.out / 'policy.onnx'}")


if __name__ == "__main__":
    main()
