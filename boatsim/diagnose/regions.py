"""In which state region a force is missing: only while thrust is astern, in one direction of the world, with speed.

Each region is a regression of the missing force on what it would be there, over stretches long enough to be
independent, beside what a recalibration would do (all thrust, linear damping) and beside the other regions found.
p-values are corrected for the number of regions tried (Bonferroni).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import f as f_distribution

from boatsim.base import Array
from boatsim.diagnose.filter import Track
from boatsim.diagnose.locate import Force
from boatsim.diagnose.problem import Fit, Problem

LIKELY = 0.01  # corrected p-value below which a region is worth a sentence
FEWEST = 8  # independent stretches a regression needs


@dataclass(frozen=True)
class Region:
    """A state region in which a force is missing."""

    variable: str
    statement: str
    p_value: float  # corrected


@dataclass(frozen=True)
class Idea:
    """One explanation tried: what the missing force (rows, axes) would be up to factors, and how to say it."""

    variable: str
    shapes: tuple[Array, ...]  # each (rows, axes)


def regions(problem: Problem, forces: Sequence[Force], found: Fit) -> list[Region]:
    """Regions that explain the missing force of the fitted runs, the likeliest first; none where nothing is missing."""
    if problem.program.module.NQ != 3:
        return []  # a hull that only rolls has no thrust, heading or place
    on = problem.program.switches(found.suspects)
    stretch = 2.0 * max(found.levels.time_constant, 0.5)  # [s]
    missing, ideas, known = [], [], []
    for track, force in zip(problem.tracks, forces, strict=False):
        states, _ = track.smoothed(problem.values(track, found.free, found.theta), on, found.levels)
        blocks = np.floor((track.times - track.times[0]) / stretch).astype(int)
        missing.append(_means(force.mean, blocks))
        speeds, thrusts = _body_speeds(states), _thrusts(track, on)
        known.append([_means(s, blocks) for s in (*_per_axis(*speeds), thrusts[0] + thrusts[1])])
        here = _ideas(states, speeds, thrusts[1])
        ideas.append([Idea(i.variable, tuple(_means(s, blocks) for s in i.shapes)) for i in here])
    y = np.concatenate(missing)
    weight = 1.0 / problem.ambient.force  # axes count by how large they are beside what is tolerated
    if len(y) < FEWEST or not (np.sqrt(np.mean(y**2, axis=0)) > problem.ambient.force).any():
        return []
    beside = [np.concatenate(s) * weight for s in zip(*known, strict=True)]
    tried = {
        several[0].variable: [
            np.concatenate([i.shapes[k] for i in several]) * weight for k in range(len(several[0].shapes))
        ]
        for several in zip(*ideas, strict=True)
    }
    chosen = _selected(y * weight, tried, beside)
    out = []
    for variable in chosen:
        others = [shape for n in chosen if n != variable for shape in tried[n]]
        factors, p = _regress(y * weight, tried[variable], [*beside, *others])
        p = min(1.0, p * len(tried))
        out.append(Region(variable, _statement(variable, factors, p), float(f"{p:.2g}")))
    return sorted(out, key=lambda r: r.p_value)


def _selected(y: Array, tried: Mapping[str, Sequence[Array]], beside: Sequence[Array]) -> list[str]:
    """Regions one after the other, each on top of those before, as long as one is likely."""
    chosen: list[str] = []
    while len(chosen) < len(tried):
        before = [*beside, *(shape for n in chosen for shape in tried[n])]
        p = {n: _regress(y, shapes, before)[1] * len(tried) for n, shapes in tried.items() if n not in chosen}
        best = min(p, key=lambda n: p[n])
        if p[best] >= LIKELY:
            break
        chosen.append(best)
    return chosen


def _means(values: Array, blocks: Array) -> Array:
    """Mean of each block of rows (B, axes)."""
    starts = np.flatnonzero(np.diff(blocks, prepend=-1))
    return np.asarray(np.add.reduceat(values, starts, axis=0) / np.diff(np.append(starts, len(blocks)))[:, None])


def _body_speeds(states: Array) -> tuple[Array, Array, Array]:
    """Surge, sway and yaw speed of smoothed states."""
    c, s = np.cos(states[:, 2]), np.sin(states[:, 2])
    return c * states[:, 3] + s * states[:, 4], c * states[:, 4] - s * states[:, 3], states[:, 5]


def _per_axis(*values: Array) -> list[Array]:
    """Each (rows,) as a force (rows, 3) along its own axis alone."""
    return [np.outer(v, np.eye(3)[k]) for k, v in enumerate(values)]


def _ideas(states: Array, speeds: tuple[Array, Array, Array], astern: Array) -> list[Idea]:
    """What is tried: a direction of the world, the square of each speed, thrust astern."""
    c, s, none = np.cos(states[:, 2]), np.sin(states[:, 2]), np.zeros(len(states))
    ideas = [Idea("heading in the world", (np.column_stack([c, -s, none]), np.column_stack([s, c, none])))]
    squares = _per_axis(*(w * np.abs(w) for w in speeds))
    ideas += [Idea(f"{n} speed", (shape,)) for n, shape in zip(("surge", "sway", "yaw"), squares, strict=True)]
    return [*ideas, Idea("thrust astern", (astern,))]


def _thrusts(track: Track, on: Array) -> tuple[Array, Array]:
    """Force (rows, axes) of the nominal thrusters while they push ahead and astern; zeros for a vessel without them."""
    program = track.program
    size = len(track.times)
    parts = np.zeros((2, size, 3))
    thrust = [i for i, a in enumerate(program.vessel.actuators) if program.vessel.commands[a].family == "thrust"]
    if not thrust:
        return parts[0], parts[1]
    act, memory, rest = np.zeros(program.module.HELD), np.zeros(program.memory_size), np.zeros(6)
    program.module.settle(track.commands[0], memory, track.values, on, act)
    steps = np.append(np.diff(track.times), 0.1)
    for row in range(size):
        program.module.actuate_in_place(track.commands[row], memory, steps[row], track.values, on, act)
        idle = act.copy()
        idle[thrust] = 0.0
        still = np.array(program.module.forces(0.0, rest, idle, track.values, on))
        for part, keep in enumerate((act[thrust] > 0.0, act[thrust] < 0.0)):
            one = act.copy()
            one[thrust] = np.where(keep, act[thrust], 0.0)
            parts[part, row] = np.array(program.module.forces(0.0, rest, one, track.values, on)) - still
    return parts[0], parts[1]


def _regress(y: Array, shapes: Sequence[Array], beside: Sequence[Array]) -> tuple[Array, float]:
    """Factors of the shapes by least squares over rows and axes beside others, and the p-value of their F test."""
    columns = [s.ravel() for s in (*shapes, *beside) if s.any()]
    if len(columns) == 0 or not any(s.any() for s in shapes):
        return np.zeros(len(shapes)), 1.0
    k = sum(bool(s.any()) for s in shapes)
    factors, rest = _least_squares(np.column_stack(columns), y.ravel())
    _, without = _least_squares(np.column_stack([*columns[k:], np.zeros(y.size)]), y.ravel())
    n = len(y) - len(columns)  # stretches are independent, axes of one stretch may not be
    if rest <= 0.0 or n <= 0:
        return factors[:k], 1.0
    return factors[:k], float(f_distribution.sf((without - rest) / k / (rest / n), k, n))


def _least_squares(X: Array, y: Array) -> tuple[Array, float]:
    factors = np.asarray(np.linalg.lstsq(X, y, rcond=None)[0], dtype=np.float64)
    return factors, float(np.sum((y - X @ factors) ** 2))


def _statement(variable: str, factors: Array, p: float) -> str:
    """A sentence that a person understands."""
    sure = "p < 1e-6" if p < 1e-6 else f"p = {p:.1g}"
    if variable == "heading in the world":
        size, toward = float(np.hypot(*factors)), float(np.degrees(np.arctan2(factors[1], factors[0]))) % 360.0
        return f"the missing force keeps its direction in the world: {size:.2g} N toward {toward:.0f} deg; {sure}"
    if variable.startswith("thrust"):
        way = variable.removeprefix("thrust ")
        share, what = abs(100.0 * factors[0]), "is missing" if factors[0] < 0 else "comes on top"
        return f"while thrust is {way}, about {share:.0f} % of the commanded thrust {what}; {sure}"
    more = "resists" if factors[0] < 0 else "pushes"
    return f"the missing force {more} with the square of the {variable}; {sure}"
