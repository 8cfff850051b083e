"""[spread] of a patched file: how far off the fitted numbers may be, from the covariance of the fit."""

from collections.abc import Collection

import numpy as np
import tomlkit
from tomlkit.items import Table

from boatsim.diagnosis.filter import BODY
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.report.answer import told_sd

DIGITS = 6  # significant


def spread(problem: Problem, found: Fit, gone: Collection[str] = ()) -> Table | None:
    """The table, or None where nothing was fitted; `gone` are effects that the patched file does not have."""
    boat = {e.name for e in problem.program.vessel.effects} | set(found.effects)
    kept, rows = [], []
    for j, free in enumerate(found.free):
        there = [
            name
            for name in _numbers(problem, free)
            if name[0].partition(".")[0] in boat - set(gone) | {"body"}
        ]
        sd = _sd(problem, found, j)
        if there and sd > 0.0:
            kept.append(j)
            rows.append(_row(free, float(found.theta[j]), sd, there))
    if not kept:
        return None
    table = tomlkit.table()
    table.comment("how far off the fitted numbers may be, one standard deviation")
    covariance = found.covariance[np.ix_(kept, kept)]
    sds = np.sqrt(np.diag(covariance))
    table["correlation"] = tomlkit.array()
    for row in covariance / np.outer(sds, sds):
        table["correlation"].add_line([_rounded(x) for x in row])
    table["correlation"].add_line()
    table["of"] = tomlkit.aot()
    for row in rows:
        table["of"].append(row)
    return table


def _sd(problem: Problem, found: Fit, j: int) -> float:
    """As the report tells it of what was found, as it was fitted of a coefficient."""
    free = found.free[j]
    effect = next((e for e in problem.program.candidates if e.name == free.effect), None)
    if effect is not None and not free.relative and not type(effect).described:
        return told_sd(found, effect, free.name)
    return float(np.sqrt(max(found.covariance[j, j], 0.0)))


def _numbers(problem: Problem, free: FreeParameter) -> list[tuple[str, float]]:
    """Numbers, as "effect.number", that a fitted quantity acts on, each with its weight, and those that follow them."""
    places = {
        problem.program.index(e.name, n): f"{e.name}.{n}"
        for e in problem.program.effects
        for n in e.params()
    }
    places |= {len(problem.program.values()) + k: f"body.{name}" for k, name in enumerate(BODY)}
    weights = dict(zip(free.at, free.weights, strict=True))
    weights |= {to: weights[source] for to, source in problem.links if source in weights}
    return [(places[at], weight) for at, weight in weights.items()]


def _row(free: FreeParameter, x: float, sd: float, there: list[tuple[str, float]]) -> Table:
    row = tomlkit.table()
    row["fitted"] = f"{free.effect}.{free.name}"
    if free.how == "scales":
        row["sd"] = _rounded(sd / abs(x))
        row["sd"].comment("relative")
        row["scales"] = [name for name, _ in there]
        return row
    row["sd"] = _rounded(sd)
    row["shifts"] = tomlkit.inline_table()
    row["shifts"].update({name: _rounded(weight) for name, weight in there})
    return row


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
