"""Fits a hypothesis (which suspects act) inside the filter and scores it by its Laplace evidence."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.base import Array
from boatsim.diagnose.filter import Levels, Track

FORCE_PRIOR = (0.3, 1.5)  # sd of log rms of the latent force below and above the ambient level
SENSOR_PRIOR = 0.4  # sd of log noise about the stated one
TIME_PRIOR = 0.7  # sd of log time constant


@dataclass(frozen=True)
class Free:
    """A parameter to fit. A nuisance scales the run's own value: `relative` is true and its mean is 1."""

    effect: str
    name: str
    at: int  # position in the flat parameter array
    mean: float
    sd: float
    low: float
    high: float
    relative: bool = False


@dataclass(frozen=True)
class Fit:
    """A converged hypothesis."""

    suspects: tuple[str, ...]
    free: tuple[Free, ...]
    theta: Array  # (F,) fitted values
    covariance: Array  # (F, F)
    levels: Levels
    evidence: float  # log of the Laplace evidence [nats]

    def value(self, effect: str, name: str) -> tuple[float, float]:
        """Fitted value and standard deviation of one parameter."""
        i = next(i for i, f in enumerate(self.free) if f.effect == effect and f.name == name and not f.relative)
        return float(self.theta[i]), float(np.sqrt(self.covariance[i, i]))


class Problem:
    """Recordings, a program with all suspects compiled in, and what may be fitted."""

    def __init__(self, tracks: Sequence[Track], ambient: Levels, uncertainty: dict[str, float]) -> None:
        """`uncertainty` is the relative sd of coefficients by kind ("damping", "thrust", ...)."""
        self.tracks, self.ambient, self.uncertainty = list(tracks), ambient, uncertainty
        self.program = tracks[0].program
        self.nuisances = self._nuisances()
        self.links = self._links()

    def parameters(self, suspects: Sequence[str]) -> tuple[Free, ...]:
        """Coefficients of the nominal, then everything that the suspects let be fitted."""
        free = list(self.nuisances)
        own = len(self.program.vessel.effects)
        for effect in self.program.effects[own:]:
            if effect.name() not in suspects:
                continue
            for name, about in type(effect).params().items():
                if about.fit and (not about.axis or about.axis in self.program.vessel.freedoms):
                    at = self.program.index(effect.name(), name)
                    free.append(Free(effect.name(), name, at, about.absent, about.spread, about.low, about.high))
        return tuple(free)

    def values(self, track: Track, free: Sequence[Free], theta: Array) -> Array:
        """A run's flat parameters with the free ones put in."""
        p = track.values.copy()
        for f, x in zip(free, theta, strict=True):
            p[f.at] = track.values[f.at] * x if f.relative else x
        for to, source in self.links:
            p[to] = p[source]
        return p

    def likelihood(self, free: Sequence[Free], theta: Array, on: Array, levels: Levels, full: bool = True) -> float:
        """Log likelihood of all runs."""
        return sum(t.likelihood(self.values(t, free, theta), on, levels, full) for t in self.tracks)

    def white(self) -> Array:
        """Whitened prediction errors of all runs, of the last pass."""
        return np.concatenate([t.white for t in self.tracks])

    def nominal(self) -> Fit:
        """Nothing fitted: the vessel as it is written."""
        free = self.nuisances
        return Fit((), free, np.ones(len(free)), np.zeros((len(free), len(free))), self.ambient, -np.inf)

    def _nuisances(self) -> tuple[Free, ...]:
        found = []
        freedoms = self.program.vessel.freedoms
        for effect in self.program.vessel.effects:
            for name, about in type(effect).params().items():
                sd = self.uncertainty.get(about.calibrates, 0.0)
                at = self.program.index(effect.name(), name)
                used = self.tracks[0].values[at] != 0.0 and (not about.axis or about.axis in freedoms)
                if about.calibrates and sd > 0 and used:
                    found.append(Free(effect.name(), name, at, 1.0, sd, 0.05, 20.0, True))
        return tuple(found)

    def _links(self) -> list[tuple[int, int]]:
        links = []
        for effect in self.program.effects:
            for name, about in type(effect).params().items():
                owner, _, key = about.follows.partition(".")
                if owner and owner != "vessel":
                    links.append((self.program.index(effect.name(), name), self.program.index(owner, key)))
        return links


