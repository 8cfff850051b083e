"""A quick look at every suspect on top of a fit: Gauss-Newton with the filter's gains and all else linearised."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnosis.command_range import excursion
from boatsim.diagnosis.filter import axes_of
from boatsim.diagnosis.fit import SETTLED, Space, as_promised, cut_off, descend, jacobian, log_prior
from boatsim.diagnosis.noise_levels import force_prior
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.physics.base import Array, Effect, Unsteady

ROUNDS = 3  # Gauss-Newton steps of a suspect
NEARER = 4  # points at which a look is scored anew, each half as far from nothing missing,
HONEST, SMALL_LIE = (
    0.5,
    3.0,
)  # where the filter sees less than this share of what it promised, or so many nats less
FURTHER = 2  # steps from the best of these
TRIED = 2  # starts of a suspect from which a step is taken
LITTLE = 0.3  # [nats] promised at most, a suspect is not followed further
HALVINGS, TOO_STRONG = 8, 30.0  # of a start that lies this far below nothing missing [nats]
SMALL = 0.1  # where a suspect without starts of its own begins, in prior sds
# of the fitted latent force that a random force is tried with; the latent force keeps as much
SWELL_SHARE = 0.7


@dataclass(frozen=True)
class Begin:
    """What all looks share: the fit they are on top of, linearised with the gains held."""

    columns: Array  # (rows, F) derivatives of the whitened errors by its parameters
    slope: Array  # (F,) gradient that held gains show where there is none
    score: float
    white: Array  # (rows,) whitened errors
    factor: (
        Array  # (F, F) inverse of the information on its parameters, in units of their prior sds
    )

    def promise(self, white: Array) -> float:
        """Nats that some multiple of a change of the errors gains, beside all that the fit has free itself."""
        mark = white - self.white
        with np.errstate(over="ignore", invalid="ignore"):  # a boat that runs away promises nothing
            along = self.columns.T @ mark
            length = float(mark @ mark - along @ (self.factor @ along))
            slope = float(self.white @ mark - along @ (self.factor @ (self.columns.T @ self.white)))
        return 0.5 * slope**2 / length if np.isfinite(length) and length > 0.0 else -np.inf


def screen(
    problem: Problem,
    base: Fit,
    candidates: Sequence[str],
    done: Callable[[float], None] | None = None,
) -> dict[str, Fit]:
    """Each candidate added to `base`: parameters near the best, evidence near enough to choose whom to fit in full.

    `done` is told the share that was looked at.
    """
    on = problem.program.switches(base.effects)
    problem.likelihood(base.free, base.theta, on, base.levels)  # the gains that all looks share
    white = problem.white()
    known = jacobian(problem, base.free, base.theta, on, base.levels, white)
    # base is a maximum: its gradient is zero, whatever gains held still make of it
    space = Space(base.free)
    off = known.T @ white + (base.theta - space.mean) / space.sd
    score = log_prior(base.free, base.theta) - 0.5 * float(white @ white)
    begin = Begin(
        known,
        off,
        score,
        white,
        np.asarray(np.linalg.inv(np.eye(len(off)) + known.T @ known), dtype=np.float64),
    )
    effects = {e.name: e for e in problem.program.candidates}
    looks: dict[str, Fit] = {}
    for name in sorted(candidates, key=lambda n: type(effects[n]).random):
        random = type(effects[name]).random
        looks[name] = (
            _random_look(problem, base, effects[name])
            if random
            else _look(problem, base, effects[name], begin)
        )
        if done:
            done(len(looks) / len(candidates))
    return looks


def checked(problem: Problem, base: Fit, look: Fit) -> Fit:
    """A look itself where the filter, its gains made anew, agrees; else steps from the best of points nearer `base`.

    A look may go wrong where gains held no longer suit the boat, as where much mass is missing: what seems little from
    where the filter bears it out may still gain most.
    """
    on = problem.program.switches(look.effects)
    at_base = problem.likelihood(
        base.free, base.theta, problem.program.switches(base.effects), base.levels
    )
    at_base += log_prior(base.free, base.theta)
    promised = look.evidence - base.evidence
    fitted = {(f.effect, f.name): x for f, x in zip(base.free, base.theta, strict=True)}
    nothing = np.array([fitted.get((f.effect, f.name), f.mean) for f in look.free])
    theta, best = look.theta, look
    for i in range(NEARER):
        gain = (
            problem.likelihood(look.free, theta, on, look.levels)
            + log_prior(look.free, theta)
            - at_base
        )
        if i == 0 and (gain > HONEST * promised or gain > promised - SMALL_LIE):
            return look
        if i == 0 or gain > best.evidence - base.evidence:
            best = replace(look, theta=theta, evidence=base.evidence + min(gain, promised))
        theta = 0.5 * (theta + nothing)
    further = descend(problem, best, FURTHER, SETTLED)
    return further if np.isfinite(further.evidence) else best


def _half_determinant(J: Array) -> float:
    return 0.5 * float(np.linalg.slogdet(np.eye(J.shape[1]) + J.T @ J)[1])


def starts(problem: Problem, effect: Effect) -> list[dict[str, float]]:
    """Where a suspect's fit begins: its own starts, Froude-scaled, shares of the commands given, or a little of it."""
    params = type(effect).params()
    default = {}
    for name, p in params.items():
        step = SMALL * p.spread * problem.scale(effect, name)
        default[name] = p.absent + (step if p.absent + step <= p.high else -step)
    given = [{n: x * problem.scale(effect, n) for n, x in s.items()} for s in type(effect).starts]
    largest = excursion(problem.recordings, effect)
    given += [
        {n: share * largest}
        for n, shares in type(effect).thresholds.items()
        for share in shares
        if largest
    ]
    return [{**default, **s} for s in given or [{}]]


