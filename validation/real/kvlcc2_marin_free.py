"""A tanker's zig-zags and turning circle (MARIN, full-scale values): `python -m validation.real.kvlcc2_marin_free`.

The nominal is linear about the approach speed with published derivatives (the rigid hull's own centrifugal force, which
slows it in a turn, is exact), the baseline the same structure with all its coefficients refitted. Fitted on zig-zags
zz_10, zz_m10, zz_m20, judged on 600 s of the turning circle tc_35 as one free run: speed and yaw rate, since the
positions have steps of 10 m. The circle goes far below any speed of the fit.
"""

from collections.abc import Mapping

import numpy as np

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.evaluation import models
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Array
from validation.real.common import report, runs_of, table

NAME = "kvlcc2_marin_free"
HORIZON = 400.0  # [s] of a free run: ten lengths
FITTED = ("zz_10", "zz_m10", "zz_m20")
UNSEEN = "tc_35"
DURATION = 600.0  # [s]
GOALS = {"speed [m/s]": 0.35, "yaw rate [deg/s]": 0.09}
SHARE = 0.15  # of the linear model's error


def turn(found: Diagnosis, model: Fit, circle: MappedRecording) -> Array:
    """Rms errors of speed [m/s] and yaw rate [deg/s] over one free run of the circle."""
    on = found.problem.program.switches(model.effects)
    values = found.problem.values(circle, model.free, model.theta)
    first, y = circle.free_runs(values, on, model.levels, DURATION)[0]
    recorded = circle.measured[first : first + len(y)]
    off = np.column_stack(
        [
            y[:, 3] - recorded[:, circle.signals.index("u_mps")],
            y[:, 5] - recorded[:, circle.signals.index("r_radps")],
        ]
    )
    return np.asarray(np.sqrt(np.mean(off**2, axis=0)) * [1.0, np.degrees(1.0)])


def print_circle(
    found: Diagnosis, circle: MappedRecording, goals: Mapping[str, float], header: str = "goal"
) -> None:
    """The turning circle kept unseen, against the goals for speed and yaw rate."""
    nominal, before, after = (turn(found, f, circle) for f in models(found.ranking).values())
    rows = [
        [
            what,
            *(f"{x[i]:.3f}" for x in (nominal, before, after)),
            f"{after[i] / before[i]:.3f}",
            f"<= {goal}",
        ]
        for i, (what, goal) in enumerate(goals.items())
    ]
    columns = [
        "rms error",
        "as published",
        "recalibrated",
        "patched",
        "patched / recalibrated",
        header,
    ]
    table(
        f"fitted on {', '.join(FITTED)}, unseen {UNSEEN}, one free run of {DURATION:g} s",
        columns,
        rows,
    )


def main() -> None:
    """Diagnose the zig-zags, judge on the circle."""
    runs = runs_of(NAME)
    found = pipeline.diagnose([runs[n] for n in FITTED], [runs[UNSEEN]], horizon=HORIZON)
    report(found, NAME)
    recording, boat = loading.open_recording(runs[UNSEEN], None, ())
    circle = found.map_recording(recording.thinned(priors.rate(boat)))
    print_circle(found, circle, GOALS, f"goal (and <= {SHARE})")
    speed = circle.measured[circle.times <= DURATION, circle.signals.index("u_mps")]
    kept = float(np.sqrt(np.mean((speed - speed[0]) ** 2)))
    print(f"(a strictly linear hull keeps its approach speed: {kept:.3f} m/s rms)")
    gains = sorted(found.ranking.named, key=lambda n: -n.gain)
    table(
        "couplings in order of gain",
        ["entry", "gain [nats]"],
        [[n.name, f"{n.gain:.0f}"] for n in gains],
    )


if __name__ == "__main__":
    main()
