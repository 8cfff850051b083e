"""Print the robustness of the L1 loops of the high-speed water-jet craft: `python -m benchmarks.svendsen`.

The tables contain the L1-norm condition of the cruise control against its bandwidth (Fig. 8) and the
bandwidth that satisfies it; the effect of a delay of the jet on the heading control, against its
bandwidth; and the effect of the control period on both.
"""

import numpy as np
from scipy.optimize import brentq

from boatsim.physics.content import load_class
from boatsim.simulate import scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import run

BANDWIDTHS = (
    5.0, 10.0, 11.0, 12.0, 12.2, 13.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0,
)  # fmt: skip  # [1/s] k_u
DELAYS = (0.002, 0.004, 0.006, 0.010, 0.020)  # [s]
FILTERS = (80.0, 40.0, 20.0, 10.0)  # [1/s] k_h
PERIODS = (0.0005, 0.001, 0.002, 0.004, 0.008)  # [s]


def l1_condition(bandwidth: float) -> float:
    """Return L1 norm times slope of the cruise control at a bandwidth [1/s]."""
    found: float = load_class("controller", "l1_cruise")(bandwidth=bandwidth).l1_condition()
    return found


def limiting_bandwidth() -> float:
    """Return the bandwidth [1/s] at which the condition equals 1."""
    return float(brentq(lambda bandwidth: l1_condition(bandwidth) - 1.0, 5.0, 60.0))


def metric_with_changes(name: str, norm: str, **changes: object) -> float:
    """Return a metric of a scenario with some of its top-level keys replaced."""
    found = requested_metrics(run(scenario.load(f"jet_ski/{name}", changes), 0))[norm].value
    return float("nan") if found is None else found


def scenario_changes(name: str, **settings: float) -> dict[str, object]:
    """Return changes of a scenario: settings of its controller, and a matching integration step."""
    own = scenario.load(f"jet_ski/{name}").file.controller | settings
    return {"controller": own, "step": min(settings.get("period", 0.002), 0.004)}


def rate_with_delay(bandwidth: float, delay: float) -> float:
    """Return the rms rate [deg/s] of the jet's command on the sine with a command delay [s]."""
    effects = [{"use": "command_delay", "delay": delay}]
    return metric_with_changes(
        "heading_delay",
        "rate_rms",
        effect=effects,
        **scenario_changes("heading_delay", bandwidth=bandwidth),
    )


def main() -> None:
    """Print the tables."""
    print("k_u [1/s]   L1 norm x slope")
    for bandwidth in BANDWIDTHS:
        print(f"{bandwidth:9.1f}   {l1_condition(bandwidth):.3f}")
    print(f"satisfied for k_u above {limiting_bandwidth():.2f} 1/s\n")
    print("rms rate of the jet's command [deg/s] along the sine, no rate limit; delay [ms]")
    print("k_h [1/s]" + "".join(f"{1e3 * delay:9.0f}" for delay in DELAYS))
    for bandwidth in FILTERS:
        print(
            f"{bandwidth:9.0f}"
            + "".join(f"{rate_with_delay(bandwidth, delay):9.1f}" for delay in DELAYS),
            flush=True,
        )
    print(
        "\ncontrol step [ms]   staircase: first and last time to 95 % [s]   heading sine: rms to the model [deg]"
    )
    for period in PERIODS:
        stairs = requested_metrics(
            run(scenario.load("jet_ski/staircase", scenario_changes("staircase", period=period)), 0)
        )
        times = [stairs[f"time_95_{i}"].value or np.nan for i in (1, 5)]
        sine = metric_with_changes(
            "heading_sine", "rms", **scenario_changes("heading_sine", period=period)
        )
        print(f"{1e3 * period:17.1f}   {times[0]:.3f}  {times[1]:.3f}{sine:37.4f}", flush=True)


if __name__ == "__main__":
    main()