def joined(problem: Problem, base: Fit, name: str, start: Mapping[str, float]) -> Fit:
    """`base` with one more suspect at a start of its parameters, not yet scored."""
    effects = (*base.effects, name)
    free = problem.parameters(effects)
    known = {(f.effect, f.name): x for f, x in zip(base.free, base.theta, strict=True)}
    theta = np.array(
        [known[f.effect, f.name] if (f.effect, f.name) in known else start[f.name] for f in free]
    )
    return Fit(effects, free, theta, np.diag([f.sd**2 for f in free]), base.levels, -np.inf)


def handed_over(start: Fit, effect: Effect) -> Fit:
    """What recalibration made of a coefficient put into the factor of the suspect that releases it.

    The product is all that the data know: along the curve on which it stays the same straight steps get nowhere.
    """
    theta = start.theta.copy()
    coefficients = {f.at: i for i, f in enumerate(start.free) if f.relative}
    for own, f in enumerate(start.free):
        if (
            f.effect == effect.name
            and f.how == "scales"
            and not f.relative
            and f.at in coefficients
        ):
            coefficient = coefficients[f.at]
            theta[own] = np.clip(theta[coefficient], f.low, f.high)
            theta[coefficient] /= theta[own]
    return replace(start, theta=theta)


def _look(problem: Problem, base: Fit, effect: Effect, begin: Begin) -> Fit:
    """One suspect: a first step from those of its starts that promise most, the best of them followed further."""
    begun = [
        handed_over(joined(problem, base, effect.name, s), effect) for s in starts(problem, effect)
    ]
    if len(begun) > TRIED:
        on = problem.program.switches(begun[0].effects)
        begun.sort(
            key=lambda b: (
                -begin.promise(
                    problem.whitened(b.free, Space(b.free).clipped(b.theta), on, b.levels)
                )
            )
        )
        begun = begun[:TRIED]
    first = [_step(problem, b, begin, ROUNDS if len(begun) == 1 else 1) for b in begun]
    best = max(first, key=lambda f: f[1])
    if len(begun) > 1:
        best = _step(problem, best[0], begin, ROUNDS - 1)
    found, score = best
    one_sided = cut_off(found.free, found.theta, found.covariance) - cut_off(
        base.free, base.theta, base.covariance
    )
    gain = score - begin.score + _half_determinant(begin.columns) + one_sided
    return replace(found, evidence=base.evidence + gain)


