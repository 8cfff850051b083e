"""The L1 joystick beside a PID autopilot on the same 120 boats, over the eight manoeuvres of the scale boat's thesis.

python -m benchmarks.joystick_monte_carlo [--runs 120] [--jobs N] [--out out/joystick_monte_carlo]

Prints for every manoeuvre what each controller's norms are on 95 % of the boats and which is lower on how many, and
where L1 does not win. A killed run goes on where it was. The page with all figures is report.html in the folder.
"""

import argparse
import sys
from collections.abc import Mapping, Sequence
from math import inf, pi, radians

import numpy as np

import boatsim
from boatsim.cli.progress import counting
from boatsim.cli.show import printed
from boatsim.sweep.keys import Value

SCENARIOS = ["joystick_boat/sway_[1-4]", "joystick_boat/yaw_[1-4]"]
FIRST, SECOND = "pid_autopilot", "l1_joystick"
NORMS = {  # that the thesis' requirements and tables are about
    "sway": ["heading_at_end", "surge_offset", "yaw_rate_inf", "yaw_rate_l2", "time_to_end"],
    "yaw": ["moved", "position_inf", "position_rms", "excursion", "turn_time"],
}
VARIED: dict[str, str | Sequence[Value]] = {
    "controller.use": [FIRST, SECOND],
    "controller.rated_thrust": [0.35],  # [N] both believe the same
    "controller.sway_thrust": [0.55],  # [N]
    "tank.length": [50.0],  # [m] no wall holds a boat that drifts
    "tank.width": [50.0],
    "duration": [90.0],  # [s] the weakest boats need longer than the thesis' runs
}
SERVO = radians(3.0)
DRAWN = {
    "pwm_thrust.at_span": "uniform(0.2, 0.8)",  # [N] at PWM 150
    "pwm_thrust.exponent": "uniform(1.0, 1.6)",
    "cross_flow_drag.section_drag_coefficient": "uniform(0.7, 2.5)",
    "weak_reverse.astern_factor": "uniform(0.55, 0.85)",
    "port.x,starboard.x+": "uniform(-0.08, 0.08)",  # [m] both motors ahead or astern of where they are drawn
    "steering_offset.port": f"uniform({-SERVO:.5f}, {SERVO:.5f})",  # [rad]
    "steering_offset.starboard": f"uniform({-SERVO:.5f}, {SERVO:.5f})",
    "body.yaw_inertia": "uniform(0.5, 2.0)",  # [kg m^2]
    "fan_wind.speed": "uniform(0.0, 0.5)",  # [m/s]
    "fan_wind.toward": f"uniform({-pi:.5f}, {pi:.5f})",  # [rad]
}
HEAD = ["manoeuvre", "norm", "pid p95", "L1 p95", "L1 - pid, mean", "L1 lower", "pairs"]


def main(arguments: list[str] | None = None) -> int:
    """Carry out, print; 0 if all runs are done."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.joystick_monte_carlo", description="L1 beside PID.")
    parser.add_argument("--runs", type=int, default=120, help="boats for each manoeuvre")
    parser.add_argument("--jobs", type=int, default=None, help="runs at the same time")
    parser.add_argument("--out", default="out/joystick_monte_carlo", help="folder of the sweep")
    given = parser.parse_args(arguments)
    told = [name for names in NORMS.values() for name in names]
    with counting() as report:
        done = boatsim.sweep(
            SCENARIOS, VARIED, DRAWN, given.runs, "latin", 0, given.out, given.jobs, norms=told, report=report
        )
    rows, lost = _rows(done)
    printed(f"{SECOND} beside {FIRST}: sizes of the norms on {given.runs} boats", HEAD, rows, 2)
    print(f"{SECOND} is not lower on most boats, or the mean difference is not below 0 with 95 %, in:")
    print("\n".join(f"  {line}" for line in lost) or "  nothing")
    for why, count in done.failures.items():
        print(f"{count} runs failed: {why}")
    print(f"written to {given.out}: sweep.parquet, report.html")
    return 0 if done.complete else 130


def _rows(done: boatsim.Sweep) -> tuple[list[list[str]], list[str]]:
    """A row for each manoeuvre and norm, and where the second controller does not win."""
    columns = {name: np.array(values) for name, values in done.columns.items()}
    rows, lost = list[list[str]](), list[str]()
    for pair in done.pairs:
        scenario, name = str(pair.point[0]), pair.norm.strip("|")
        if name not in NORMS[scenario.rpartition("/")[2].partition("_")[0]]:
            continue
        ends = [_p95(columns, scenario, controller, name) for controller in (FIRST, SECOND)]
        called = f"{pair.norm} [{pair.unit}]"
        rows.append(
            [scenario.rpartition("/")[2], called, *(f"{end:.3g}" for end in ends),
             f"{pair.difference:+.2g} ± {pair.sure:.1g}", f"{100 * pair.second_lower:.0f} %", str(pair.pairs)]
        )  # fmt: skip
        if not (pair.second_lower > 0.5 and pair.difference + pair.sure < 0.0) and "time" not in name:
            lost.append(f"{rows[-1][0]} {called}: {pair.of_second:.3g} beside {pair.of_first:.3g}, "
                        f"lower on {100 * pair.second_lower:.0f} %")  # fmt: skip
    return rows, lost


def _p95(columns: Mapping[str, np.ndarray], scenario: str, controller: str, name: str) -> float:
    """95 % of the boats lie below; one that never got there lies above all."""
    among = (columns["scenario"] == scenario) & (columns["controller.use"] == controller)
    sizes = [inf if value is None else abs(value) for value in columns[name][among]]
    return float(np.quantile(sizes, 0.95, method="inverted_cdf"))


if __name__ == "__main__":
    sys.exit(main())