def fit(problem: Problem, suspects: Sequence[str], start: Fit, rounds: int = 2) -> Fit:
    """A hypothesis fitted from the values of `start`, force levels refitted in turn; the best of the effect's starts."""
    free = problem.parameters(suspects)
    known = {(f.effect, f.name): x for f, x in zip(start.free, start.theta, strict=True)}
    best: Fit | None = None
    for first in _starts(problem, suspects, start):
        theta = np.array([known.get((f.effect, f.name), first.get((f.effect, f.name), f.mean)) for f in free])
        found = descend(problem, suspects, free, theta, start.levels, iterations=6, enough=0.3)
        if best is None or found.evidence > best.evidence:
            best = found
    assert best is not None
    for _ in range(rounds - 1):
        levels = fit_force(problem, best)
        best = descend(problem, suspects, free, best.theta, levels, iterations=4, enough=0.1)
    return replace(best, evidence=best.evidence + force_prior(problem, best.levels))


def converge(problem: Problem, found: Fit, most: int = 4) -> Fit:
    """Refit until parameters and force levels agree, so that a later gain is not the gain of a refit."""
    for _ in range(most):
        again = fit(problem, found.suspects, found)
        gain = again.evidence - found.evidence
        if gain > 0:
            found = again
        if gain < 0.3:
            break
    return found


def _starts(problem: Problem, suspects: Sequence[str], start: Fit) -> list[dict[tuple[str, str], float]]:
    """Where the newest suspect's parameters start."""
    new = [s for s in suspects if s not in start.suspects]
    if not new:
        return [{}]
    effect = next(e for e in problem.program.effects if e.name() == new[-1])
    params = type(effect).params()
    default = {n: p.absent + 0.1 * p.spread * (1.0 if p.absent + 0.1 * p.spread <= p.high else -1.0) for n, p in params.items()}
    return [{(new[-1], n): x for n, x in {**default, **s}.items()} for s in (type(effect).starts or ({},))]


def descend(
    problem: Problem, suspects: Sequence[str], free: tuple[Free, ...], theta: Array, levels: Levels, iterations: int,
    enough: float,
) -> Fit:  # fmt: skip
    """Gauss-Newton on prior and whitened prediction errors, bounds kept; evidence without the force levels' prior."""
    on = problem.program.switches(suspects)
    mean, sd = np.array([f.mean for f in free]), np.array([f.sd for f in free])
    low, high = np.array([f.low for f in free]), np.array([f.high for f in free])
    theta = np.clip(theta, low, high)

    def score(x: Array, full: bool = True) -> float:
        return problem.likelihood(free, x, on, levels, full) - 0.5 * float(np.sum(((x - mean) / sd) ** 2))

    best, damping = score(theta), 1e-3
    J = np.zeros((1, len(free)))
    for _ in range(iterations):
        problem.likelihood(free, theta, on, levels, full=False)
        J = _jacobian(problem, free, theta, on, levels, high, sd)
        A = J.T @ J
        g = -(J.T @ problem_white(problem, free, theta, on, levels)) - (theta - mean) / sd
        step, gain = None, 0.0
        for _ in range(5):
            trial = np.clip(theta + sd * _bounded_step(A, g, damping, theta, sd, low, high), low, high)
            value = score(trial)
            if np.isfinite(value) and value > best - 1e-6:
                step, gain = trial, value - best
                break
            damping = max(damping, 1e-2) * 10.0
        if step is None:
            score(theta)
            break
        theta, best, damping = step, best + gain, damping / 10.0
        if gain < enough:
            break
    information = np.eye(len(free)) + J.T @ J
    covariance = np.linalg.inv(information) * np.outer(sd, sd)
    evidence = best - 0.5 * float(np.linalg.slogdet(information)[1])
    return Fit(tuple(suspects), free, theta, covariance, levels, evidence)


def problem_white(problem: Problem, free: Sequence[Free], theta: Array, on: Array, levels: Levels) -> Array:
    """Whitened prediction errors at theta with the gains of the last full pass."""
    problem.likelihood(free, theta, on, levels, full=False)
    return problem.white()


def _jacobian(
    problem: Problem, free: Sequence[Free], theta: Array, on: Array, levels: Levels, high: Array, sd: Array
) -> Array:
    """Derivative of the whitened errors by theta / sd, forward differences of a hundredth of the prior sd."""
    base = problem_white(problem, free, theta, on, levels)
    J = np.empty((len(base), len(free)))
    for j in range(len(free)):
        moved = theta.copy()
        h = 0.01 * sd[j] if theta[j] + 0.01 * sd[j] <= high[j] else -0.01 * sd[j]
        moved[j] += h
        J[:, j] = (problem_white(problem, free, moved, on, levels) - base) * (sd[j] / h)
    return J


