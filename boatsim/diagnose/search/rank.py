"""Names what is missing: every suspect fitted in the filter, scored by evidence, selected forward, pruned backward."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from boatsim.diagnose.filter import Track
from boatsim.diagnose.fit import SETTLED, converge, descend, fit, reduced
from boatsim.diagnose.free_runs import free_runs
from boatsim.diagnose.levels import calm_prior, fit_noise
from boatsim.diagnose.locate.structure import FACTOR, Structure, structure
from boatsim.diagnose.problem import Fit, Problem
from boatsim.diagnose.search import carries
from boatsim.diagnose.search.screen import checked, handed_over, joined, screen, starts
from boatsim.diagnose.spread import widened
from boatsim.diagnose.tried import called

progress = logging.getLogger("boatsim.diagnose")
ODDS = 2.0  # log of the odds, seven to one, at which an effect is named, where each of those tried is as likely before
ALIKE = 3.0  # [nats] entries this close to the winner are its look-alikes
CLOSE = 5.0  # candidates this near to the first [nats] are fitted in full,
HALF = 0.5  # and those with this share of its gain
MANY = 6  # but no more of them than this
MOST = 8  # effects in one answer: further ones would have next to no data of their own
SURE, SURE_RANDOM = 2.0, 1.65  # standard errors by which unseen errors must grow; a random force predicts nothing
LAWFUL = 0.5  # share of the gain of a random force from which a law is taken in its place
CLEAR = 40.0  # prices that an effect is worth by the curvature at a fit, from where it stays without a fit without it
RIVALS = 3  # fitted in the place of what was named
CALMER = (0.5, 0.25, 0.1, 0.03)  # shares of the force levels of a fit with which the water may be calmer
WORTH = 4.0  # [nats] that an effect must gain by itself,
DWARFED = 0.9  # where something is left over: an effect with which this share of the force is left is not stood for
UNKNOWN = 6.0  # [nats] it must gain for the cause to lie outside the library,
SLIGHT = 0.025  # of what the others explain, below which an effect may be what their laws are off by
INEXACT = 0.05  # and so much of what was explained: nature's laws are never quite the entries',
ALONG = 0.02  # less of it for a force that goes with something


@dataclass(frozen=True)
class Named:
    """An effect the data call for."""

    name: str
    gain: float  # [nats] on top of the others named
    shared: float  # [nats] that it and its rivals gain together: that one of them is there, whichever
    probability: float
    tied_with: tuple[str, ...]  # look-alikes, at most three
    rivals: Mapping[str, Fit]  # fits with the next best suspects in its place


@dataclass(frozen=True)
class Ranking:
    """What selection found."""

    nominal: Fit  # the vessel as written, noise and force levels fitted
    recalibrated: Fit  # the nominal structure with its own coefficients refitted
    best: Fit
    named: tuple[Named, ...]
    first: dict[str, float]  # gain of every suspect alone over the recalibrated nominal [nats]
    last: dict[str, Fit]  # every suspect not named, on top of the best set
    left_over: float  # [nats] that a force beyond the tolerated one gains after the best set
    structure: Structure  # what goes best with the force left over

    @property
    def unknown(self) -> bool:
        """Whether something is left that no entry of the library explains."""
        return bool(self.left_over > self.told_from) or self.structured

    @property
    def structured(self) -> bool:
        """Whether what is left over, however weak, goes with something."""
        explained = float(self.best.evidence - self.recalibrated.evidence)
        return self.structure.likely and self.structure.gain > told_from(explained, ALONG)

    @property
    def told_from(self) -> float:
        """What must be left over [nats] for something to be missing besides: a law is never quite that of its entry."""
        return told_from(float(self.best.evidence - self.recalibrated.evidence))


def rank(
    problem: Problem, candidates: tuple[str, ...], unseen: Sequence[Track] = (), begin: Fit | None = None
) -> Ranking:
    """Forward selection over the candidates, the incumbent converged before each comparison, members exchanged.

    It begins with nothing, or with the set of another fit. Where far more stays unexplained than an effect explains, it
    is not stood for; nor is one by which free runs over `unseen` recordings get worse.
    """
    progress.info("fitting the vessel as written to %d recordings", len(problem.tracks))
    nominal, recalibrated = baseline(problem)
    progress.info("trying %d entries of the library", len(candidates))
    search = _Search(problem, candidates, recalibrated)
    best, named = search.settled(search.selected(search.begun(begin) if begin else recalibrated))
    while search.little(best):
        best, named = search.settled(search.stood_for(best))
    progress.info("judging what is left over")
    while named and unseen and (worse := misled(problem, search, best, unseen)):
        search.banned.add(worse)
        best, named = search.settled(search.selected(search.without(best, worse)))
    while unseen and (law := lawful(problem, search, best, named, unseen)):
        best, named = search.settled(search.selected(law))
    left = left_over(problem, best)
    tried = search.looked(best)
    first = {n: f.evidence - search.base.evidence for n, f in search.looked(search.base).items()}
    goes_with = structure(problem, best)
    return Ranking(nominal, search.base, widened(problem, best), named, first, tried, left, goes_with)


def misled(problem: Problem, search: "_Search", best: Fit, unseen: Sequence[Track]) -> str:
    """The effect without which free runs over unseen recordings are best, if with all they are worse than with none."""
    horizon = min(problem.horizon, max(float(np.ptp(t.times)) for t in unseen))
    fits = {"none": search.base, "all": best} | {n: search.without(best, n) for n in best.suspects}
    first = free_runs(problem, {n: fits[n] for n in ("none", "all")}, unseen, horizon)
    none = carries.squares(first, "none")
    sure = SURE_RANDOM if search.random & set(best.suspects) else SURE
    if not none or not carries.grew(none, carries.squares(first, "all"), sure):
        return ""
    rest = free_runs(problem, {n: fits[n] for n in best.suspects}, unseen, horizon)
    return min(best.suspects, key=lambda n: carries.misfit(carries.squares(rest, n), none))


def lawful(
    problem: Problem, search: "_Search", best: Fit, named: Sequence[Named], unseen: Sequence[Track]
) -> Fit | None:
    """A set with a law in the place of a random force, if by it free runs over unseen recordings get clearly better.

    The random force, which foretells nothing and fits whatever sways, is then found to mislead.
    """
    horizon = min(problem.horizon, max(float(np.ptp(t.times)) for t in unseen) / carries.FEWEST)
    for one in (n for n in named if n.name in search.random):
        base = search.without(best, one.name).evidence + search.price
        laws = {n: f for n, f in one.rivals.items() if n not in search.random and f.evidence > base}
        if not laws:
            continue
        stretches = free_runs(problem, {"": best, **laws}, unseen, horizon)
        by_chance = carries.squares(stretches, "")
        better = [f for n, f in laws.items() if carries.grew(carries.squares(stretches, n), by_chance, SURE_RANDOM)]
        if better:
            search.banned.add(one.name)
            return max(better, key=lambda f: f.evidence)
    return None


def selection(problem: Problem, candidates: tuple[str, ...]) -> tuple[Fit, Fit]:
    """The recalibrated nominal and the best set on top of it, and no more: for cross-validation."""
    _, recalibrated = baseline(problem)
    return recalibrated, _Search(problem, candidates, recalibrated).selected(recalibrated)


def baseline(problem: Problem) -> tuple[Fit, Fit]:
    """The vessel as written with noise and force levels fitted, and recalibrated: its own coefficients refitted."""
    nominal = fit_noise(problem, problem.nominal())
    return nominal, converge(problem, descend(problem, nominal, 4, 0.1))


class _Search:
    """Fits of sets of suspects, each made once."""

    def __init__(self, problem: Problem, candidates: tuple[str, ...], base: Fit) -> None:
        self.problem, self.candidates, self.base = problem, candidates, base
        self.fits: dict[frozenset[str], Fit] = {frozenset(): base}
        self.promised: dict[frozenset[str], float] = {}
        self.looks: dict[frozenset[str], dict[str, Fit]] = {}
        self.kept: set[tuple[frozenset[str], str]] = set()  # looks that were compared with what the filter says,
        self.full: set[tuple[frozenset[str], str]] = set()  # and followed by a fit in full
        self.banned: set[str] = set()
        self.random = {e.name for e in problem.program.suspects if type(e).random}
        self.price = price(len(candidates))

    def selected(self, best: Fit) -> Fit:
        """The best set from one on: suspects added one by one, earlier ones dropped that a newer one makes needless."""
        for _ in range(2 * MOST):  # additions and prunings together
            tried = self.tried(best)
            if not tried or len(best.suspects) == MOST:
                break
            laws = {n: f for n, f in tried.items() if n not in self.random}
            if self.gained(laws, best) > max(self.price, LAWFUL * self.gained(tried, best)):
                tried = laws  # a random force can stand for a law, a law hardly for it
            if self.gained(tried, best) < max(self.price, SLIGHT * self.explained(best)):
                break
            name = max(tried, key=lambda n: tried[n].evidence)
            further = self.pruned(self.converged(tried[name]))
            if set(further.suspects) == set(best.suspects):
                break  # the newest made way again
            best = further
            gain = best.evidence - self.base.evidence
            progress.info("best so far: %s (%.0f nats)", ", ".join(map(called, best.suspects)), gain)
        return best

    def begun(self, other: Fit) -> Fit:
        """The set of a fit to the same recordings with other levels, fitted anew."""
        return self.converged(replace(other, levels=self.base.levels, evidence=-np.inf))

    @staticmethod
    def gained(tried: Mapping[str, Fit], best: Fit) -> float:
        """Nats that one of several entries gains on top of a set, whichever."""
        return together([f.evidence - best.evidence for f in tried.values()]) if tried else -np.inf

    def told_from(self, best: Fit) -> float:
        """What must be left over [nats] for something to be missing besides a set."""
        return told_from(self.explained(best))

    def explained(self, best: Fit) -> float:
        """Nats that a set gains over the recalibrated vessel."""
        return float(best.evidence - self.base.evidence)

    def converged(self, start: Fit) -> Fit:
        """The fit of a set, kept: made from `start` unless it was made before from one no worse."""
        key = frozenset(start.suspects)
        known, promised = self.fits.get(key), self.promised.get(key, -np.inf)
        if known is None or start.evidence > max(known.evidence, promised) + SETTLED:
            self.promised[key] = start.evidence  # a look may promise more than a fit keeps, but once only
            found = converge(self.problem, start)
            if known is not None and found.evidence > known.evidence + SETTLED:
                self.forget(key)
            self.fits[key] = max(found, known or found, key=lambda f: f.evidence)
        return self.fits[key]

    def forget(self, key: frozenset[str]) -> None:
        """What was looked at on top of a set was compared with a fit that was not its best: look again."""
        self.looks.pop(key, None)
        self.kept = {x for x in self.kept if x[0] != key}
        self.full = {x for x in self.full if x[0] != key}

    def without(self, best: Fit, name: str) -> Fit:
        """The fit of a set without one of its members."""
        return self.converged(reduced(self.problem, best, name))

    def tried(self, best: Fit, among: Sequence[str] = ()) -> dict[str, Fit]:
        """Other candidates on top of a set, all or `among` some, less those found to mislead."""
        return {n: f for n, f in self.looked(best, among).items() if n not in self.banned}

    def looked(self, best: Fit, among: Sequence[str] = ()) -> dict[str, Fit]:
        """Other candidates on top of a set: a quick look at all, or `among` some, those in front fitted in full."""
        key = frozenset(best.suspects)
        known = self.looks.setdefault(key, {})
        ideas = {called(n) for n in best.suspects}
        rest = [n for n in among or self.candidates if called(n) not in ideas and n not in known]
        if rest:
            known |= screen(self.problem, best, rest)
        allowed = {n: f for n, f in known.items() if n not in self.banned}
        fits = 0
        while fits < MANY:  # a look may promise too much: what is in front then is judged anew after each fit
            hopeful = {n: f for n, f in allowed.items() if f.evidence > best.evidence}
            ahead = [n for n in _front(hopeful, best) if (key, n) not in self.full]
            if not ahead:
                break
            name, look = ahead[0], known[ahead[0]]
            honest = look if (key, name) in self.kept or name in self.random else checked(self.problem, best, look)
            self.kept.add((key, name))
            if honest is look:
                self.full.add((key, name))
                fits += 1
                honest = self.fitted(best, name, look)
            allowed[name] = known[name] = honest
        return known

    def fitted(self, best: Fit, name: str, look: Fit) -> Fit:
        """A candidate fitted in full from its quick look; where that leaves much over, from the best of its starts."""
        found = fit(self.problem, look)
        effect = next(e for e in self.problem.program.suspects if e.name == name)
        begun = starts(self.problem, effect)
        if len(begun) == 1 or type(effect).random or left_over(self.problem, found) < UNKNOWN:
            return found
        others = [handed_over(joined(self.problem, best, name, s), effect) for s in begun]
        other = max((descend(self.problem, o, 2, SETTLED) for o in others), key=lambda f: f.evidence)
        return max(found, fit(self.problem, other), key=lambda f: f.evidence)

    def hopeful(self, best: Fit) -> list[str]:
        """Candidates that may gain on top of a set: those that gained on top of one that it contains.

        None where no such set was looked at, as at the beginning of a second pass: all are looked at then.
        """
        key = frozenset(best.suspects)
        looks = {k: x for k, x in self.looks.items() if k <= key}
        gained = {n for k, x in looks.items() for n, f in x.items() if f.evidence > self.fits[k].evidence}
        return [n for n in self.candidates if n in gained]

    def pruned(self, best: Fit) -> Fit:
        """Without the earlier effects that the newest one has made needless."""
        for name in best.suspects[:-1]:
            if worth(best, name) > CLEAR * self.price:
                continue
            without = self.without(best, name)
            if without.evidence > best.evidence - self.price:
                best = without
        return best

    def settled(self, best: Fit) -> tuple[Fit, tuple[Named, ...]]:
        """The set without members that gain too little on top of the others, and what is to be said of the rest.

        A member in whose place another does better makes way for it, unless that leads back to where it was.
        """
        seen = set()
        while True:
            seen.add(frozenset(best.suspects))
            named = tuple(self.named(best, n) for n in best.suspects)
            rivals = [(n.name, r, f) for n in named for r, f in n.rivals.items()]
            fair = [f for name, rival, f in rivals if name in self.random or rival not in self.random]
            better = [f for f in fair if f.evidence > best.evidence + SETTLED]
            further = self.selected(max(better, key=lambda f: f.evidence)) if better else best
            if frozenset(further.suspects) not in seen:
                best = further
                continue
            weak = [n for n in named if self.weak(best, n)]
            if not weak:
                return best, named
            best = self.without(best, min(weak, key=lambda n: n.gain).name)

    def weak(self, best: Fit, named: Named) -> bool:
        """Whether a member gains too little to be named."""
        beside = SLIGHT * (self.explained(best) - named.gain)
        if named.gain < max(WORTH, beside) or named.shared < self.price or not self.there(best, named.name):
            return True
        if named.name in self.random:
            return False
        return named.gain + self.calmer(best) - self.calmer(self.without(best, named.name)) < WORTH

    def calmer(self, found: Fit) -> float:
        """Nats that a fit would gain if water calmer than usual were no less likely.

        It is no merit of a law that it keeps the hull still where nothing moves it, as more damping does.
        """
        on, fits = self.problem.program.switches(found.suspects), [found.levels]
        fits += [replace(found.levels, force=share * found.levels.force) for share in CALMER]
        first, *calm = (
            self.problem.likelihood(found.free, found.theta, on, levels, i == 0) for i, levels in enumerate(fits)
        )
        return max(first, *calm) - first - calm_prior(self.problem, found.levels)

    def stood_for(self, best: Fit) -> Fit:
        """A set without those members, found to mislead, that are little beside what nothing explains."""
        while little := self.little(best):
            self.banned.add(little)
            best = self.without(best, little)
        return best

    def little(self, best: Fit) -> str:
        """Where much is left over the member of least gain that takes away next to nothing of that force; or ""."""
        if left_over(self.problem, best) < self.told_from(best):
            return ""
        rest = {n: self.without(best, n) for n in best.suspects}
        little = [n for n, f in rest.items() if np.min(best.levels.force / f.levels.force) > DWARFED]
        return max(little, key=lambda n: rest[n].evidence) if little else ""

    def there(self, best: Fit, name: str) -> bool:
        """Whether an effect is more than a standard deviation from not acting: if not, only the search gained by it."""
        kind = next(type(e) for e in self.problem.program.suspects if e.name == name)
        params = {n: p for n, p in kind.params().items() if n in (kind.strength or kind.params())}
        own = (f.name for f in best.free if f.effect == name and not f.relative)
        fitted = {n: params[n].absent for n in own if n in params}
        found = {n: best.value(name, n) for n in fitted}
        return not found or any(abs(x - fitted[n]) > sd for n, (x, sd) in found.items())

    def named(self, best: Fit, name: str) -> Named:
        """Gain of one effect on top of the others, and how its rivals do in its place."""
        without = self.without(best, name)
        gain = best.evidence - without.evidence
        tried = self.tried(without, [n for n in self.hopeful(without) if n != name])
        others = {n: f for n, f in tried.items() if n not in best.suspects}
        front = {n: others[n] for n in _front(others, without)[:RIVALS]}
        key = frozenset(without.suspects)
        poor = {n for n, f in front.items() if (key, n) in self.full and f.evidence < without.evidence + HALF * gain}
        rivals = {n: f if n in poor else self.converged(f) for n, f in front.items()}
        gains = {n: f.evidence - without.evidence for n, f in rivals.items()}
        weights = np.exp(np.array([0.0, gain, *gains.values()]) - max(gain, 0.0, *gains.values()))
        same = np.array([False, True, *(called(n) == called(name) for n in gains)])  # on either side of an actuator
        order = sorted(gains, key=lambda n: -gains[n])
        tied = tuple(n for n in order if gains[n] > gain - ALIKE and called(n) != called(name))[:3]
        return Named(
            name,
            gain,
            together([gain, *gains.values()]),
            float(weights[same].sum() / weights.sum()),
            tied,
            {n: rivals[n] for n in order},
        )


def price(number: int) -> float:
    """Nats that an effect must gain, its look-alikes counted in, where so many were tried.

    Before the data each is as likely as another, and one of them as likely to be there as none.
    """
    return ODDS + float(np.log(max(number, 1)))


def told_from(explained: float, inexact: float = INEXACT) -> float:
    """Nats left over from which something is missing that the library has not, where its entries explained so many."""
    return UNKNOWN + inexact * max(explained, 0.0)


def together(gains: Sequence[float]) -> float:
    """Nats that one of several entries gains, whichever: the evidence that any is there, but for how many there are."""
    return float(np.logaddexp.reduce(np.array(gains, dtype=float)))


def worth(best: Fit, name: str) -> float:
    """Nats that a member gains by the curvature at a fit: half the square of its distance from not acting, in sds.

    That is far more than it gains where the latent force may take its place, which a curvature knows nothing of.
    """
    own = [i for i, f in enumerate(best.free) if f.effect == name and not f.relative]
    off = best.theta[own] - np.array([best.free[i].mean for i in own])
    return 0.5 * float(off @ np.linalg.solve(best.covariance[np.ix_(own, own)], off)) if own else 0.0


def _front(tried: Mapping[str, Fit], base: Fit) -> list[str]:
    """Candidates that may yet turn out the best, the best first: a quick look leaves out what the force levels take."""
    gains = {n: f.evidence - base.evidence for n, f in tried.items()}
    order = sorted(gains, key=lambda n: -gains[n])
    reach = max(CLOSE, HALF * gains[order[0]]) if order else 0.0
    return [n for n in order if gains[n] > gains[order[0]] - reach]


def left_over(problem: Problem, best: Fit) -> float:
    """Nats that the latent force gains beyond the tolerated level: what nothing in the library explains."""
    on = problem.program.switches(best.suspects)
    held = replace(best.levels, force=np.minimum(best.levels.force, FACTOR * problem.ambient.force))
    free = problem.likelihood(best.free, best.theta, on, best.levels)
    return free - problem.likelihood(best.free, best.theta, on, held)
