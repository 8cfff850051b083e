"""Comparison of the L1 joystick with a PID autopilot on the same 120 boats and eight manoeuvres.

python -m benchmarks.joystick_monte_carlo [--runs 120] [--jobs N] [--out out/joystick_monte_carlo]
[--plot FILE.svg] [--rivals]

The manoeuvres are those of the scale boat's thesis. For each, the script prints the 95th percentile
of every metric for both controllers, and the number of boats on which each is lower. It then lists
where L1 is not better. With `--rivals` the other joystick controllers run on the same boats, and the
script prints the mean difference of each from the PID autopilot over the four manoeuvres of a kind.
An interrupted run resumes. The page with all figures is report.html in the
folder.
"""

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from math import inf, pi, radians
from pathlib import Path

import numpy as np

import boatsim
from boatsim.cli.metric_table import print_text_table
from boatsim.cli.progress import show_task_progress
from boatsim.physics.signals import Array
from boatsim.sweeps.keys import Value
from boatsim.view.svg_plots import round_ticks

SCENARIOS = ["joystick_boat/sway_[1-4]", "joystick_boat/yaw_[1-4]"]
FIRST, SECOND = "pid_autopilot", "l1_joystick"
RIVALS = [FIRST, SECOND, "adrc", "indi", "lqi", "mpc"]
NORMS = {  # metrics of the thesis' requirements and tables
    "sway": ["heading_at_end", "surge_offset", "yaw_rate_inf", "yaw_rate_l2", "time_to_end"],
    "yaw": ["moved", "position_inf", "position_rms", "excursion", "turn_time"],
}
VARIED: dict[str, str | Sequence[Value]] = {
    "controller.use": [FIRST, SECOND],
    "controller.rated_thrust": [0.35],  # [N] the same in both controllers
    "controller.sway_thrust": [0.55],  # [N]
    "tank": ["none"],  # no walls, so that a drifting boat is not stopped
    "engine": ["twin"],  # compiled engine, equal up to rounding
    "log": [0.1],  # [s]
    "duration": [90.0],  # [s] the weakest boats need longer than the thesis' runs
}
SERVO = radians(3.0)
DRAWN = {
    "pwm_thrust.at_span": "uniform(0.2, 0.8)",  # [N] at PWM 150
    "pwm_thrust.exponent": "uniform(1.0, 1.6)",
    "cross_flow_drag.section_drag_coefficient": "uniform(0.7, 2.5)",
    "weak_reverse.astern_factor": "uniform(0.55, 0.85)",
    # [m] offset of both motors ahead or astern
    "port.x,starboard.x+": "uniform(-0.08, 0.08)",
    "steering_offset.port": f"uniform({-SERVO:.5f}, {SERVO:.5f})",  # [rad]
    "steering_offset.starboard": f"uniform({-SERVO:.5f}, {SERVO:.5f})",
    "body.yaw_inertia": "uniform(0.5, 2.0)",  # [kg m^2]
    "fan_wind.speed": "uniform(0.0, 0.5)",  # [m/s]
    "fan_wind.toward": f"uniform({-pi:.5f}, {pi:.5f})",  # [rad]
}
HEAD = ["manoeuvre", "metric", "pid p95", "L1 p95", "L1 - pid, mean", "L1 lower", "pairs"]


