"""Print how the cost grows, with the exponent of a power law fitted to each column.

    python -m benchmarks.curves

The columns are the time of the compiled engine against the simulated length (a minute to a day), of a
batch against the number of boats (1 to 100,000), and of the compiled engine against the number of
effects on one boat. An exponent of 1 means proportional; a smaller one shows a fixed cost.
"""

import argparse
from collections.abc import Callable, Sequence
from statistics import median
from time import perf_counter

import numpy as np

from benchmarks.engine import COMMANDS, STEP
from boatsim.physics import vessel
from boatsim.simulate.batch import Batch

ROUNDS = 5
MINUTES = (1, 10, 60, 360, 1440)
BOATS = (1, 10, 100, 1_000, 10_000, 100_000)
ENTRIES = (0, 2, 4, 8, 16)  # effects in addition to those of the vessel file
STEPS = {"boats": 100, "entries": 200_000}


def median_time(work: Callable[[], object]) -> float:
    """Return the median wall time [s] without the first call."""
    work()
    seconds = []
    for _ in range(ROUNDS):
        begin = perf_counter()
        work()
        seconds.append(perf_counter() - begin)
    return median(seconds)


def scaling_column(
    what: str, sizes: Sequence[int], seconds: Sequence[float], steps: Sequence[int]
) -> str:
    """Return a column of the table, with the exponents of the whole and of its second half."""
    lines = [f"{what:>12}{'[s]':>12}{'million steps/s':>18}"]
    lines += [
        f"{n:12,}{s:12.3g}{k / s / 1e6:18.3g}"
        for n, s, k in zip(sizes, seconds, steps, strict=True)
    ]
    x, y, half = np.log(np.maximum(sizes, 1)), np.log(seconds), len(sizes) // 2
    whole, later = (np.polyfit(x[since:], y[since:], 1)[0] for since in (0, half))
    return "\n".join([*lines, f"    exponent {whole:.2f}; from {sizes[half]:,} on {later:.2f}", ""])


def scaling_with_length() -> str:
    """Return the column for the simulated length."""
    compiled_engine = Batch(vessel.load_vessel("joystick_boat"), step=STEP)
    steps = [round(60 * m / STEP) for m in MINUTES]
    return scaling_column(
        "minutes",
        MINUTES,
        [
            median_time(lambda n=n: compiled_engine.hold_commands([0.0] * 6, COMMANDS, n))
            for n in steps
        ],
        steps,
    )


def scaling_with_boats() -> str:
    """Return the column for the number of boats, on all cores."""
    made, seconds = vessel.load_vessel("joystick_boat"), []
    for n in BOATS:
        batch = Batch(made, n, STEP)
        seconds.append(median_time(lambda batch=batch: batch.advance(COMMANDS, STEPS["boats"])))
    return scaling_column("boats", BOATS, seconds, [n * STEPS["boats"] for n in BOATS])


def scaling_with_effects() -> str:
    """Return the column for the number of effects, without the time to compile each vessel."""
    own, sizes, seconds = len(vessel.load_vessel("joystick_boat").effects), [], []
    for extra in ENTRIES:
        effects = [
            {"use": "fan_wind", "name": f"wind_{i}", "speed": 0.1 * (i + 1), "toward": 0.1 * i}
            for i in range(extra)
        ]
        compiled_engine = Batch(vessel.load_vessel("joystick_boat", extra=effects), step=STEP)
        sizes.append(own + extra)
        seconds.append(
            median_time(
                lambda compiled_engine=compiled_engine: compiled_engine.hold_commands(
                    [0.0] * 6, COMMANDS, STEPS["entries"]
                )
            )
        )
    return scaling_column("entries", sizes, seconds, [STEPS["entries"]] * len(sizes))


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    for part in (scaling_with_length, scaling_with_boats, scaling_with_effects):
        print(part(), flush=True)


if __name__ == "__main__":
    main()
