"""Compare trained policies with classical controllers on the same boats: `python -m benchmarks.policies FILE...`.

Each file is a policy of `boatsim.learn.train`. Policy and controllers steer the same boats, which were
not used in the training, with equal loads, thrust, winds, currents, starts and goals; all of them know
the true motion. The policy runs as its controller file does, with its own period. For each task the
command prints a table of all, and the paired comparison with the best controller: the one with the most
successes or, among equals, with the smallest median of the main figure.
"""

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.control.approach import Approach
from boatsim.control.base import Controller, Sense
from boatsim.learn import episode_random, registration
from boatsim.learn.environment_options import make_simulation
from boatsim.learn.pilot import Pilot, play_to_end, run_episodes
from boatsim.learn.play import TaskSimulation
from boatsim.learn.policy import Policy, load_policy
from boatsim.learn.tasks.follow_path import FollowPath
from boatsim.learn.tasks.joystick import MOVES, Joystick
from boatsim.physics.content import load_class
from boatsim.physics.signals import Array
from boatsim.simulate.vessel_model import introduce_vessel
from boatsim.sweeps.robustness.survival import wilson_interval

NEUTRAL = "neutral commands"
UNSEEN = 1_000_000  # first seed of the comparison; those of the training begin at 0
MAIN_FIGURES = {  # metric, unit and decimals of the main figure of each task; smaller is better
    "berth": ("time_s", "s", 1),
    "hold_station": ("distance_rms_L", "L", 3),
    "follow_path": ("aside_rms_L", "L", 3),
    "joystick": ("velocity_error_rms", "of the largest request", 3),
}
Metrics = dict[str, Array]
MakePilot = Callable[[Array], Pilot]


@dataclass
class ControllerPilot:
    """A controller with the goals of one episode as a function of time."""

    controller: Controller
    goal: Callable[[float], Mapping[str, float]]

    def step(self, sense: Sense) -> Mapping[str, float]:
        """Return the commands for the next period.

        Args:
            sense: True motion of the boat.
        """
        return self.controller.step(sense, self.goal(sense.t))


@dataclass
class BerthingPilot:
    """A joystick whose stick is moved by the outer loop `Approach`."""

    inner: Controller
    outer: Approach

    def step(self, sense: Sense) -> Mapping[str, float]:
        """Return the commands for the next period.

        Args:
            sense: True motion of the boat, relative to the berth.
        """
        pose = (sense.x, sense.y, sense.psi)
        stick = self.outer.step(pose, sense.v, self.inner.period)
        goal = {"surge_mps": stick.surge, "sway_mps": stick.sway, "yaw_radps": stick.yaw}
        return self.inner.step(sense, goal)


def controller_for(name: str, play: TaskSimulation, **settings: Any) -> Controller:
    """Return a controller that knows the first vessel of a task's variation.

    Args:
        name: Name of the controller.
        play: The simulation.
        settings: Settings of the controller.
    """
    controller: Controller = load_class("controller", name).from_settings(settings)
    introduce_vessel(controller, play.vessel)
    controller.reset()
    return controller


def joystick_goal(task: Joystick, goal: Array, t: float) -> dict[str, float]:
    """Return what the stick requests at a time.

    Args:
        task: The task.
        goal: Requests (2 MOVES,) of the episode.
        t: Time [s].
    """
    move = int(t / task.moves + 1e-9) % MOVES
    return {"sway_mps": float(goal[move]), "yaw_radps": float(goal[MOVES + move])}


def sine_waypoints(task: FollowPath, play: TaskSimulation, goal: Array) -> list[list[float]]:
    """Return waypoints on the path of an episode, half a length apart along x.

    Args:
        task: The task.
        play: The simulation.
        goal: Amplitude [m], wave number [1/m] and phase [rad] of the path.
    """
    length = play.scale.length
    farthest = 1.5 * task.cruise * play.scale.speed * play.duration
    x = np.arange(0.0, farthest, 0.5 * length)
    y = goal[0] * np.sin(goal[1] * x + goal[2])
    return np.column_stack([x, y]).tolist()


def classical_pilots(play: TaskSimulation) -> dict[str, tuple[float, MakePilot]]:
    """Return the controllers that are compared at a task: name -> period [s] and factory.

    Args:
        play: The simulation.
    """
    task = play.task
    at_origin = {"x_m": 0.0, "y_m": 0.0, "psi_rad": 0.0}

    def dp(goal: Array) -> Pilot:
        return ControllerPilot(controller_for("dp", play, period=0.2), lambda t: at_origin)

    def berthing(name: str) -> MakePilot:
        return lambda goal: BerthingPilot(controller_for(name, play), Approach())

    def stick(name: str) -> MakePilot:
        assert isinstance(task, Joystick)
        return lambda goal: ControllerPilot(
            controller_for(name, play), lambda t: joystick_goal(task, goal, t)
        )

    def los(law: str, lookahead: float) -> MakePilot:
        assert isinstance(task, FollowPath)
        speed = task.cruise * play.scale.speed

        def make(goal: Array) -> Pilot:
            waypoints = sine_waypoints(task, play, goal)
            settings = {"law": law, "speed": speed, "path": "spline", "waypoints": waypoints}
            settings["lookahead"] = lookahead * play.scale.length
            return ControllerPilot(controller_for("los", play, **settings), lambda t: {})

        return make

    name = type(task).task_name()
    if name == "berth":
        outer = "with an outer loop"
        return {
            f"`l1_joystick` {outer}": (0.08, berthing("l1_joystick")),
            "`dp`": (0.2, dp),
        }
    if name == "hold_station":
        return {"`dp`": (0.2, dp)}
    if name == "follow_path":
        return {
            f'`los`, law = "{law}", lookahead {lookahead:g} L': (0.1, los(law, lookahead))
            for law in ("adaptive", "integral")
            for lookahead in (3.0, 1.5)  # the default, and a shorter one
        }
    rivals = ("l1_joystick", "pid_autopilot", "adrc", "indi", "lqi", "mpc")
    return {f"`{rival}`": (0.08, stick(rival)) for rival in rivals}


