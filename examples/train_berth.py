"""Trains a policy to berth boats of which little is known, and sets it beside the L1 controller on the same draws.

pip install "boatsim[train]"; python examples/train_berth.py --out out/berth

Two minutes on two idle cores. Writes the policy and its learning curve (policy.zip, curve.svg), prints the comparison.
"""

import argparse
import os
import resource
from pathlib import Path
from time import monotonic

import gymnasium
import numpy as np
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from boatsim.control.approach import Approach
from boatsim.control.base import Sense
from boatsim.learn import episode_random, registration
from boatsim.learn.environment_options import make_simulation
from boatsim.learn.pilot import run_episodes
from boatsim.learn.play import TaskSimulation
from boatsim.learn.sb3 import BoatVecEnv
from boatsim.physics.content import load_class

ID = "boatsim/Berth-v0"
UNSEEN = 1_000_000  # seeds of the comparison begin here, those of the training at 0
Norms = dict[str, np.ndarray]


class Curve(BaseCallback):
    """Share of berthed boats and their time, of the episodes that ended in each rollout."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[tuple[float, float, float]] = []  # million steps, share berthed, time [s]
        self._over: list[dict[str, float]] = []

    def _on_step(self) -> bool:
        self._over += [info for info in self.locals["infos"] if info]
        return True

    def _on_rollout_end(self) -> None:
        if len(self._over) < 500:
            return
        berthed = [bool(info["is_success"]) for info in self._over]
        times = [info["time_s"] for info in self._over if info["is_success"]]
        self.rows.append(
            (self.num_timesteps / 1e6, float(np.mean(berthed)), float(np.mean(times or [np.nan])))
        )
        self._over.clear()
        if len(self.rows) % 5 == 0:
            steps, share, seconds = self.rows[-1]
            told = f", in {seconds:.1f} s" if times else ""
            print(f"{steps:5.1f} million control steps: {share:6.1%} berthed{told}", flush=True)


def trained(steps: int, boats: int) -> tuple[PPO, Curve]:
    """Proximal policy optimisation with stable-baselines3's defaults but for the sizes."""
    many = gymnasium.make_vec(
        ID,
        num_envs=boats,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        threads=1,
    )
    env, curve = BoatVecEnv(many), Curve()  # type: ignore[arg-type]
    env.seed(0)
    model = PPO(
        "MlpPolicy",
        env,
        n_steps=64,
        batch_size=4096,
        n_epochs=6,
        learning_rate=7e-4,
        gamma=0.995,
        seed=0,
        device="cpu",
        policy_kwargs={"net_arch": [64, 64], "log_std_init": -0.5},
    )
    model.learn(steps, callback=curve)
    return model, curve


def of_policy(model: PPO, game: TaskSimulation, seeds: episode_random.Seeds) -> Norms:
    """How an episode of each boat went."""
    game.begin_episodes(seeds, np.arange(game.n))
    found: Norms = {}
    waiting = np.ones(game.n, dtype=bool)
    while waiting.any():
        action, _ = model.predict(game.observations(True), deterministic=True)
        done = game.step(np.asarray(action, dtype=float))
        new = waiting[done.finished]
        for name, values in done.metrics.items():
            found.setdefault(name, np.zeros(game.n))[done.finished[new]] = values[new]
        waiting[done.finished] = False
    return found


class Berthing:
    """The L1 joystick, its stick moved by an outer loop."""

    def __init__(self) -> None:
        self.inner, self.outer = load_class("controller", "l1_joystick")(), Approach()

    def step(self, sense: Sense) -> dict[str, float]:
        """Commands for the next period."""
        stick = self.outer.step((sense.x, sense.y, sense.psi), sense.v, self.inner.period)
        goal = {"surge_mps": stick.surge, "sway_mps": stick.sway, "yaw_radps": stick.yaw}
        return dict(self.inner.step(sense, goal))


