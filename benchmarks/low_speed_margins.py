"""Print margins of the water-jet craft's heading control: `python -m benchmarks.low_speed_margins`.

The first table has crossover frequency, phase margin and delay margin of the exact sampled loop,
opened at the yaw acceleration, for PD and L1 with and without wave filter. The second has the delay
margins of PD and L1 with the filter if the input gain omega (true over assumed) or the time constant
T_n of the craft differs from the assumed one.
"""

from dataclasses import replace
from math import degrees
from typing import Any

from rich.console import Console
from rich.table import Table

from boatsim.control.adaptive import LoopMargins, SampledLoop, loop_margins
from boatsim.physics.content import load_class

LAWS = {  # switches of the controller
    "PD, no filter": {"adaptive": 0.0, "wave_filter": 0.0},
    "PD + filter": {"adaptive": 0.0},
    "L1, no filter": {"wave_filter": 0.0},
    "L1 + filter": {},
}
GAINS = (0.1, 0.5, 0.7, 1.0, 1.3, 1.6, 2.0, 5.0)
TIME_CONSTANTS = (0.5, 0.8, 1.67, 2.5, 4.0)  # [s]


def control_loop(**switches: float) -> SampledLoop:
    """Return the loop of a controller with these switches, on the craft that it assumes."""
    controller: Any = load_class("controller", "l1_heading_discrete")(**switches)
    (found,) = controller.feedback_loops()
    assert isinstance(found, SampledLoop)
    return found


def margins(of: SampledLoop, gain: float = 1.0, time_constant: float | None = None) -> LoopMargins:
    """Return the margins for a craft with another input gain or time constant [s] than assumed."""
    craft = replace(of, damping=1.0 / time_constant) if time_constant else of
    return loop_margins(craft.open_loop_response(gain), high=craft.highest_frequency)


def main() -> None:
    """Print both tables."""
    table = Table("controller", "crossover rad/s", "phase margin deg", "delay margin s")
    for name, switches in LAWS.items():
        m = margins(control_loop(**switches))
        table.add_row(name, f"{m.crossover:.3f}", f"{degrees(m.phase):.1f}", f"{m.delay:.2f}")
    Console().print(table)
    table = Table("craft", "L1 delay margin s", "PD delay margin s")
    pair = (control_loop(), control_loop(adaptive=0.0))
    cases: list[dict[str, float]] = [{"gain": g} for g in GAINS] + [
        {"time_constant": t} for t in TIME_CONSTANTS
    ]
    for case in cases:
        words = ", ".join(f"{'omega' if k == 'gain' else 'T_n'} {x:g}" for k, x in case.items())
        found = [margins(one, **case) for one in pair]
        table.add_row(words, *(f"{m.delay:.2f}" if m.stable else "unstable" for m in found))
    Console().print(table)


if __name__ == "__main__":
    main()