def main(arguments: list[str] | None = None) -> int:
    """Run the sweep and print; return 0 if all runs are done."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.joystick_monte_carlo", description="Compare L1 and PID."
    )
    parser.add_argument("--runs", type=int, default=120, help="boats for each manoeuvre")
    parser.add_argument("--jobs", type=int, default=None, help="runs at the same time")
    parser.add_argument("--out", default="out/joystick_monte_carlo", help="folder of the sweep")
    parser.add_argument(
        "--plot", type=Path, help="write a chart of both controllers' metrics to this SVG file"
    )
    parser.add_argument(
        "--rivals", action="store_true", help=f"compare {', '.join(RIVALS)} (three times as long)"
    )
    given = parser.parse_args(arguments)
    told = [name for names in NORMS.values() for name in names]
    varied = dict(VARIED)
    if given.rivals:
        varied["controller.use"] = RIVALS
    with show_task_progress() as report:
        done = boatsim.sweep(
            SCENARIOS,
            varied,
            DRAWN,
            given.runs,
            "latin",
            0,
            given.out,
            given.jobs,
            norms=told,
            report=report,
        )
    if given.rivals:
        rows = _rival_rows(done)
        title = f"mean difference from {FIRST} with 95 % interval, and share of boats with less"
        print_text_table(title, ["manoeuvres", "metric", FIRST, *RIVALS[1:]], rows, 2)
        print(f"written to {given.out}: sweep.parquet, report.html")
        return 0 if done.complete else 130
    rows, lost = _rows(done)
    print_text_table(
        f"{SECOND} beside {FIRST}: sizes of the metrics on {given.runs} boats", HEAD, rows, 2
    )
    print(
        f"{SECOND} is not lower on most boats, or the mean difference is not below 0 with 95 %, in:"
    )
    print("\n".join(f"  {line}" for line in lost) or "  nothing")
    for why, count in done.failures.items():
        print(f"{count} runs failed: {why}")
    if given.plot and done.complete:
        given.plot.write_text(_picture(done), encoding="utf-8")
    print(f"written to {given.out}: sweep.parquet, report.html")
    if done.complete:
        return 0
    return 130


def _rival_rows(done: boatsim.Sweep) -> list[list[str]]:
    """Return a row for each kind of manoeuvre and metric, with a cell for each controller."""
    columns = {name: np.array(values) for name, values in done.columns.items()}
    scenarios = list(dict.fromkeys(columns["scenario"].tolist()))
    rows = []
    for kind, names in NORMS.items():
        manoeuvres = [scenario for scenario in scenarios if f"/{kind}_" in scenario]
        for name in names:
            sizes = {}
            for controller in RIVALS:
                each = [_sizes(columns, scenario, controller, name) for scenario in manoeuvres]
                sizes[controller] = np.array(each)  # (manoeuvres, boats)
            cells = [kind, f"|{name}| [{done.results.units[name]}]"]
            finite = sizes[FIRST][np.isfinite(sizes[FIRST])]
            cells.append(f"{finite.mean():.3g}")
            for controller in RIVALS[1:]:
                cells.append(_difference(sizes[FIRST], sizes[controller]))
            rows.append(cells)
    return rows


def _difference(first: Array, second: Array) -> str:
    """Mean difference of two controllers (manoeuvres, boats), by boats, and who is lower."""
    reached = np.isfinite(first) & np.isfinite(second)
    change = np.where(reached, second - first, np.nan)
    by_boat = np.nanmean(change[:, reached.any(axis=0)], axis=0)
    sure = 1.96 * float(np.std(by_boat, ddof=1)) / np.sqrt(len(by_boat))
    lower = float(np.mean((second < first)[reached]))
    return f"{np.mean(by_boat):+.2g} ± {sure:.1g}, {100.0 * lower:.0f} %"


def _sizes(columns: Mapping[str, Array], scenario: str, controller: str, name: str) -> list[float]:
    """Return the size of a metric on each boat; infinite if the boat never reached the goal."""
    among = (columns["scenario"] == scenario) & (columns["controller.use"] == controller)
    return [inf if value is None else abs(value) for value in columns[name][among]]


def _rows(done: boatsim.Sweep) -> tuple[list[list[str]], list[str]]:
    """Return a row for each manoeuvre and metric, and where the second controller is not better."""
    columns = {name: np.array(values) for name, values in done.columns.items()}
    rows, lost = list[list[str]](), list[str]()
    for pair in done.pairs:
        scenario, name = str(pair.point[0]), pair.norm.strip("|")
        if name not in NORMS[scenario.rpartition("/")[2].partition("_")[0]]:
            continue
        ends = [_p95(columns, scenario, controller, name) for controller in (FIRST, SECOND)]
        called = f"{pair.norm} [{pair.unit}]"
        rows.append(
            [
                scenario.rpartition("/")[2],
                called,
                *(f"{end:.3g}" for end in ends),
                f"{pair.difference:+.2g} ± {pair.sure:.1g}",
                f"{100 * pair.second_lower:.0f} %",
                str(pair.pairs),
            ]
        )
        if (
            not (pair.second_lower > 0.5 and pair.difference + pair.sure < 0.0)
            and "time" not in name
        ):
            lost.append(
                f"{rows[-1][0]} {called}: {pair.of_second:.3g} beside {pair.of_first:.3g}, "
                f"lower on {100 * pair.second_lower:.0f} %"
            )
    return rows, lost


def _p95(columns: Mapping[str, Array], scenario: str, controller: str, name: str) -> float:
    """Return the 95th percentile; boats that never reached the goal count as the largest."""
    return float(
        np.quantile(_sizes(columns, scenario, controller, name), 0.95, method="inverted_cdf")
    )


# The picture
# -----------------------------------------------------------------------------

DRAWN_NORMS = {
    "sway": ("heading_at_end", "surge_offset", "yaw_rate_l2"),
    "yaw": ("moved", "position_inf", "excursion"),
}
WIDE, HIGH, LEFT, TOP = 300, 170, 44, 46  # [px] panel size, left and top margins
LOOKS = {FIRST: "#0067b1", SECOND: "#c65102"}
BELOW = (0.05, 0.25, 0.5, 0.75, 0.95)
STYLE = (
    "text{font:12px system-ui,Helvetica,Arial,sans-serif;"
    "fill:#59636e}.title{font-weight:600;fill:#16202a}"
    ".middle{text-anchor:middle}.end{text-anchor:end}path{fill:none}.grid{stroke:#8a94a04d}"
    "@media(prefers-color-scheme:dark){text{fill:#a8b1bb}.title{fill:#e8ecef}}"
)


def _picture(done: boatsim.Sweep) -> str:
    """Draw boxes of both controllers for each manoeuvre, one panel for each metric.

    A box holds half of the boats, the whiskers 90 %.
    """
    columns = {name: np.array(values) for name, values in done.columns.items()}
    width, height = 3 * (WIDE + LEFT) + 10, 2 * (HIGH + TOP) + 40
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} '
        f'{height}"><style>{STYLE}</style>'
    ]
    parts.append(
        "<title>Metrics of the PID autopilot and of the L1 joystick on the same boats</title>"
    )
    for row, (kind, names) in enumerate(DRAWN_NORMS.items()):
        for column, name in enumerate(names):
            x, y = LEFT + column * (WIDE + LEFT), TOP + row * (HIGH + TOP)
            scenarios = [s for s in dict.fromkeys(columns["scenario"].tolist()) if f"/{kind}_" in s]
            parts += _panel(columns, scenarios, name, done.results.units[name], x, y)
    for k, (name, colour) in enumerate(LOOKS.items()):
        parts.append(f'<rect x="{LEFT + 170 * k}" y="8" width="14" height="10" fill="{colour}"/>')
        parts.append(f'<text x="{LEFT + 20 + 170 * k}" y="17">{name}</text>')
    return "\n".join([*parts, "</svg>", ""])


def _panel(
    columns: Mapping[str, Array], scenarios: Sequence[str], name: str, unit: str, x: int, y: int
) -> Iterator[str]:
    """Draw one metric over its manoeuvres."""
    spread = {
        (s, c): np.quantile(_sizes(columns, s, c, name), BELOW, method="inverted_cdf")
        for s in scenarios
        for c in LOOKS
    }
    top = 1.08 * max(float(ends[-1]) for ends in spread.values())
    size = bool((np.array([v for v in columns[name] if v is not None]) < 0.0).any())
    yield f'<text class="title" x="{x}" y="{y - 8}">{f"|{name}|" if size else name} [{unit}]</text>'
    for tick in round_ticks(0.0, top, 4):
        down = y + HIGH * (1.0 - tick / top)
        yield f'<path class="grid" d="M{x} {down:.1f}h{WIDE}"/>'
        yield f'<text class="end" x="{x - 5}" y="{down + 4:.1f}">{tick:g}</text>'
    for at, scenario in enumerate(scenarios):
        middle = x + WIDE * (at + 0.5) / len(scenarios)
        yield (
            f'<text class="middle" x="{middle:.1f}" '
            f'y="{y + HIGH + 15}">{scenario.rpartition("/")[2]}</text>'
        )
        for side, (controller, colour) in zip((-13, 13), LOOKS.items(), strict=True):
            low, lower, half, upper, high = (
                y + HIGH * (1.0 - v / top) for v in spread[scenario, controller]
            )
            c = middle + side
            yield (
                f'<path stroke="{colour}" stroke-width="1.6" d="M{c} '
                f"{low:.1f}V{lower:.1f}M{c} {upper:.1f}V{high:.1f}"
                f'M{c - 9} {lower:.1f}h18V{upper:.1f}h-18ZM{c - 9} {half:.1f}h18"/>'
            )


if __name__ == "__main__":
    sys.exit(main())
