"""Measure the speed of batches on a Warp device, and their distance to the compiled engine.

    python -m benchmarks.gpu                   boat-steps/s against the number of boats, a minute
    python -m benchmarks.gpu --device cuda:0   the same on a GPU, up to a million boats
    python -m benchmarks.gpu --agreement       largest difference for each vessel, two minutes

A boat-step is one Runge-Kutta step of 20 ms with all effects of the vessel. Each boat has its own
initial state and its own commands, which jump once a second; the time includes the division of steps
at kinks of lags and rate limits.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch as CoreBatch
from boatsim.warp import Batch
from boatsim.warp.runtime import find_device

STEP, SECOND = 0.02, 50  # [s], steps in a second
ROUNDS = 3
SIZES = (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000)
LARGEST = {"cpu": 10_000}  # boats; on other devices all sizes
WAYS = {"on mujoco_warp": True, "without MuJoCo": False}
WIDEST = 1e3  # largest magnitude of a command
SECONDS, BOATS = 10, 1_000  # length and size of the comparison
WIDTH = 23  # [characters] of a column


def random_case(boat: Vessel, *shape: int) -> tuple[Array, Array]:
    """Return random states (n, 2 NQ) near the origin and commands (rows, n, C) within their ranges.

    Args:
        boat: The vessel.
        *shape: Numbers of rows and of boats.
    """
    rng = np.random.default_rng(1)
    ranges = np.clip(np.array(list(boat.limits().values())).reshape(-1, 2), -WIDEST, WIDEST)
    starts = rng.uniform(-0.3, 0.3, (shape[-1], 2 * len(boat.dof)))
    return starts, rng.uniform(ranges[:, 0], ranges[:, 1], (*shape, len(ranges)))


def boat_steps_per_second(batch: Batch) -> float:
    """Return the median of boat-steps per second over some simulated seconds."""
    starts, commands = random_case(batch.vessels[0], ROUNDS + 1, batch.n)
    batch.reset(starts, commands[0])
    batch.advance(commands[0], SECOND)  # compiles
    found = []
    for row in commands[1:]:
        begin = perf_counter()
        batch.advance(row, SECOND)
        batch.motion.boats.t.numpy()  # waits for the device
        found.append(batch.n * SECOND / (perf_counter() - begin))
    return median(found)


def print_row(cells: Sequence[str]) -> None:
    """Print a row of a table now: a table of a million boats takes minutes."""
    print("".join(f"{cell:<{WIDTH}}" for cell in cells).rstrip(), flush=True)


def print_speeds(boat: Vessel, device: str, largest: int) -> None:
    """Print boat-steps/s for each number of boats."""
    print_row(["boats", *WAYS])
    for n in (n for n in SIZES if n <= largest):
        cells = [f"{n:,}"]
        for on_mujoco in WAYS.values():
            batch = Batch(boat, n, STEP, device, mujoco=on_mujoco)
            cells.append(f"{boat_steps_per_second(batch):.2e}")
        print_row(cells)


def largest_difference(boat: Vessel, device: str, on_mujoco: bool) -> float:
    """Return the largest difference to the compiled engine, relative to the magnitude of each state."""
    batch = Batch(boat, BOATS, STEP, device, mujoco=on_mujoco)
    compiled_engine = CoreBatch(boat, step=STEP)
    starts, commands = random_case(boat, SECONDS, BOATS)
    batch.reset(starts, commands[0])
    found = [batch.states]
    for row in commands:
        batch.advance(row, SECOND)
        found.append(batch.states)
    wanted = np.stack(
        [compiled_engine.rollout(starts[i], commands[:, i], 1.0) for i in range(BOATS)], axis=1
    )
    return float((np.abs(np.array(found) - wanted) / np.abs(wanted).max(axis=(0, 1))).max())


def print_differences(device: str) -> None:
    """Print the largest difference of each vessel."""
    print_row(["vessel", *WAYS])
    for path in sorted(Path("models").glob("*/vessel.toml")):
        boat = vessel.load_vessel(path.parent.name)
        cells = [boat.name]
        for on_mujoco in WAYS.values():
            cells.append(f"{largest_difference(boat, device, on_mujoco):.1e}")
        print_row(cells)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gpu", description="Batches on Warp."
    )
    parser.add_argument("--device", default="cpu", help="one of Warp's: cpu, cuda:0")
    parser.add_argument("--vessel", default="joystick_boat", help="whose speed is measured")
    parser.add_argument("--most", type=int, help="boats at most")
    parser.add_argument(
        "--agreement", action="store_true", help="how far from the twin, over ten seconds"
    )
    given = parser.parse_args(arguments)
    try:
        found = find_device(given.device)
        print(
            f"{found} ({found.name}), steps of {STEP:g} s"
            + ("" if given.agreement else f", {given.vessel}")
        )
        if given.agreement:
            print_differences(given.device)
            return
        most = given.most or LARGEST.get(given.device, max(SIZES))
        print_speeds(vessel.load_vessel(given.vessel), given.device, most)
    except BadInput as error:
        raise SystemExit(f"error: {error}") from None


if __name__ == "__main__":
    main()
