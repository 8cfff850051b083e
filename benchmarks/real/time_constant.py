"""The latent force's correlation time by one rule: `python -m benchmarks.real.time_constant [SET ...]`.

What is judged in the end is a free run. The correlation time decides how much of a misfit the coefficients have to
explain and how much is left to the latent force, of which a free run knows nothing; the evidence of a model that lacks
something prefers to leave much to it. So what is missing is chosen once on the recordings that are fitted, and for each
value of a ladder each half of them is predicted by a fit of the other half. The shortest one whose errors are within
1 % of the smallest is the one to write into `vessel.toml`. The recordings on which the other benchmarks judge are not
opened.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.real import blueboat_lake, kvlcc2_hsva_zigzag, kvlcc2_marin_free
from benchmarks.real.common import runs_of, table
from boatsim.diagnose import analysis
from boatsim.diagnose.filter import nominal_levels, stated_noise, track
from boatsim.diagnose.fit import converge, fit
from boatsim.diagnose.problem import LENGTH, Fit, Problem
from boatsim.diagnose.report import show
from boatsim.diagnose.search.rank import selection
from boatsim.physics.program import Program

LADDER = (0.25, 0.5, 1.0, 2.0, 4.0)  # [s] on a boat of 1.2 m; by Froude's law on others
SAME = 1.01  # an error this little above the smallest is no reason to leave more to the latent force
UNSEEN = {
    blueboat_lake.NAME: blueboat_lake.UNSEEN,
    kvlcc2_hsva_zigzag.NAME: kvlcc2_hsva_zigzag.UNSEEN,
    kvlcc2_marin_free.NAME: (kvlcc2_marin_free.UNSEEN,),
}
VESSELS = {blueboat_lake.NAME: blueboat_lake.VESSEL}  # the others' recordings name theirs


def problem_of(paths: list[Path], vessel: str | None) -> Problem:
    """The question of a diagnosis of some recordings."""
    opened = [analysis.open_recording(path, vessel, ()) for path in paths]
    boat, first = opened[0][1], opened[0][0]
    program = Program(boat, analysis.suspects_of(boat, ()))
    stated = stated_noise(boat, first)
    tracks = [track(run.thinned(boat.diagnosis.rate), program, stated) for run, _ in opened]
    uncertainty = {str(k): sd for k, sd in boat.diagnosis.coefficient_uncertainty.items()}
    return Problem(tracks, nominal_levels(boat, first), uncertainty | first.notes.coefficient_uncertainty)


def refitted(problem: Problem, start: Fit) -> Fit:
    """A hypothesis fitted anew to a problem's own recordings, at the problem's own correlation time."""
    levels = replace(start.levels, time_constant=problem.ambient.time_constant)
    return converge(problem, fit(problem, replace(start, levels=levels, evidence=-np.inf)))


def halves_error(problem: Problem, chosen: Fit, seconds: float) -> float:
    """Geometric mean of the rms of position [m] and heading [rad]: each half of the runs by a fit of the other half."""
    ambient = replace(problem.ambient, time_constant=seconds)
    longest = min(float(np.ptp(t.times)) for t in problem.tracks)
    horizon = min(problem.program.vessel.diagnosis.horizon, longest)
    stretches = []
    for i in (0, 1):
        rest = Problem(problem.tracks[1 - i :: 2], ambient, problem.uncertainty)
        stretches += show.free_runs(rest, {"": refitted(rest, chosen)}, problem.tracks[i::2], horizon)
    return float(np.exp(np.mean([np.log(found[""]) for found in show.errors(stretches).values()])))


def time_constant(problem: Problem, chosen: Fit) -> tuple[float, dict[float, float]]:
    """The shortest of the best values of the ladder [s], and the error with each."""
    root = float(np.sqrt(problem.program.vessel.length / LENGTH))
    found = {root * x: halves_error(problem, chosen, root * x) for x in LADDER}
    least = min(found.values())
    return min(seconds for seconds, error in found.items() if error <= SAME * least), found


def main() -> None:
    """A table per set."""
    for name in sys.argv[1:] or UNSEEN:
        paths = [path for run, path in runs_of(name).items() if run not in UNSEEN[name]]
        problem = problem_of(paths, VESSELS.get(name))
        _, chosen = selection(problem, tuple(e.name for e in problem.program.suspects))
        best, found = time_constant(problem, chosen)
        rows = [[f"{seconds:.2g}", f"{error:.4g}", "*" if seconds == best else ""] for seconds, error in found.items()]
        title = f"{name}: {problem.program.vessel.name} has {problem.ambient.time_constant:g} s, with which it lacks "
        table(title + ", ".join(chosen.suspects), ["time constant [s]", "error of the other half", "best"], rows)


if __name__ == "__main__":
    main()
