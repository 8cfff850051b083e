"""Confirmation of identified effects by held-out recordings, each effect by itself.

An effect is compared with the fit that has all other effects, refitted without it. It is confirmed
if free runs over held-out recordings are better with it, or if these recordings are more likely
with it. If neither holds there are two cases. Where the held-out recordings determine its size,
they could have shown it, but are explained as well without it: it is unconfirmed, and is not named,
unless they require it once the other parameters may change too.
Where they are too short for that, or do not excite the effect, they are no evidence against it: the
name, which the fitted recordings require, stays, and the report states that it is open.
"""

from collections.abc import Mapping, Sequence
from math import exp, log
from typing import Literal, NamedTuple

from boatsim.diagnosis.config import DecideConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.open_set.consistency import Consistency
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import CoefficientRelease, Effect

WHOLE = ""  # name of the fit with all effects among free runs

Outcome = Literal["confirmed", "open", "unconfirmed"]


class Errors(NamedTuple):
    """Rms errors without and with one effect, of simulations over held-out recordings.

    The errors are those of one family of signals: position [m], heading or roll [rad].
    """

    without: float  # all other effects act
    with_effect: float


def held_out_effect_errors(
    problem: Problem,
    best: Fit,
    without_each: Mapping[str, Fit],
    held_out: Sequence[MappedRecording],
) -> dict[str, dict[str, Errors]]:
    """Return how far each identified effect changes the simulation errors on held-out recordings.

    The errors are rms errors of free runs (simulations with the recorded commands alone) without
    and with the effect, by name of the effect and by family of signals (position,
    heading, roll, heave).

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        best: Fit of the vessel model with some candidate effects.
        without_each: Fits without one of the effects, by the name of that effect.
        held_out: Held-out recordings, which no fit has used.
    """
    if not held_out:
        return {name: {} for name in without_each}
    horizon = free_run_horizon(problem, held_out)
    fits = {WHOLE: best, **without_each}
    rms = rms_errors(free_runs(problem, fits, held_out, horizon))
    found = {}
    for name in without_each:
        found[name] = {
            family: Errors(errors[name], errors[WHOLE]) for family, errors in rms.items()
        }
    return found


def confirmation_outcome(
    effect: Effect, errors: Mapping[str, Errors], signs: Consistency, config: DecideConfig
) -> Outcome:
    """Return whether held-out recordings confirm an identified effect.

    "confirmed" if they are simulated better or are more likely with it, "unconfirmed" if they could
    have shown it but do not, "open" if they do not determine its size, or if they require it once
    the other parameters may change too. An effect that releases
    coefficients of the vessel is never unconfirmed: without it the same coefficients are refitted,
    only far outside of their stated uncertainty, and predict the same.

    Args:
        effect: The effect.
        errors: Errors of free runs without and with it, by family.
        signs: Its gain of likelihood and its size on held-out recordings.
        config: Largest sd of a size that held-out recordings determine.
    """
    if signs.held_out_gain > 0.0 or mean_ratio(errors) < 1.0:
        return "confirmed"
    if signs.held_out.sd > config.confirmed_sd or isinstance(effect, CoefficientRelease):
        return "open"
    if signs.held_out.significance > config.required_sd:
        return "open"
    return "unconfirmed"


def mean_ratio(errors: Mapping[str, Errors]) -> float:
    """Return the ratio of simulation errors with an effect to those without it.

    It is the geometric mean over position, heading, roll and heave, and 1 where nothing was
    recorded.

    Args:
        errors: Errors of free runs without and with an effect, by family.
    """
    logs = []
    for without, with_effect in errors.values():
        if without > 0.0 and with_effect > 0.0:
            logs.append(log(with_effect / without))
    return exp(sum(logs) / len(logs)) if logs else 1.0
