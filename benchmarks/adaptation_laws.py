"""Comparison of two adaptive laws of the L1 joystick: piecewise-constant, and gradient projection.

Run `python -m benchmarks.adaptation_laws`. It prints the errors of `l1_joystick` and
`l1_joystick_projection` in the eight tests of the joystick boat (mean of three seeds), and then the
errors of `l1_joystick_projection` with one of its corrections of the thesis undone. The last column
is the share of 100 randomly drawn boats that survive the manoeuvre of `boatsim robustness` without
any disturbance.
"""

from collections.abc import Mapping
from math import inf

from boatsim.cli.metric_table import print_text_table
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.simulate import scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run
from boatsim.sweeps.robustness.benchmark import run_benchmark

SEEDS = 3
BOATS = 100
SWAY, YAW = [f"sway_{n}" for n in (1, 2, 3, 4)], [f"yaw_{n}" for n in (1, 2, 3, 4)]
ERRORS = {
    "sway": ("yaw_rate_inf", "yaw_rate_l2", "heading_at_end", "surge_offset"),
    "yaw": ("moved", "position_inf", "position_rms", "excursion"),
}
SHIPPED, PROJECTION = "l1_joystick", "l1_joystick_projection"
# gains of the projection law, so that the laws alone differ
SAME_GAINS = {"pole": 1.4, "yaw_bandwidth": 2.0, "surge_bandwidth": 2.0, "heading_gain": 0.2}
# name in the table: controller, whether the sway velocity is measured, gains
LAWS: dict[str, tuple[str, bool, dict[str, float | bool]]] = {
    f"{SHIPPED}, the same gains": (SHIPPED, False, {**SAME_GAINS}),
    PROJECTION: (PROJECTION, False, {}),
    f"{PROJECTION}, drift log": (PROJECTION, True, {}),
}
# A published value in the place of a corrected one; the bounds are those of the yaw estimates
PUBLISHED: dict[str, dict[str, float | bool]] = {
    "none": {},
    "one Euler step a period": {"adaptation_step": 0.08},
    "bounds": {
        "omega_low": 1.0,
        "omega_high": 1.5,
        "theta_low": 0.5,
        "theta_high": 2.0,
        "sigma_low": 0.01,
        "sigma_high": 0.2,
    },
    "feed-forward": {"feed_forward_as_published": True},
    "input of the predictor": {"input_as_published": True},
    "bandwidth": {"yaw_bandwidth": 0.379, "surge_bandwidth": 0.379},
}


def mean_errors(
    test: str, controller: str, drift_log: bool, settings: Mapping[str, float | bool]
) -> dict[str, float]:
    """Return the mean size of each error of a test over the seeds; infinite if it never ended.

    Args:
        test: Name of the test, such as "sway_1".
        controller: Name of the controller.
        drift_log: Whether the sway velocity is measured.
        settings: Parameters of the controller.
    """
    changes: dict[str, object] = {"controller": {"use": controller, **settings}}
    if drift_log:
        changes["sensor"] = [{"use": "drift_log"}]
    case = scenario.load(f"joystick_boat/{test}", changes)
    total = dict.fromkeys(ERRORS[test.partition("_")[0]], 0.0)
    for seed in range(SEEDS):
        found = requested_metrics(run(case, seed))
        for name in total:
            value = found[name].value
            total[name] += inf if value is None else abs(value) / SEEDS
    return total


def print_tests() -> None:
    """Print the errors of both laws in the eight tests."""
    for kind, tests in (("sway", SWAY), ("yaw", YAW)):
        rows = []
        for test in tests:
            for law, (controller, drift_log, gains) in LAWS.items():
                errors = mean_errors(test, controller, drift_log, gains)
                rows.append([test, law, *(f"{value:.3g}" for value in errors.values())])
        print_text_table(f"{kind} tests, mean of {SEEDS} seeds", ["", "", *ERRORS[kind]], rows, 2)


def surviving_share(settings: Mapping[str, float | bool]) -> float:
    """Return the share of drawn boats that survive the standard manoeuvre without disturbance.

    Args:
        settings: Parameters of `l1_joystick_projection`.
    """
    controller = load_class("controller", PROJECTION).from_settings(settings)
    # `l1_joystick` decides which signals are judged
    both = {SHIPPED: load_class("controller", SHIPPED)(**SAME_GAINS), PROJECTION: controller}
    found = run_benchmark(both, load_vessel("joystick_boat"), BOATS, ladders={"delay": [0.0]})
    return found.ladder(PROJECTION, "delay").points[0].share


def print_corrections() -> None:
    """Print what each correction of the thesis changes."""
    rows = []
    for name, settings in PUBLISHED.items():
        sway = [mean_errors(test, PROJECTION, True, settings) for test in SWAY]
        yaw = [mean_errors(test, PROJECTION, True, settings) for test in YAW]
        errors = [
            max(found["yaw_rate_l2"] for found in sway),
            max(found["heading_at_end"] for found in sway),
            max(found["position_inf"] for found in yaw),
        ]
        share = surviving_share(settings)
        rows.append([name, *(f"{value:.3g}" for value in errors), f"{100 * share:.0f} %"])
    head = ["as published", "yaw_rate_l2 [deg/s]", "heading [deg]", "position_inf [m]", "survivors"]
    print_text_table("largest error of the four sway and the four yaw tests", head, rows, 1)


def main() -> None:
    """Print both tables."""
    print_tests()
    print_corrections()


if __name__ == "__main__":
    main()
