"""The table [spread] of a patched vessel file: standard deviations and correlation of a fit."""

from collections.abc import Collection

import numpy as np
import tomlkit
from tomlkit.items import Table

from boatsim.diagnosis.answer.parameters import reported_sd
from boatsim.diagnosis.filter_arguments import BODY
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem

DIGITS = 6  # significant


def uncertainty_table(problem: Problem, found: Fit, removed: Collection[str] = ()) -> Table | None:
    """Return the table `[spread]` of the patched vessel file: uncertainty of its fitted numbers.

    It contains standard deviations and correlations.

    Args:
        problem: The estimation problem.
        found: Fit of the vessel model.
        removed: Effects of the fit that the patched file does not have.

    Returns:
        The table; None if the file has no fitted number.
    """
    owners = {e.name for e in problem.program.vessel.effects} | set(found.effects)
    owners = owners - set(removed) | {"body"}
    kept, rows = [], []
    for j, free in enumerate(found.free):
        if free.group:  # it changes a load condition and not the vessel
            continue
        numbers = {}
        for name, weight in _numbers(problem, free).items():
            if name.partition(".")[0] in owners:
                numbers[name] = weight
        sd = _sd(problem, found, j)
        if numbers and sd > 0.0:
            kept.append(j)
            rows.append(_row(free, float(found.theta[j]), sd, numbers))
    if not kept:
        return None
    table = tomlkit.table()
    table.comment("uncertainty of the fitted numbers: one standard deviation")
    covariance = found.covariance[np.ix_(kept, kept)]
    sds = np.sqrt(np.diag(covariance))
    table["correlation"] = tomlkit.array()
    for correlations in covariance / np.outer(sds, sds):
        table["correlation"].add_line(list(map(_rounded, correlations)))
    table["correlation"].add_line()
    table["of"] = tomlkit.aot()
    for row in rows:
        table["of"].append(row)
    return table


def _sd(problem: Problem, found: Fit, j: int) -> float:
    """Return the sd of a fitted number: for an effect as reported, for a coefficient as fitted."""
    free = found.free[j]
    for effect in problem.program.candidates:
        if effect.name == free.effect and not free.relative and not type(effect).described:
            return reported_sd(found, effect, free.name, problem.config.answer)
    return float(np.sqrt(max(found.covariance[j, j], 0.0)))


def _numbers(problem: Problem, free: FreeParameter) -> dict[str, float]:
    """Return the weights of the numbers, as "effect.number", that a fitted parameter changes."""
    places = {}
    for effect in problem.program.effects:
        for name in effect.params():
            places[problem.program.parameter_index(effect.name, name)] = f"{effect.name}.{name}"
    for k, name in enumerate(BODY, len(problem.program.values())):
        places[k] = f"body.{name}"
    own = dict(zip(free.at, free.weights, strict=True))
    weights = dict(own)
    for to, source in problem.links:
        if source in own:
            weights[to] = own[source]
    return {places[at]: weight for at, weight in weights.items()}


def _row(free: FreeParameter, x: float, sd: float, numbers: dict[str, float]) -> Table:
    row = tomlkit.table()
    row["fitted"] = f"{free.effect}.{free.name}"
    if free.how == "scales":
        row["sd"] = _rounded(sd / abs(x))
        row["sd"].comment("relative")
        row["scales"] = list(numbers)
        return row
    row["sd"] = _rounded(sd)
    row["shifts"] = tomlkit.inline_table()
    for name, weight in numbers.items():
        row["shifts"][name] = _rounded(weight)
    return row


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