def drawn(curve: Curve, path: Path) -> None:
    """The learning curve as an SVG: share berthed on the left axis, time on the right one."""
    steps, share, time = np.array(curve.rows).T
    x = 60 + 560 * steps / steps.max()
    lines = {"#0b6e99": 260 - 220 * share, "#c8641e": 260 - 220 * time / 90.0}
    parts = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 680 310" font-family="sans-serif" font-size="12">',
        '<rect width="680" height="310" fill="white"/>',
    ]
    for k in range(6):
        y, at = 260 - 44 * k, 60 + 112 * k
        parts += [
            f'<line x1="60" x2="620" y1="{y}" y2="{y}" stroke="#dddddd"/>',
            f'<text x="52" y="{y + 4}" text-anchor="end" fill="#0b6e99">{20 * k} %</text>',
            f'<text x="628" y="{y + 4}" fill="#c8641e">{18 * k} s</text>',
            f'<text x="{at}" y="278" text-anchor="middle">{steps.max() * k / 5:.1f}</text>',
        ]
    for colour, y in lines.items():
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True) if np.isfinite(b))
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
        )
    parts += [
        '<text x="340" y="300" text-anchor="middle">control steps of all boats together [million]</text>',
        '<text x="60" y="24" fill="#0b6e99">episodes that end berthed</text>',
        '<text x="620" y="24" text-anchor="end" fill="#c8641e">mean time of those that do</text>',
        "</svg>",
    ]
    path.write_text("\n".join(parts) + "\n", encoding="utf-8")


def main() -> None:
    """Train, compare, print."""
    asked = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    asked.add_argument(
        "--steps", type=int, default=8_000_000, help="control steps of all boats together"
    )
    asked.add_argument("--boats", type=int, default=512, help="that are trained side by side")
    asked.add_argument("--draws", type=int, default=500, help="boats of the comparison")
    asked.add_argument("--out", type=Path, default=Path("out/berth"))
    told = asked.parse_args()
    told.out.mkdir(parents=True, exist_ok=True)
    begun = monotonic()
    model, curve = trained(told.steps, told.boats)
    wall = monotonic() - begun
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(
        f"trained in {wall:.0f} s on {len(os.sched_getaffinity(0))} cores, {used.ru_utime + used.ru_stime:.0f} s CPU"
    )
    model.save(told.out / "policy.zip")
    if curve.rows:
        drawn(curve, told.out / "curve.svg")
    says = registration.environment_arguments(ID)
    seeds = episode_random.episode_seeds(
        np.arange(UNSEEN, UNSEEN + told.draws, dtype=np.uint64), np.zeros(told.draws, np.uint64)
    )
    found = {
        "policy": of_policy(model, make_simulation(n=told.draws, **says), seeds),
        "L1 joystick": run_episodes(
            make_simulation(n=told.draws, **{**says, "period": 0.08, "step": 0.08}), seeds, Berthing
        ),
    }
    print(f"\n{told.draws} boats, none of which was trained on\n")
    print("| steered by | berthed | touched the quay | median time [s] | slowest tenth [s] |")
    print("| --- | --- | --- | --- | --- |")
    for name, norms in found.items():
        ok = norms["is_success"].astype(bool)
        middle, slow = (
            np.percentile(norms["time_s"][ok], (50, 90)) if ok.any() else (np.nan, np.nan)
        )
        print(
            f"| {name} | {ok.mean():.1%} | {norms['touched'].mean():.1%} | {middle:.1f} | {slow:.1f} |"
        )
    both = found["policy"]["is_success"].astype(bool) & found["L1 joystick"]["is_success"].astype(
        bool
    )
    faster = found["policy"]["time_s"][both] < found["L1 joystick"]["time_s"][both]
    print(
        f"\nof the {both.sum()} boats that both berth, the policy is the faster one on {faster.mean():.1%}"
    )


if __name__ == "__main__":
    main()
