"""Chooses the latent force's correlation time by one rule for every vessel, from the fitted recordings alone.

What is judged in the end is a free run. The correlation time decides how much of a misfit the coefficients have to
explain and how much is left to the latent force, of which a free run knows nothing; the evidence of a model that lacks
something prefers to leave much to it. So each half of the recordings is predicted by a fit to the other half, what was
named included. The usual value of a hull of this length is halved, or doubled, as long as that predicts clearly better.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import log, sqrt

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import fit
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.generalization import WORSE
from boatsim.physics.base import Array

EXACT = 1e-12  # [m, rad] an error of a free run is at least: of a log that never moves it is none
STEPS = 2  # halvings or doublings at most
# standard errors over the free runs by which errors must fall: where they swing as much, it says
# nothing
SURE = 2.0


def timed(problem: Problem, found: Fit) -> Problem:
    """The same question with the correlation time that suits a hypothesis: itself if that is the one it has."""
    seconds = correlation_time(problem, found)
    if seconds == problem.ambient.time_constant:
        return problem
    return Problem(
        problem.recordings,
        problem.ambient.lasting(seconds),
        problem.uncertainty,
        problem.horizon,
        problem.config,
    )


def correlation_time(problem: Problem, found: Fit) -> float:
    """The correlation time [s] for a hypothesis."""
    usual = problem.ambient.time_constant
    if not found.effects:
        return usual  # it leaves nothing to the latent force that coefficients could explain
    at_usual = halves_errors(problem, found, usual)
    for factor in (0.5, 2.0):
        seconds, errors = usual, at_usual
        for _ in range(STEPS):
            further = halves_errors(problem, found, factor * seconds)
            if not clearly_less(further, errors):
                break
            seconds, errors = factor * seconds, further
        if seconds != usual:
            return seconds
    return usual


def halves(
    tracks: Sequence[MappedRecording],
) -> tuple[list[MappedRecording], list[MappedRecording]]:
    """Every second recording and the others; of a single one its halves in time."""
    if len(tracks) > 1:
        return list(tracks[0::2]), list(tracks[1::2])
    middle = len(tracks[0].times) // 2
    return [part(tracks[0], 0, middle)], [part(tracks[0], middle, len(tracks[0].times))]


def part(track: MappedRecording, begin: int, end: int) -> MappedRecording:
    """Some rows of a recording."""
    times, measured, commands = (
        np.ascontiguousarray(x[begin:end]) for x in (track.times, track.measured, track.commands)
    )
    first = max(int(np.searchsorted(track.given, times[0], side="right")) - 1, 0)
    given, orders = track.given[first:].copy(), track.orders[first:].copy()
    return replace(
        track, times=times, measured=measured, commands=commands, given=given, orders=orders
    )


def clearly_less(errors: Array, before: Array) -> bool:
    """Whether the errors of free runs (S,) are clearly less than they were, in the mean of their logs.

    Those over which nothing was recorded (nan) say nothing.
    """
    ratio = np.log(errors / before)
    ratio = ratio[~np.isnan(ratio)]
    if not len(ratio):
        return False
    scatter = SURE * float(np.std(ratio, ddof=1)) / sqrt(len(ratio)) if len(ratio) > 1 else 0.0
    return bool(np.mean(ratio) < min(-log(WORSE), -scatter))


def halves_errors(problem: Problem, start: Fit, seconds: float) -> Array:
    """Error of each free run (S,), that of every half by a fit of the other half.

    It is the geometric mean of the rms of position [m] and of heading or roll [rad]; nan where one was not recorded.
    """
    ambient = problem.ambient.lasting(seconds)
    begin = replace(start, levels=start.levels.lasting(seconds), evidence=-np.inf)
    first, second = halves(problem.recordings)
    horizon = min(problem.horizon, *(float(np.ptp(t.times)) for t in (*first, *second)))
    stretches = []
    for fitted, held_out in ((first, second), (second, first)):
        rest = Problem(fitted, ambient, problem.uncertainty, horizon, problem.config)
        stretches += free_runs(rest, {"": fit(rest, begin)}, held_out, horizon)
    found = [np.maximum([f[""] for f in errors([s]).values()], EXACT) for s in stretches]
    return np.array([np.exp(np.mean(np.log(each))) for each in found])
