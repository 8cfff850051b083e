"""Zig-zags and turning circle of a tanker: `python -m validation.real.kvlcc2_marin_free`.

The recordings are full-scale values of MARIN. The nominal is linear about the approach speed with
published derivatives; the centrifugal force of the rigid hull, which slows it in a turn, is exact.
The baseline is the same structure with all its coefficients refitted. The zig-zags zz_10, zz_m10
and zz_m20 are fitted. The turning circle tc_35 is held out: 600 s of it are predicted as one free
run and judged by speed and yaw rate, because the positions have steps of 10 m. In the circle the
speed falls far below any speed of the fit.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from validation.real.common import (
    MODEL_COLUMNS,
    format_fixed,
    print_table,
    runs_named,
    runs_of,
    write_report,
)

NAME = "kvlcc2_marin_free"
HORIZON = 400.0  # [s] of a free run: ten lengths
FITTED = ("zz_10", "zz_m10", "zz_m20")
HELD_OUT = "tc_35"
DURATION = 600.0  # [s]
GOALS = {"speed [m/s]": 0.35, "yaw rate [deg/s]": 0.09}
SHARE = 0.15  # of the linear model's error


def turn_errors(diagnosis: Diagnosis, model: Fit, circle: MappedRecording) -> Array:
    """Return the rms errors of speed [m/s] and yaw rate [deg/s] over one free run of the circle."""
    problem = diagnosis.problem
    on = problem.program.effect_switches(model.effects)
    values = problem.parameter_vector(circle, model.free, model.theta)
    first, states = circle.free_runs(values, on, model.levels, DURATION)[0]
    columns = [circle.signals.index("u_mps"), circle.signals.index("r_radps")]
    off = states[:, [3, 5]] - circle.measured[first : first + len(states)][:, columns]
    return np.asarray(np.sqrt(np.mean(off**2, axis=0)) * [1.0, np.degrees(1.0)])


def print_circle(
    diagnosis: Diagnosis, circle: MappedRecording, goals: Mapping[str, float], header: str = "goal"
) -> None:
    """Print the errors on the held-out turning circle with the goals for speed and yaw rate."""
    fits = compared_fits(diagnosis.ranking).values()
    by_model = [turn_errors(diagnosis, fit, circle) for fit in fits]
    rows = []
    for (what, goal), off in zip(goals.items(), np.transpose(by_model), strict=True):
        rows.append([what, *format_fixed(3, *off, off[2] / off[1]), f"<= {goal}"])
    columns = ["rms error", "as published", *MODEL_COLUMNS, header]
    title = f"fitted on {', '.join(FITTED)}, held out {HELD_OUT}, one free run of {DURATION:g} s"
    print_table(title, columns, rows)


def main() -> None:
    """Diagnose the zig-zags and judge on the circle."""
    runs = runs_of(NAME)
    diagnosis = pipeline.diagnose(runs_named(runs, FITTED), [runs[HELD_OUT]], horizon=HORIZON)
    write_report(diagnosis, NAME)
    recording, vessel = loading.open_recording(runs[HELD_OUT], None, ())
    circle = diagnosis.map_recording(recording.thinned(priors.downsampling_rate(vessel)))
    print_circle(diagnosis, circle, GOALS, f"goal (and <= {SHARE})")
    speed = circle.measured[circle.times <= DURATION, circle.signals.index("u_mps")]
    rms = float(np.sqrt(np.mean((speed - speed[0]) ** 2)))
    print(f"(a strictly linear hull keeps its approach speed: {rms:.3f} m/s rms)")
    gains = sorted(diagnosis.ranking.named, key=lambda effect: -effect.gain)
    rows = [[effect.name, f"{effect.gain:.0f}"] for effect in gains]
    print_table("couplings in order of gain", ["effect", "gain [nats]"], rows)


if __name__ == "__main__":
    main()
