"""Speed of batches on one of Warp's devices, and how far they are from the twin.

python -m benchmarks.gpu                     boat-steps/s against the number of boats, about a minute
python -m benchmarks.gpu --device cuda:0     the same on a GPU, up to a million boats
python -m benchmarks.gpu --agreement         largest difference to the twin, vessel by vessel, about two minutes

A boat-step is one Runge-Kutta step of 20 ms with all effects of the vessel. Each boat begins at its own state and has
its own commands, which jump once a second; what it takes to end steps where a lag or a rate bends is in the time.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.table import Table

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.compiled_engine import Twin
from boatsim.warp import Batch
from boatsim.warp.runtime import device as known

STEP, SECOND = 0.02, 50  # [s], steps in a second
ROUNDS = 3
SIZES = (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000)
LARGEST = {"cpu": 10_000}  # boats; on anything else all sizes
WAYS = {"on mujoco_warp": True, "without MuJoCo": False}
WIDEST = 1e3  # of a command
SECONDS, BOATS = 10, 1_000  # of the agreement


def drawn(boat: Vessel, *shape: int) -> tuple[Array, Array]:
    """States (n, 2 NQ) about the origin, and commands (rows, n, C) anywhere in their ranges; `shape` is (rows, n)."""
    rng = np.random.default_rng(1)
    ranges = np.clip(np.array(list(boat.limits().values())).reshape(-1, 2), -WIDEST, WIDEST)
    starts = rng.uniform(-0.3, 0.3, (shape[-1], 2 * len(boat.dof)))
    return starts, rng.uniform(ranges[:, 0], ranges[:, 1], (*shape, len(ranges)))


def rate(batch: Batch) -> float:
    """Boat-steps/s, the median of some seconds of sailing."""
    starts, commands = drawn(batch.vessels[0], ROUNDS + 1, batch.n)
    batch.reset(starts, commands[0])
    batch.advance(commands[0], SECOND)  # compiles, warms up
    found = []
    for row in commands[1:]:
        begin = perf_counter()
        batch.advance(row, SECOND)
        batch.motion.boats.t.numpy()  # waits for the device
        found.append(batch.n * SECOND / (perf_counter() - begin))
    return median(found)


def speed(boat: Vessel, device: str, largest: int) -> Table:
    """The table of rates."""
    table = Table("boats", *(f"{way} [boat-steps/s]" for way in WAYS), box=None)
    for n in (n for n in SIZES if n <= largest):
        rates = (
            rate(Batch(boat, n, STEP, device, mujoco=on_mujoco)) for on_mujoco in WAYS.values()
        )
        table.add_row(f"{n:,}", *(f"{found:.2e}" for found in rates))
    return table


def furthest(boat: Vessel, device: str, on_mujoco: bool) -> float:
    """Largest difference to the twin, each state by its largest size over all boats and times."""
    batch, twin = Batch(boat, BOATS, STEP, device, mujoco=on_mujoco), Twin(boat, STEP)
    starts, commands = drawn(boat, SECONDS, BOATS)
    batch.reset(starts, commands[0])
    found = [batch.states]
    for row in commands:
        batch.advance(row, SECOND)
        found.append(batch.states)
    wanted = np.stack([twin.rollout(starts[i], commands[:, i], 1.0) for i in range(BOATS)], axis=1)
    return float((np.abs(np.array(found) - wanted) / np.abs(wanted).max(axis=(0, 1))).max())


def agreement(device: str) -> Table:
    """The table of differences."""
    table = Table("vessel", *WAYS, box=None)
    for path in sorted(Path("models").glob("*/vessel.toml")):
        boat = vessel.load(path.parent.name)
        table.add_row(
            boat.name, *(f"{furthest(boat, device, on_mujoco):.1e}" for on_mujoco in WAYS.values())
        )
    return table


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
        found = known(given.device)
        print(
            f"{found} ({found.name}), steps of {STEP:g} s"
            + ("" if given.agreement else f", {given.vessel}")
        )
        most = given.most or LARGEST.get(given.device, max(SIZES))
        boat = vessel.load(given.vessel)
        Console().print(
            agreement(given.device) if given.agreement else speed(boat, given.device, most)
        )
    except BadInput as error:
        raise SystemExit(f"error: {error}") from None


if __name__ == "__main__":
    main()