def _bounded_step(A: Array, g: Array, damping: float, theta: Array, sd: Array, low: Array, high: Array) -> Array:
    """Newton step in units of sd; a parameter at its bound that wants out stays."""
    free = np.ones(len(g), dtype=bool)
    step = np.zeros(len(g))
    for _ in range(4):
        step[:] = 0.0
        if not free.any():
            break
        B = A[np.ix_(free, free)] + np.eye(int(free.sum())) * (1.0 + 10.0 * damping)
        step[free] = np.linalg.solve(B, g[free])
        stuck = free & (((step < 0) & (theta <= low + 1e-12)) | ((step > 0) & (theta >= high - 1e-12)))
        if not stuck.any():
            break
        free &= ~stuck
    return step


def force_prior(problem: Problem, levels: Levels) -> float:
    """Log prior of the latent force: near the ambient level, more is likelier than less."""
    over = np.log(levels.force / problem.ambient.force)
    return float(np.sum(-0.5 * np.where(over > 0, over / FORCE_PRIOR[1], over / FORCE_PRIOR[0]) ** 2))


def fit_force(problem: Problem, found: Fit, step: float = 0.5) -> Levels:
    """Latent-force level of each axis refitted under a hypothesis: one parabolic search per axis."""
    on = problem.program.switches(found.suspects)
    log_force = np.log(found.levels.force)

    def score(x: Array) -> float:
        levels = replace(found.levels, force=np.exp(x))
        return problem.likelihood(found.free, found.theta, on, levels) + force_prior(problem, levels)

    return replace(found.levels, force=np.exp(_coordinate_search(score, log_force, step, 1)))


def fit_noise(problem: Problem, sweeps: int = 4) -> Levels:
    """Sensor noise and latent-force levels under the nominal model, before anything is named."""
    families = sorted({f for t in problem.tracks for f in t.families})
    n = len(problem.ambient.force)
    on = problem.program.switches(())
    nominal = problem.nominal()
    stated = np.log([problem.ambient.sensors[f] for f in families])
    rough = np.log([_roughness(problem, f) or problem.ambient.sensors[f] for f in families])

    def levels(x: Array) -> Levels:
        sensors = {**problem.ambient.sensors, **dict(zip(families, np.exp(x[n:]).tolist(), strict=True))}
        return replace(problem.ambient, force=np.exp(x[:n]), sensors=sensors)

    def score(x: Array) -> float:
        prior = -0.5 * float(np.sum(((x[n:] - stated) / SENSOR_PRIOR) ** 2))
        return problem.likelihood(nominal.free, nominal.theta, on, levels(x)) + force_prior(problem, levels(x)) + prior

    begin = np.concatenate([np.log(problem.ambient.force) + 0.7, np.clip(rough, stated - 1.2, stated + 1.2)])
    return levels(_coordinate_search(score, begin, 0.6, sweeps))


def fit_time_constant(problem: Problem, found: Fit) -> Levels:
    """Latent-force levels with their correlation time, for the band that locates a mismatch in time."""
    on = problem.program.switches(found.suspects)

    def levels(x: Array) -> Levels:
        return replace(found.levels, force=np.exp(x[:-1]), time_constant=float(np.exp(x[-1])))

    def score(x: Array) -> float:
        prior = -0.5 * ((x[-1] - np.log(problem.ambient.time_constant)) / TIME_PRIOR) ** 2
        return problem.likelihood(found.free, found.theta, on, levels(x)) + force_prior(problem, levels(x)) + float(prior)

    begin = np.append(np.log(found.levels.force), np.log(found.levels.time_constant))
    return levels(_coordinate_search(score, begin, 0.5, 3))


def _roughness(problem: Problem, family: str) -> float:
    """Noise sd of a sensor from third differences of its signal, robust to outliers; 0 if it never varies."""
    found = []
    for t in problem.tracks:
        for c, f in enumerate(t.families):
            y = t.measured[np.isfinite(t.measured[:, c]), c]
            if f == family and len(y) > 8:
                found.append(np.diff(y, 3) ** 2 / 20.0)
    return float(np.sqrt(np.median(np.concatenate(found)) / 0.455)) if found else 0.0


def _coordinate_search(score, x: Array, step: float, sweeps: int) -> Array:  # type: ignore[no-untyped-def]
    """Maximise a smooth score one coordinate at a time: a parabola through three points, then the best of four."""
    best = score(x)
    for _ in range(sweeps):
        for j in range(len(x)):
            e = np.zeros(len(x))
            e[j] = step
            above, below = score(x + e), score(x - e)
            curve = above - 2.0 * best + below
            shift = 0.5 * step * (below - above) / curve if curve < -1e-9 else (step if above > below else -step)
            e[j] = float(np.clip(shift, -2.0 * step, 2.0 * step))
            options = [(best, x), (score(x + e), x + e)]
            e = np.zeros(len(x))
            e[j] = step
            options += [(above, x + e), (below, x - e)]
            best, x = max(options, key=lambda o: o[0])
        step *= 0.7
    return x
