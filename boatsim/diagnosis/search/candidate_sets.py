"""Sets of suspects: the fit of each, made once, and how every other suspect does on top of it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim import progress
from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.fit import converge, fit, gauss_newton, remove_effect
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import UNKNOWN, front, left_over, price, told_from
from boatsim.diagnosis.search.screening import add_effect, hand_over, recheck, screen, starts
from boatsim.physics.base import Unsteady

# [nats] that a look lies below the set it is on top of, from which it went wrong: numbers cost less
ASTRAY = 8.0
SCREENING = (0.2, 0.5)  # of a ranking, by experience, is the first look at all
MANY = 6  # suspects on top of a set that are fitted in full at most


class Sets:
    """Fits of sets of suspects."""

    def __init__(
        self,
        problem: Problem,
        candidates: tuple[str, ...],
        base: Fit,
        report: progress.Report = progress.silent,
    ) -> None:
        self.problem, self.candidates, self.base, self.report = problem, candidates, base, report
        self.config = problem.config
        self.fits: dict[frozenset[str], Fit] = {frozenset(): base}
        self.promised: dict[frozenset[str], float] = {}
        self.looks: dict[frozenset[str], dict[str, Fit]] = {}
        self.kept: set[tuple[frozenset[str], str]] = (
            set()
        )  # looks that were compared with what the filter says,
        self.full: set[tuple[frozenset[str], str]] = set()  # and followed by a fit in full
        self.banned: set[str] = set()
        self.vouched: set[str] = (
            set()
        )  # members without which sets foretell unseen recordings worse, free runs say
        self.random = {e.name for e in problem.program.candidates if type(e).random}
        self.unsteady = {
            e.name for e in problem.program.candidates if isinstance(e, Unsteady)
        }  # of them, forces
        self.price = price(len(candidates))

    def explained(self, best: Fit) -> float:
        """Nats that the laws of a set gain over the recalibrated vessel, without what is random beside them.

        A random force or error has no shape that nature's could differ from: it explains no law's remainder away.
        """
        laws = best
        for name in (
            n for n in best.effects if n in self.random
        ):  # in their order, not that of hashes
            laws = self.without(laws, name)
        return float(laws.evidence - self.base.evidence)

    def converged(self, start: Fit) -> Fit:
        """The fit of a set, kept: made from `start` unless it was made before from one no worse."""
        key = frozenset(start.effects)
        known, promised = self.fits.get(key), self.promised.get(key, -np.inf)
        if (
            known is None
            or start.evidence > max(known.evidence, promised) + self.config.fit.refit_gain
        ):
            self.promised[key] = (
                start.evidence
            )  # a look may promise more than a fit keeps, but once only
            found = converge(self.problem, start)
            if known is not None and found.evidence > known.evidence + self.config.fit.refit_gain:
                self.forget(key)
            self.fits[key] = max(found, known or found, key=lambda f: f.evidence)
        return self.fits[key]

    def trusted(self, found: Fit) -> Fit:
        """A fit that leaves much over, or a better one begun as if it explained everything.

        Where the water may push as hard as it did without an effect, the effect is not asked for all that it can do.
        """
        if left_over(self.problem, found) < UNKNOWN:
            return found
        calm = replace(
            found.levels, force=np.minimum(found.levels.force, self.problem.ambient.force)
        )
        begun = gauss_newton(
            self.problem,
            replace(found, levels=calm, evidence=-np.inf),
            4,
            self.config.fit.refit_gain,
        )
        other = converge(self.problem, begun) if np.isfinite(begun.evidence) else begun
        if not other.evidence > found.evidence + self.config.fit.refit_gain:
            return found
        key = frozenset(found.effects)
        self.forget(key)
        self.fits[key] = other
        return other

    def forget(self, key: frozenset[str]) -> None:
        """What was looked at on top of a set was compared with a fit that was not its best: look again."""
        self.looks.pop(key, None)
        self.kept = {x for x in self.kept if x[0] != key}
        self.full = {x for x in self.full if x[0] != key}

    def without(self, best: Fit, name: str) -> Fit:
        """The fit of a set without one of its members."""
        return self.converged(remove_effect(self.problem, best, name))

    def tried(self, best: Fit, among: Sequence[str] = ()) -> dict[str, Fit]:
        """Other candidates on top of a set, all or `among` some, less those found to mislead."""
        return {n: f for n, f in self.looked(best, among).items() if n not in self.banned}

    def looked(self, best: Fit, among: Sequence[str] = ()) -> dict[str, Fit]:
        """Other candidates on top of a set: a quick look at all, or `among` some, those in front fitted in full."""
        key = frozenset(best.effects)
        known = self.looks.setdefault(key, {})
        ideas = {called(n) for n in best.effects}
        rest = [n for n in among or self.candidates if called(n) not in ideas and n not in known]
        if rest:
            known |= screen(
                self.problem, best, rest, self._screened if len(self.looks) == 1 else None
            )
        allowed = {n: f for n, f in known.items() if n not in self.banned}
        if not among and all(f.evidence < best.evidence + self.price for f in allowed.values()):
            allowed |= self._looked_again(best, allowed)
            known |= allowed
        fits = 0
        while (
            fits < MANY
        ):  # a look may promise too much: what is in front then is judged anew after each fit
            hopeful = {n: f for n, f in allowed.items() if f.evidence > best.evidence}
            ahead = [n for n in front(hopeful, best) if (key, n) not in self.full]
            if not ahead:
                break
            name, look = ahead[0], known[ahead[0]]
            honest = (
                look
                if (key, name) in self.kept or name in self.random
                else recheck(self.problem, best, look)
            )
            self.kept.add((key, name))
            if honest is look:
                self.full.add((key, name))
                fits += 1
                honest = self.fitted(best, name, look)
            allowed[name] = known[name] = honest
        return known

    def _screened(self, share: float) -> None:
        progress.part(self.report, *SCREENING)(f"screening {len(self.candidates)} entries", share)

    def _looked_again(self, best: Fit, allowed: Mapping[str, Fit]) -> dict[str, Fit]:
        """Where much is left over that no look promised to explain: those that went wrong, followed by the filter.

        An effect may come in only as another makes way, as a current beside a wind that had stood for both.
        """
        key = frozenset(best.effects)
        wrong = [
            n
            for n, f in allowed.items()
            if f.evidence < best.evidence - ASTRAY and (key, n) not in self.kept
        ]
        if not wrong or left_over(self.problem, best) < told_from(self.explained(best)):
            return {}
        self.kept |= {(key, n) for n in wrong}
        return {
            n: gauss_newton(
                self.problem,
                allowed[n],
                self.config.select.recheck_steps,
                self.config.fit.refit_gain,
            )
            for n in wrong
        }

    def fitted(self, best: Fit, name: str, look: Fit) -> Fit:
        """A candidate fitted in full from its quick look; where that leaves much over, from the best of its starts."""
        found = fit(self.problem, look)
        effect = next(e for e in self.problem.program.candidates if e.name == name)
        begun = starts(self.problem, effect)
        if len(begun) == 1 or type(effect).random or left_over(self.problem, found) < UNKNOWN:
            return found
        others = [hand_over(add_effect(self.problem, best, name, s), effect) for s in begun]
        other = max(
            (gauss_newton(self.problem, o, 2, self.config.fit.refit_gain) for o in others),
            key=lambda f: f.evidence,
        )
        return max(found, fit(self.problem, other), key=lambda f: f.evidence)

    def hopeful(self, best: Fit) -> list[str]:
        """Candidates that may gain on top of a set: those that gained on top of one that it contains.

        None where no such set was looked at, as at the beginning of a second pass: all are looked at then.
        """
        key = frozenset(best.effects)
        looks = {k: x for k, x in self.looks.items() if k <= key}
        gained = {
            n for k, x in looks.items() for n, f in x.items() if f.evidence > self.fits[k].evidence
        }
        return [n for n in self.candidates if n in gained]
