"""The latent force's correlation time on the real recordings: `python -m validation.real.time_constant [SET ...]`.

The rule is that of every diagnosis (`boatsim.diagnosis.correlation_time`): what is missing is chosen with the usual
value of a hull of this length, each half of the fitted recordings is predicted by a fit of the other half, and the
value is halved or doubled as long as that predicts clearly better. Here the error with every value is printed beside
the one that is taken. The recordings on which the other benchmarks judge are not opened.
"""

import sys
from pathlib import Path

import numpy as np

from boatsim.diagnosis import loading, priors
from boatsim.diagnosis.candidates import library_for
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.correlation_time import correlation_time, halves_errors
from boatsim.diagnosis.filter import map_recording, prior_levels, shared_noise
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.search.ranking import selection
from boatsim.physics.program import Program
from validation.real import blueboat_lake, kvlcc2_hsva_zigzag, kvlcc2_marin_free
from validation.real.common import runs_of, table

UNSEEN = {
    blueboat_lake.NAME: blueboat_lake.UNSEEN,
    kvlcc2_hsva_zigzag.NAME: kvlcc2_hsva_zigzag.UNSEEN,
    kvlcc2_marin_free.NAME: (kvlcc2_marin_free.UNSEEN,),
}
VESSELS = {blueboat_lake.NAME: blueboat_lake.VESSEL}  # the others' recordings name theirs


def problem_of(paths: list[Path], vessel: str | None) -> Problem:
    """The question of a diagnosis of some recordings."""
    opened = [loading.open_recording(path, vessel, ()) for path in paths]
    boat, first = opened[0][1], opened[0][0]
    program = Program(boat, library_for(boat).compiled)
    stated = shared_noise(boat, [first])
    tracks = [map_recording(run.thinned(priors.rate(boat)), program, stated) for run, _ in opened]
    uncertainty = priors.uncertainty(boat)
    return Problem(
        tracks, prior_levels(boat, [first]), uncertainty | first.notes.coefficient_uncertainty
    )


def main() -> None:
    """A table per set."""
    for name in sys.argv[1:] or UNSEEN:
        paths = [path for run, path in runs_of(name).items() if run not in UNSEEN[name]]
        problem = problem_of(paths, VESSELS.get(name))
        _, chosen = selection(problem, problem.program.entries)
        usual, taken = problem.ambient.time_constant, correlation_time(problem, chosen)
        steps = DEFAULT.fit.correlation_time_steps
        ladder = [usual * 2.0**step for step in range(-steps, steps + 1)]
        errors = [float(np.exp(np.mean(np.log(halves_errors(problem, chosen, x))))) for x in ladder]
        rows = [
            [f"{x:.2g}", f"{e:.4g}", "*" if x == taken else ""]
            for x, e in zip(ladder, errors, strict=True)
        ]
        title = f"{name}: with the usual {usual:.2g} s {problem.program.vessel.name} lacks {', '.join(chosen.effects)}"
        table(title, ["time constant [s]", "error of the other half", "taken"], rows)


if __name__ == "__main__":
    main()
