"""Scatter of the joystick thesis' norms by its accuracy of measurement and its sensors.

Run `python -m benchmarks.thesis_scatter`. It repeats the eight tests with the program of the thesis
40 times, with other noise of the sensors and of the points that are marked on the pictures by hand,
and prints two standard deviations of each norm. They are the margins of docs/papers/bayless.toml.
"""

import numpy as np

from boatsim.simulate import scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run

MARKING = 0.005  # [m] accuracy of marking a point by hand, about 5 mm (Bayless 2017)
RUNS = 40  # the standard deviation is known within 11 %
TESTS = [f"{kind}_{n}_as_published" for kind in ("sway", "yaw") for n in (1, 2, 3, 4)]


def scatter(test: str, runs: int = RUNS) -> dict[str, float]:
    """Return two standard deviations of each norm of a test over repeated runs.

    Args:
        test: Name of the scenario.
        runs: Number of runs.
    """
    name = f"joystick_boat/{test}"
    camera = scenario.load(name).file.camera
    values: dict[str, list[float]] = {}
    for seed in range(runs):
        repeated = scenario.load(name, {"camera": {**camera, "mark_sd": MARKING}})
        for norm, metric in requested_metrics(run(repeated, seed)).items():
            values.setdefault(norm, []).append(metric.value)
    return {norm: 2.0 * float(np.std(found)) for norm, found in values.items()}


def main() -> None:
    """Print the scatter of all eight tests."""
    for test in TESTS:
        cells = [f"{norm} {value:.4g}" for norm, value in scatter(test).items()]
        print(f"{test}: {', '.join(cells)}")


if __name__ == "__main__":
    main()