def neutral_commands(goal: Array) -> Pilot:
    """Return a pilot that leaves all commands neutral: what a success is worth.

    Args:
        goal: Not used.
    """
    return ControllerPilot(load_class("controller", "open_loop")(), lambda t: {})


def policy_metrics(policy: Policy, play: TaskSimulation, seeds: episode_random.Seeds) -> Metrics:
    """Return the metrics (n,) of one episode of each boat, steered by a policy.

    Args:
        policy: The policy.
        play: The simulation of n boats.
        seeds: Seeds (n,) of the episodes.
    """
    play.begin_episodes(seeds, np.arange(play.n))
    return play_to_end(play, lambda _: play.step(policy.act(play.observations(normalised=False))))


def main_figures(task: str, metrics: Metrics) -> Array:
    """Return the main figure (n,) of each boat; infinite where a berth was not reached.

    Args:
        task: Name of the task.
        metrics: Metrics of the episodes.
    """
    if task == "joystick":
        errors = [metrics[f"{axis}_error_rms"] ** 2 for axis in ("surge", "sway", "yaw")]
        return np.asarray(np.sqrt(np.sum(errors, axis=0)))
    figure = metrics[MAIN_FIGURES[task][0]]
    if task == "berth":
        return np.where(metrics["is_success"].astype(bool), figure, np.inf)
    return figure


def compare(path: Path, draws: int, seed: int) -> None:
    """Print the comparison of a policy with the classical controllers of its task.

    Args:
        path: File of the policy.
        draws: Number of boats.
        seed: First seed of their episodes.
    """
    policy = load_policy(path)
    task = policy.description.task
    (name,) = [
        name
        for name in registration.environment_ids()
        if registration.environment_arguments(name)["task"] == task
    ]
    options = {**registration.environment_arguments(name), "settings": policy.description.settings}
    seeds = episode_random.episode_seeds(
        np.arange(seed, seed + draws, dtype=np.uint64), np.zeros(draws, np.uint64)
    )
    play = make_simulation(n=draws, **{**options, "period": policy.description.period})
    found = {"policy": policy_metrics(policy, play, seeds)}
    pilots = {**classical_pilots(play), NEUTRAL: (0.2, neutral_commands)}
    for controller, (period, make) in pilots.items():
        other = make_simulation(n=draws, **{**options, "period": period, "step": period / 2.0})
        found[controller] = run_episodes(other, seeds, make)
    print(f"\n{name}: {draws} boats that were not used in the training\n")
    print_task(task, found)


def print_task(task: str, found: Mapping[str, Metrics]) -> None:
    """Print the table of a task and the paired comparison with the best controller.

    Args:
        task: Name of the task.
        found: Metrics of the policy, then of each controller.
    """
    figure, unit, decimals = MAIN_FIGURES[task]
    print(f"| steered by | success | median {figure} [{unit}] | 90 % below |")
    print("| --- | --- | --- | --- |")
    figures = {name: main_figures(task, metrics) for name, metrics in found.items()}
    success = {name: metrics["is_success"].astype(bool) for name, metrics in found.items()}
    for name, values in figures.items():
        middle, slow = np.quantile(values, (0.5, 0.9), method="lower")
        share = success[name].mean()
        print(f"| {name} | {share:.1%} | {middle:.{decimals}f} | {slow:.{decimals}f} |")
    rivals = [name for name in found if name not in ("policy", NEUTRAL)]
    best = min(rivals, key=lambda name: (-success[name].mean(), np.median(figures[name])))
    smaller = figures["policy"] < figures[best]
    low, high = wilson_interval(float(smaller.mean()), len(smaller))
    only_policy = int((success["policy"] & ~success[best]).sum())
    only_best = int((success[best] & ~success["policy"]).sum())
    print(
        f"\nbest controller: {best}; the policy has the smaller {figure} on {smaller.mean():.1%} of "
        f"the boats ({low:.3f} to {high:.3f}); only the policy succeeds on {only_policy}, only the "
        f"controller on {only_best}"
    )


def main() -> None:
    """Compare the policies of the given files."""
    parser = argparse.ArgumentParser(description="Trained policies beside classical controllers")
    parser.add_argument(
        "files", nargs="+", type=Path, help="policies, such as out/berth/policy.onnx"
    )
    parser.add_argument("--draws", type=int, default=500, help="boats")
    parser.add_argument("--seed", type=int, default=UNSEEN, help="first seed of their episodes")
    given = parser.parse_args()
    for path in given.files:
        compare(path, given.draws, given.seed)


if __name__ == "__main__":
    main()
