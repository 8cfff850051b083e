"""Measure the control steps per second of the learning environments: `python -m benchmarks.learning`.

The table has one boat on one core (`gymnasium.make`) and many on all cores (`gymnasium.make_vec`),
including observations, rewards, ends and new episodes with their samples, with constant actions. Each
figure is the best of 25 short intervals, because other programs may use the machine.
"""

import os
from time import perf_counter

import gymnasium
import numpy as np
from dm_control.rl.control import Environment

from boatsim.learn import registration
from boatsim.learn.environment_options import make_simulation
from boatsim.simulate import env

BEST_OF = 25
ALONE, MANY = 1000, 4096  # control steps of an interval with one boat; boats


def steps_per_second_alone(name: str, period: float, step: float) -> float:
    """Return the control steps per second of one boat."""
    boat = gymnasium.make(name, period=period, step=step)
    boat.reset(seed=1)
    action, found = 0.3 * np.ones(boat.action_space.shape or (), dtype=np.float32), 0.0
    for _ in range(BEST_OF):
        begun = perf_counter()
        for _ in range(ALONE):
            _, _, ended, late, _ = boat.step(action)
            if ended or late:
                boat.reset()
        found = max(found, ALONE / (perf_counter() - begun))
    return found


def steps_per_second_of_batch(name: str, period: float, step: float) -> float:
    """Return the control steps per second of many boats together."""
    boats = gymnasium.make_vec(
        name,
        num_envs=MANY,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        period=period,
        step=step,
    )
    boats.reset(seed=1)
    boats.action_space.seed(1)
    actions, found = boats.action_space.sample(), 0.0
    for _ in range(BEST_OF):
        begun = perf_counter()
        for _ in range(25):
            boats.step(actions)
        found = max(found, 25 * MANY / (perf_counter() - begun))
    return found


def error_of_coarse_step(name: str, step: float) -> float:
    """Return the largest distance [m] between 200 boats with a coarse and a fine integration step."""
    places = []
    for one in (0.005, step):
        game = make_simulation(n=200, **{**registration.environment_arguments(name), "step": one})
        game.begin_episodes(np.arange(200, dtype=np.uint64), np.arange(200))
        random = np.random.default_rng(1)  # equal actions for both steps
        for k in range(100):
            if k % 10 == 0:  # a new action every 2 s
                actions = random.uniform(-1.0, 1.0, (200, len(game.controls.names)))
            game.step(actions)
        places.append(np.array(game.motion[:2]))
    return float(np.hypot(*(places[0] - places[1])).max())


def steps_per_second_of_dm_env(boat: Environment) -> float:
    """Return the control steps per second of the dm_env environment, on MuJoCo."""
    boat.reset()
    action, found = 0.3 * boat.action_spec().maximum, 0.0
    for _ in range(BEST_OF):
        begun = perf_counter()
        for _ in range(ALONE // 4):
            if boat.step(action).last():
                boat.reset()
        found = max(found, ALONE / 4 / (perf_counter() - begun))
    return found


def main() -> None:
    """Print the table."""
    print(f"control steps a second, {len(os.sched_getaffinity(0))} cores, {MANY} boats together\n")
    print(
        "| environment | control step, integration step | one boat | many together |\n| --- | --- | --- | --- |"
    )
    for name in registration.environment_ids():
        print(
            f"| {name} | 0.2 s, 0.1 s | {steps_per_second_alone(name, 0.2, 0.1):,.0f} | {steps_per_second_of_batch(name, 0.2, 0.1):,.0f} |",
            flush=True,
        )
    name = registration.environment_ids()[0]
    print(
        f"| {name} | 0.08 s, 0.02 s | {steps_per_second_alone(name, 0.08, 0.02):,.0f} | {steps_per_second_of_batch(name, 0.08, 0.02):,.0f} |"
    )
    boat = registration.environment_arguments(name)["vessel"]
    print(
        f"| dm_env, {boat} on MuJoCo | 0.08 s, 0.02 s | {steps_per_second_of_dm_env(env.load(f'{boat}/berth')):,.0f} | |"
    )
    off = 1e3 * max(error_of_coarse_step(name, 0.1) for name in registration.environment_ids())
    print(
        f"\nsteps of 0.1 s put a boat at most {off:.1f} mm elsewhere after 20 s of random actions than steps of 5 ms"
    )


if __name__ == "__main__":
    main()
