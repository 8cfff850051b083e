"""Evaluate the joystick controller without a speed sensor.

    python -m benchmarks.blind [--boats 24] [--test sway_1]

The boats are those of the Monte Carlo study on the tests of the thesis: thrust 0.2 to 0.8 N at PWM 150
with an exponent of 1 to 1.6, drag coefficient 0.7 to 2.5, thrust astern 0.55 to 0.85 of that ahead,
motors shifted by up to 0.08 m, each steering angle wrong by up to 3 deg, yaw inertia 0.5 to 2 kg m2,
wind up to 0.5 m/s from any direction. Each boat identifies its motors in a separate run. Then it starts
from rest with the result, and once more without. The other tables contain all tests with six seeds as
shipped, and the effect of the noise of the speed logs on the motors while the boat sways.
"""

import argparse
from math import pi, radians
from typing import Any

import numpy as np

from boatsim.simulate import scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import Simulation, run
from boatsim.simulate.run_options import RunOptions

TESTS = [f"{kind}_{n}" for kind in ("sway", "yaw") for n in (1, 2, 3, 4)]
BELIEFS = {"rated_thrust": 0.35, "sway_thrust": 0.55}  # [N]
LONGEST = 90.0  # [s] maximum length of an identification
REQUIREMENTS = {
    "sway": (("surge_offset", 0.15), ("heading_at_end", 10.0)),
    "yaw": (("moved", 1.2), ("excursion", 1.2)),
}


def random_boat(test: str, rng: np.random.Generator) -> dict[str, Any]:
    """Return the settings of a scenario with a random boat in open water."""
    heavy, wide = test[-1] in "34", test in ("sway_2", "sway_4")
    thrust, power, drag, astern, shift, inertia, wind = rng.uniform(
        (0.2, 1.0, 0.7, 0.55, -0.08, 0.5, 0.0), (0.8, 1.6, 2.5, 0.85, 0.08, 2.0, 0.5)
    )
    off, toward = rng.uniform(-radians(3.0), radians(3.0), 2), rng.uniform(-pi, pi)
    x, y = (-0.571 if heavy else -0.5) + shift, 0.28 if wide else 0.19
    return {
        "duration": 120.0,
        "tank": {"length": 1e3, "width": 1e3},
        "set": {
            "pwm_thrust": {"at_span": thrust, "exponent": power},
            "cross_flow_drag": {"section_drag_coefficient": drag},
            "body": {"yaw_inertia": inertia},
            "port": {"x": x, "y": -y},
            "starboard": {"x": x, "y": y},
        },
        "effect": [
            {"use": "weak_reverse", "astern_factor": astern},
            {"use": "steering_offset", "port": off[0], "starboard": off[1]},
            {"use": "fan_wind", "speed": wind, "toward": toward, "arm": -0.066 if heavy else -0.02},
        ],
    }


def identified_controller(test: str, settings: dict[str, Any], seed: int) -> dict[str, Any]:
    """Return a controller with the motors of this boat identified in a separate run."""
    blind = {"use": "l1_joystick_blind", "check_pwm": 118.0, **BELIEFS}
    checked = scenario.load(
        f"joystick_boat/{test}_gyro", {**settings, "controller": blind, "until": {}, "goal": [{}]}
    )
    controller = checked.controller

    def tested() -> bool:
        return simulation.time > LONGEST or controller.check_result is not None

    simulation = Simulation(checked, RunOptions(seed=1000 + seed, stop=tested))
    simulation.run()
    astern, angle, scale = controller.check_result
    return {**blind, "known_astern": astern, "known_angle": angle, "known_scale": scale}


def study_table(test: str, boats: int) -> list[str]:
    """Return lines of the first table: median, 95 % and largest value of each required metric."""
    rng = np.random.default_rng(sum(map(ord, test)))
    found: dict[str, list[dict[str, float]]] = {"l1_joystick": [], "l1_joystick_blind": []}
    for seed in range(boats):
        settings = random_boat(test, rng)
        for controller in (
            {"use": "l1_joystick", **BELIEFS},
            identified_controller(test, settings, seed),
        ):
            made = scenario.load(
                f"joystick_boat/{test}_gyro", {**settings, "controller": controller}
            )
            found[controller["use"]].append(
                {n: abs(x.value or np.nan) for n, x in requested_metrics(run(made, seed)).items()}
            )
    lines = []
    for name, rows in found.items():
        cells = []
        for norm, limit in REQUIREMENTS[test.partition("_")[0]]:
            x = np.array([row[norm] for row in rows])
            cells.append("{:7.3f}{:7.3f}{:7.3f}".format(*np.percentile(x, (50, 95, 100))))
            cells.append(f"{100 * np.mean(x < limit):6.0f} %")
        lines.append(f"{test:8}{name:20}" + "".join(cells))
    return lines


def pwm_standard_deviations(test: str, controller: dict[str, Any]) -> str:
    """Return the standard deviations of both PWM values (of 255) after 6 s."""
    log = run(scenario.load(f"joystick_boat/{test}", {"controller": controller}), 0).recording
    port, starboard = (
        float(np.std(log[f"pwm_{side}"][log.t > 6.0])) for side in ("port", "starboard")
    )
    return f"{port:8.1f}{starboard:8.1f}"


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--boats", type=int, default=24)
    parser.add_argument("--test", choices=TESTS, action="append")
    given = parser.parse_args()
    print("random boats: median, 95 %, largest, share within the requirement")
    print(
        "  sway: surge offset [m] (0.15), heading [deg] (10); yaw: light moved [m], mass centre away [m] (both 1.2)"
    )
    for test in given.test or TESTS:
        print("\n".join(study_table(test, given.boats)), flush=True)
    print("\nas shipped, seeds 0 to 5: mean (largest)")
    for test in given.test or TESTS:
        rows = [
            requested_metrics(run(scenario.load(f"joystick_boat/{test}_blind"), seed))
            for seed in range(6)
        ]
        cells = []
        for norm, _ in REQUIREMENTS[test.partition("_")[0]]:
            x = np.array([row[norm].value for row in rows], dtype=float)
            cells.append(f"{norm} {x.mean():.3f} ({np.abs(x).max():.3f})")
        print(f"{test:8}" + ", ".join(cells), flush=True)
    print("\nrestlessness of the motors ahead and astern [PWM of 255]")
    for bandwidth in (0.5, 2.0):
        # a pole of 0.7 of the low-pass meets the L1-norm condition, as 1.4 1/s with 2 rad/s does
        law = {"use": "l1_joystick", "surge_bandwidth": bandwidth, "pole": 0.7 * bandwidth}
        print(
            f"l1_joystick, surge low-pass {bandwidth:g} rad/s"
            + pwm_standard_deviations("sway_1", law)
        )
    print(
        "l1_joystick_sway" + pwm_standard_deviations("sway_1_closed", {"use": "l1_joystick_sway"})
    )


if __name__ == "__main__":
    main()
