"""Correlation time of the latent force: `python -m validation.real.time_constant [SET ...]`.

The rule is that of every diagnosis (`boatsim.diagnosis.correlation_time`). The missing effects are
selected with the default value for a hull of this length. Each half of the fitted recordings is
predicted by a fit of the other half, and the value is halved or doubled as long as that predicts
clearly better. This script prints the error for every value and marks the selected one. The
recordings on which the other benchmarks are judged are not read.
"""

import sys
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, priors
from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.correlation_time import (
    cross_validated_correlation_time,
    cross_validation_errors,
)
from boatsim.diagnosis.prior_noise import prior_noise_levels, shared_noise
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import select_effects
from boatsim.physics.program import Program
from validation.real import blueboat_lake, kvlcc2_hsva_zigzag, kvlcc2_marin_free
from validation.real.common import print_table, runs_except, runs_of

HELD_OUT = {
    blueboat_lake.NAME: blueboat_lake.HELD_OUT,
    kvlcc2_hsva_zigzag.NAME: kvlcc2_hsva_zigzag.HELD_OUT,
    kvlcc2_marin_free.NAME: (kvlcc2_marin_free.HELD_OUT,),
}
VESSELS = {blueboat_lake.NAME: blueboat_lake.VESSEL}  # the other recordings name their vessel


def problem_of(paths: list[Path], vessel_name: str | None) -> Problem:
    """Return the estimation problem of a diagnosis of some recordings."""
    opened = [loading.open_recording(path, vessel_name, ()) for path in paths]
    first, vessel = opened[0]
    program = Program(vessel, candidate_library(vessel).compiled_effects)
    noise, rate = shared_noise(vessel, [first]), priors.downsampling_rate(vessel)
    recordings = [map_recording(run.thinned(rate), program, noise) for run, _ in opened]
    uncertainty = priors.coefficient_uncertainty(vessel) | first.notes.coefficient_uncertainty
    return Problem(recordings, prior_noise_levels(vessel, [first]), uncertainty)


def main() -> None:
    """Print one table per set."""
    steps = DEFAULT.fit.correlation_time_steps
    for name in sys.argv[1:] or HELD_OUT:
        problem = problem_of(runs_except(runs_of(name), HELD_OUT[name]), VESSELS.get(name))
        _, best = select_effects(problem, problem.program.candidate_names)
        usual = problem.ambient.time_constant
        selected = cross_validated_correlation_time(problem, best)
        rows = []
        for step in range(-steps, steps + 1):
            seconds = usual * 2.0**step
            error = float(np.exp(np.mean(np.log(cross_validation_errors(problem, best, seconds)))))
            rows.append([f"{seconds:.2g}", f"{error:.4g}", "*" if seconds == selected else ""])
        title = f"{name}: with the default {usual:.2g} s {problem.program.vessel.name} lacks "
        header = ["time constant [s]", "error of the other half", "selected"]
        print_table(title + ", ".join(best.effects), header, rows)


if __name__ == "__main__":
    main()