def _step(problem: Problem, start: Fit, begin: Begin, rounds: int) -> tuple[Fit, float]:
    """Gauss-Newton steps; the columns of what was free before stay as they are. Fit and score with its determinant."""
    free, levels = start.free, start.levels
    on = problem.program.switches(start.effects)
    space = Space(free)
    theta = middle = space.clipped(start.theta)
    known, off = begin.columns, np.append(begin.slope, np.zeros(len(free) - len(begin.slope)))

    def look(x: Array) -> tuple[Array, float]:
        white = problem.whitened(free, x, on, levels)
        with np.errstate(
            over="ignore"
        ):  # a boat that runs away has no score, which the caller sees
            return white, log_prior(free, x) - 0.5 * float(white @ white) + float(
                off @ ((x - middle) / space.sd)
            )

    white, score = look(theta)
    own = np.arange(len(free)) >= len(begin.slope)
    for _ in range(
        HALVINGS
    ):  # a start far too strong for this boat is brought nearer to nothing missing
        if np.isfinite(score) and score > begin.score - TOO_STRONG:
            break
        theta = np.where(own, 0.5 * (theta + space.mean), theta)
        white, score = look(theta)
    if not np.isfinite(score):  # the boat runs away
        return start, -np.inf
    damping, J = 1e-3, known
    for _ in range(rounds):
        J = np.hstack([known, jacobian(problem, free, theta, on, levels, white, known.shape[1])])
        gain, kept = 0.0, False
        for _ in range(3):
            g = off - J.T @ white - (theta - space.mean) / space.sd
            trial = space.stepped(theta, J, g, damping)
            promised = space.promised(J, g, theta, trial)
            if (
                promised >= 0.0 and score + promised < begin.score + LITTLE
            ):  # taken at its word: it is nothing
                theta, score, kept = trial, score + promised, True
                break
            after, value = look(trial)
            if np.isfinite(value) and value > score:
                kept = as_promised(value - score, promised)
                theta, white, gain, score = trial, after, value - score, value
                break
            damping = max(damping, 1e-2) * 10.0
        if gain < 0.1 or kept:
            break
    found = replace(start, theta=theta, covariance=space.covariance(np.eye(len(free)) + J.T @ J))
    return found, score - _half_determinant(J)


def _random_look(problem: Problem, base: Fit, effect: Effect) -> Fit:
    """A random force, or the error of an instrument, takes over from the latent one; the best of its starts.

    A force that sways one axis alone would be spoilt by the others: each axis is left out in turn.
    """
    # linearised once; the determinant of what was free before is much the same with and without
    was = problem.likelihood(
        base.free, base.theta, problem.program.switches(base.effects), base.levels
    )
    was += log_prior(base.free, base.theta) + force_prior(problem, base.levels)

    def scored(at: Fit) -> Fit:
        on = problem.program.switches(at.effects)
        score = problem.likelihood(at.free, at.theta, on, at.levels, fresh=False) + log_prior(
            at.free, at.theta
        )
        return replace(at, evidence=base.evidence + score + force_prior(problem, at.levels) - was)

    best = max(map(scored, random_starts(problem, base, effect)), key=lambda f: f.evidence)
    if isinstance(effect, Unsteady):
        for i, axis in enumerate(axes_of(problem.program.vessel)):
            best = max(
                best, scored(_still(best, base, effect.name, i, axis)), key=lambda f: f.evidence
            )
        best = max(best, scored(_taken_over(problem, best, base)), key=lambda f: f.evidence)
    return best


def _still(at: Fit, base: Fit, name: str, i: int, axis: str) -> Fit:
    """A start of a random force without a force along one axis, whose latent one is as it was."""
    off = np.array([(f.effect, f.name) == (name, axis) for f in at.free])
    force = at.levels.force.copy()
    force[i] = base.levels.force[i]
    theta = np.where(off, [f.mean for f in at.free], at.theta)
    return replace(at, theta=theta, levels=replace(at.levels, force=force))


def _taken_over(problem: Problem, at: Fit, base: Fit) -> Fit:
    """A start of a random force where nothing else pushes along its axes but what is tolerated."""
    takes = at.levels.force < base.levels.force
    calm = np.minimum(at.levels.force, problem.ambient.force)
    return replace(at, levels=replace(at.levels, force=np.where(takes, calm, at.levels.force)))


def random_starts(problem: Problem, base: Fit, effect: Effect) -> list[Fit]:
    """Where the fit of a random force begins, with a share of the latent one; that of an instrument's error, in calm.

    Force and noise fitted without that error have taken up what they could of it.
    """
    of_axis = dict(
        zip(
            axes_of(problem.program.vessel), (SWELL_SHARE * base.levels.force).tolist(), strict=True
        )
    )
    if isinstance(effect, Unsteady):
        levels = replace(base.levels, force=SWELL_SHARE * base.levels.force)
        rms = {n: of_axis.get(n, 0.0) for n in type(effect).strength}
    else:
        calm = np.minimum(base.levels.force, problem.ambient.force)
        levels, rms = replace(base.levels, force=calm, sensors=problem.ambient.sensors), {}
    begun = (joined(problem, base, effect.name, start | rms) for start in starts(problem, effect))
    return [replace(fit, levels=levels) for fit in begun]
