"""Fits of sets of candidates, each computed once, and the screening of further candidates."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim import progress
from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import converge, fit, gauss_newton, remove_effect
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.budget import SearchBudget, in_addition_to_phrase
from boatsim.diagnosis.search.estimated_numbers import refining_candidates
from boatsim.diagnosis.search.evidence import (
    fits_with_evidence_above,
    leading_candidates,
    required_gain,
    unexplained_evidence,
    unknown_cause_threshold,
)
from boatsim.diagnosis.search.screening import (
    Linearisation,
    confirm_screening,
    linearise,
    screen,
    starting_fits,
    starting_points,
)
from boatsim.diagnosis.stage_budgets import search_budget
from boatsim.physics.base import RandomForce
from boatsim.physics.groups import group_of, without_group

SCREENING = (0.2, 0.5)  # of a selection, by experience, is the first screening

Set = frozenset[str]  # names of the effects of a fit
Recordings = Sequence[MappedRecording]


class CandidateSets:
    """Cache of the fits of candidate sets, each computed once, during a search for effects.

    A candidate set is a set of candidate effects added to the vessel model. The cache also records
    which candidates were refuted or screened.
    """

    def __init__(
        self,
        problem: Problem,
        candidates: tuple[str, ...],
        base: Fit,
        report: progress.Report = progress.ignore_progress,
        budget: SearchBudget | None = None,
    ) -> None:
        """Create an empty cache.

        Args:
            problem: The estimation problem: recordings, vessel model, candidate effects and priors.
            candidates: Names of the candidates that are tested.
            base: The recalibrated vessel without candidates.
            report: Receives the progress.
            budget: Work that the search may do; None: that of the configuration, from now on.
        """
        self.problem = problem
        self.budget = budget or search_budget(problem)
        self.config = problem.config
        self.candidates = candidates
        self.base = base
        self.report = report
        self.fits: dict[Set, Fit] = {frozenset(): base}
        self.promised: dict[Set, float] = {}  # evidence that a screening promised
        self.screenings: dict[Set, dict[str, Fit]] = {}
        self.linearised: tuple[Fit, Linearisation] | None = None  # of the latest screening
        # screenings of a candidate on top of a set that were computed again with the full filter
        self.rechecked: set[tuple[Set, str]] = set()
        self.fitted_in_full: set[tuple[Set, str]] = set()
        self.banned: set[str] = set()
        # results of `add_further_effects` by the names of a set and of the candidates then banned
        self.further: dict[tuple[Set, Set], Fit | None] = {}
        self.further_work = 0  # that `add_further_effects` has done [steps x dof]
        self.screening_work = 0  # of the screening of all candidates [steps x dof]
        # effects without which held-out recordings are predicted worse, as free runs show
        self.supported: set[str] = set()
        # log likelihoods of recordings that are held out, by the identities of these and of the fit
        self.predictions: dict[tuple[int, int], tuple[Fit, Recordings, float]] = {}
        self.random = set[str]()  # stochastic forces, and drifts of instruments
        self.unsteady = set[str]()  # stochastic forces
        self.measurement = set[str]()  # errors of the measurement
        for name, effect in problem.candidates.items():
            if type(effect).kind == "measurement":
                self.measurement.add(name)
            if type(effect).random:
                self.random.add(name)
            if isinstance(effect, RandomForce):
                self.unsteady.add(name)
        vessel = problem.program.vessel
        # candidates that only refine an estimated number of the vessel file
        self.refining = refining_candidates(vessel, candidates, problem.candidates)
        self.required_gain = required_gain(len(candidates), self.config.select)

    def add_further_work(self, work: int) -> None:
        """Count work of the search for effects that hide each other.

        Args:
            work: Work [steps x dof].
        """
        self.further_work += work

    def explained_evidence(self, best: Fit) -> float:
        """Return the evidence that a fit's deterministic effects gain over the vessel alone [nats].

        Stochastic forces and drifts of instruments are not counted.

        Args:
            best: Fit of the vessel model with some candidate effects.
        """
        return self._evidence_without(best, self.random)

    def slight_gain(self, best: Fit, own: float = 0.0, measurement: bool = False) -> float:
        """Return the gain below which an effect may only correct the laws of the others [nats].

        It is a share of the evidence that the other effects explain. Errors of the measurement do
        not count for an effect of physics: a force cannot correct them.

        Args:
            best: Fit of the vessel model with some candidate effects.
            own: Evidence that the effect itself gains in this fit [nats].
            measurement: Whether the effect is an error of the measurement.
        """
        share = self.config.select.slight_share
        least = share * (self.explained_evidence(best) - own)
        if measurement or least <= self.required_gain or not self.measurement & set(best.effects):
            return least  # mostly, without further fits
        physics = self._evidence_without(best, self.random | self.measurement)
        return share * max(physics - own, 0.0)

    def _evidence_without(self, best: Fit, left_out: set[str]) -> float:
        """Evidence that a fit gains over the vessel alone when some effects are left out."""
        for name in best.effects:
            if name in left_out:
                best = self.fit_without(best, name)
        return float(best.evidence - self.base.evidence)

    def converged_fit(self, start: Fit) -> Fit:
        """Return the converged fit of a candidate set, from the cache or by fitting it.

        It is fitted again if the given start is better than the cached fit.

        Args:
            start: Unconverged fit of the set, from which the fit starts.
        """
        key = frozenset(start.effects)
        known, promised = self.fits.get(key), self.promised.get(key, -np.inf)
        settled = self.config.fit.refit_gain
        if known is not None and not start.evidence > max(known.evidence, promised) + settled:
            return known
        self.promised[key] = start.evidence  # a screening may promise too much, but only once
        found = converge(self.problem, start)
        if known is not None:
            if found.evidence > known.evidence + settled:
                self.discard_cached_screenings(key)
            found = max(found, known, key=lambda f: f.evidence)
        self.fits[key] = found
        return found

    def refit_from_assumed_disturbance(self, found: Fit) -> Fit:
        """Refit a candidate set with the latent force at its assumed level; return the better fit.

        The latent force is the unmodelled force that the Kalman filter estimates. If it may be as
        large as it was without an effect, the effect is not required to explain all that it can.

        Args:
            found: Fit of the vessel model with the effects of the set.
        """
        config, problem = self.config, self.problem
        if unexplained_evidence(problem, found) < config.select.unknown_gain:
            return found
        other = self.gauss_newton_steps_at_assumed_disturbance(found)
        if self.skips_thorough_search and np.isfinite(other.evidence):
            other = fit(problem, other)
            if self._returns(other, found):
                return found
        if np.isfinite(other.evidence):
            other = converge(problem, other)
        if not other.evidence > found.evidence + config.fit.refit_gain:
            return found
        key = frozenset(found.effects)
        self.discard_cached_screenings(key)
        self.fits[key] = other
        return other

    def _returns(self, other: Fit, found: Fit) -> bool:
        """Whether a refit of the same set leads back to a fit: it is near, and has not gained."""
        gained = other.evidence > found.evidence + self.config.fit.refit_gain
        off = (other.theta - found.theta) / np.sqrt(np.diag(found.covariance))
        return not gained and bool(np.all(np.abs(off) < self.config.select.same_maximum))

    def gauss_newton_steps_at_assumed_disturbance(self, found: Fit) -> Fit:
        """Take a few Gauss-Newton steps of one fit, its latent force at most at the assumed level.

        Args:
            found: Fit of the vessel model with some candidate effects.

        Returns:
            The unconverged fit; its evidence is minus infinity if the simulated vessel diverges.
        """
        force = np.minimum(found.levels.force, self.problem.ambient.force)
        start = replace(found, levels=replace(found.levels, force=force), evidence=-np.inf)
        steps, enough = self.config.select.calm_steps, self.config.fit.refit_gain
        return gauss_newton(self.problem, start, steps, enough)

    def cache_better_fit(self, found: Fit) -> Fit:
        """Store a converged fit if it is better than the cached one of its set; return the better.

        Args:
            found: Converged fit of the vessel model with some candidate effects.
        """
        key = frozenset(found.effects)
        known = self.fits.get(key)
        if known is not None and found.evidence <= known.evidence + self.config.fit.refit_gain:
            return known
        self.discard_cached_screenings(key)
        self.fits[key] = found
        return found

    def discard_cached_screenings(self, key: Set) -> None:
        """Discard cached first estimates of candidate effects that would be added to a given set.

        They are out of date if the fit of the set has since improved.

        Args:
            key: Names of the effects of the set.
        """
        self.screenings.pop(key, None)
        self.rechecked = {pair for pair in self.rechecked if pair[0] != key}
        self.fitted_in_full = {pair for pair in self.fitted_in_full if pair[0] != key}

    def fit_without(self, best: Fit, name: str) -> Fit:
        """Return the converged fit of a candidate set with one of its effects removed.

        Args:
            best: Fit of the vessel model with some candidate effects.
            name: Name of one of its effects.
        """
        known = self.fits.get(frozenset(best.effects) - {name})
        if known is not None:
            return known
        return self.converged_fit(remove_effect(self.problem, best, name))

    def screen_unrefuted(
        self, best: Fit, among: Sequence[str] = (), floor: float = 0.0
    ) -> dict[str, Fit]:
        """Estimate the evidence of adding each candidate effect to a fit, except refuted ones.

        Arguments and result are those of `screen_candidates`.
        """
        return self._unrefuted_fits(self.screen_candidates(best, among, floor))

    def fits_without_each(self, best: Fit) -> dict[str, Fit]:
        """Return, for each effect of a fit, the converged fit with this effect removed.

        Args:
            best: Fit of the vessel model with some candidate effects.
        """
        return {name: self.fit_without(best, name) for name in best.effects}

    def _unrefuted_fits(self, fits: Mapping[str, Fit]) -> dict[str, Fit]:
        """Fits of those candidates that were not refuted."""
        return {name: found for name, found in fits.items() if name not in self.banned}

    def screen_candidates(
        self, best: Fit, among: Sequence[str] = (), floor: float = 0.0
    ) -> dict[str, Fit]:
        """Estimate the evidence of adding each other candidate effect to a fit (screening).

        Each candidate gets a rough fit, and the most promising ones are fitted in full. A search
        that saves work omits candidates that are not expected to gain most. When the budget is
        spent, only additions to the vessel alone are still screened.

        Args:
            best: Fit of the vessel model with some candidate effects.
            among: Names of candidates; none: all of them.
            floor: Gain of evidence of an effect that the candidates compete with [nats].

        Returns:
            The cached fits by name, which may contain further candidates.
        """
        key = frozenset(best.effects)
        known = self.screenings.setdefault(key, {})
        ideas = set(map(name_without_prefixes, best.effects))
        rest = [
            n
            for n in among or self.candidates
            if name_without_prefixes(n) not in ideas and n not in known
        ]
        if key and self.budget.is_spent:
            self.budget.record_skipped_candidates(
                len(rest), f"tested {in_addition_to_phrase(best.effects)}"
            )
            return known
        if rest and key and self.skips_thorough_search:
            self._screen_lazily(best, rest, floor)
        elif rest:
            report = self._report_screening if len(self.screenings) == 1 else None
            before = self.budget.used_work
            known |= screen(self.problem, best, rest, report, self._linearised(best))
            if len(rest) == len(self.candidates):
                self.screening_work = self.budget.used_work - before
        allowed = self._unrefuted_fits(known)
        least = best.evidence + self.required_gain
        if not among and all(f.evidence < least for f in allowed.values()):
            allowed |= self._recheck_failed(best, allowed)
            known |= allowed
        fits = 0
        # a screening may promise too much: the front is determined again after each full fit
        most = self.config.select.most_full_fits
        if self.skips_thorough_search:
            most = min(most, self.config.select.saving_full_fits)
        while fits < most:
            promising = fits_with_evidence_above(allowed, best.evidence)
            ahead = leading_candidates(promising, best, self.config.select)
            ahead = self.order_of_full_fits(key, ahead)
            if not ahead:
                break
            if self.budget.is_spent:
                self.budget.record_skipped_candidates(
                    len(ahead), f"fitted in full {in_addition_to_phrase(best.effects)}"
                )
                break
            name = ahead[0]
            found = known[name]
            if (key, name) not in self.rechecked and name not in self.random:
                found = confirm_screening(self.problem, best, found)
            self.rechecked.add((key, name))
            if found is known[name]:
                self.fitted_in_full.add((key, name))
                fits += 1
                found = self.fit_with_added_effect(best, name, found)
            allowed[name] = known[name] = found
        return known

    def order_of_full_fits(self, key: Set, names: Sequence[str]) -> list[str]:
        """Return candidates that were not fitted in full, in the order in which they are.

        One fault of a drive resembles its other ones, which would leave no fits to other causes:
        those of drives with a full fit come last.

        Args:
            key: Effects of the fit to which they are added.
            names: Candidates that promise most, in that order.
        """
        fitted = {name for other, name in self.fitted_in_full if other == key}
        drives = {self._single_drive(name) for name in fitted} - {None}
        left = [name for name in names if name not in fitted]
        return sorted(left, key=lambda name: self._single_drive(name) in drives)

    def _single_drive(self, name: str) -> tuple[str, str] | None:
        """The drive, and the group of recordings, that a candidate concerns alone."""
        effect = self.problem.candidates[without_group(name)]
        if not type(effect).once_per or not effect.on:
            return None
        vessel, drive = self.problem.program.vessel, next(iter(effect.on))
        if (mounted := vessel.effect(drive)) is not None:
            bound = vessel.bindings(mounted)
            drive = str(bound.get("thrust", bound.get("shaft", drive)))
        return drive, group_of(name)

    @property
    def skips_thorough_search(self) -> bool:
        """Whether the search has done so much work that it omits what hardly changes its result."""
        return self.budget.used_work > self.config.select.thorough_work

    def _screen_lazily(self, best: Fit, names: Sequence[str], floor: float) -> None:
        """Screen candidates in the order of their gains on top of fewer effects.

        It ends at those that hardly gain most: an effect usually gains less evidence the more
        effects there are. This is the accelerated greedy algorithm (M. Minoux, Accelerated greedy
        algorithms for maximizing submodular set functions, Optimization Techniques, 1978). If no
        candidate gains enough, all are screened.
        """
        known = self.screenings[frozenset(best.effects)]
        expected = self._earlier_gains(best, names)
        laws = self._unrefuted_fits(known).items()
        gains = [f.evidence - best.evidence for n, f in laws if n not in self.random]
        lead = max(floor, max(gains, default=0.0))
        for name in sorted(names, key=lambda n: -expected[n]):
            share = self.config.select.lazy_share * lead
            if lead > self.required_gain and expected[name] < share:
                break
            known |= screen(self.problem, best, [name], None, self._linearised(best))
            if name not in self.random | self.banned:
                lead = max(lead, known[name].evidence - best.evidence)

    def _earlier_gains(self, best: Fit, names: Sequence[str]) -> dict[str, float]:
        """Gain of each candidate on top of most of a fit's effects; infinite where unknown."""
        key = frozenset(best.effects)
        found = dict.fromkeys(names, np.inf)
        for other in sorted((s for s in self.screenings if s < key), key=len):
            for name in self.screenings[other].keys() & found.keys():
                fit = self.screenings[other][name]
                found[name] = float(fit.evidence - self.fits[other].evidence)
        return found

    def _linearised(self, best: Fit) -> Linearisation:
        """A fit linearised, once for consecutive screenings on top of it."""
        if self.linearised is None or self.linearised[0] is not best:
            self.linearised = best, linearise(self.problem, best)
        return self.linearised[1]

    def _report_screening(self, share: float) -> None:
        effects = {name_without_prefixes(without_group(name)) for name in self.candidates}
        stage = f"screening {len(effects)} candidate effects"
        progress.report_part_of(self.report, *SCREENING)(stage, share)

    def _recheck_failed(self, best: Fit, allowed: Mapping[str, Fit]) -> dict[str, Fit]:
        """Fit candidates whose screening failed, where much remains that no other one explains.

        An effect may be added only as another one is removed, for example a current and a wind that
        explained both.
        """
        config, key = self.config, frozenset(best.effects)
        worst = best.evidence - config.select.screening_failure
        failed = []
        for name, found in allowed.items():
            if found.evidence < worst and (key, name) not in self.rechecked:
                failed.append(name)
        threshold = (
            unknown_cause_threshold(config.select, self.explained_evidence(best))
            if failed
            else np.inf
        )
        if not failed or unexplained_evidence(self.problem, best) < threshold:
            return {}
        steps, enough = config.select.recheck_steps, config.fit.refit_gain
        refitted = {}
        for name in failed:
            self.rechecked.add((key, name))
            refitted[name] = gauss_newton(self.problem, allowed[name], steps, enough)
        return refitted

    def fit_with_added_effect(self, best: Fit, name: str, screening: Fit) -> Fit:
        """Add a candidate effect to a fit and fit all parameters and noise levels.

        The fit starts from the rough fit of the screening. Where that leaves much unexplained, the
        best of the candidate's starting points is used.

        Args:
            best: Fit of the vessel model with some candidate effects.
            name: Name of the candidate.
            screening: Rough fit with the candidate added.
        """
        problem = self.problem
        found = fit(problem, screening)
        effect = problem.candidates[name]
        single = len(starting_points(problem, effect)) == 1 or type(effect).random
        if single or unexplained_evidence(problem, found) < self.config.select.unknown_gain:
            return found
        steps, enough = self.config.select.start_steps, self.config.fit.refit_gain
        others = []
        for start in starting_fits(problem, best, effect):
            others.append(gauss_newton(problem, start, steps, enough))
        other = max(others, key=lambda f: f.evidence)
        return max(found, fit(problem, other), key=lambda f: f.evidence)

    def promising_candidates(self, best: Fit) -> list[str]:
        """Return the candidate effects that may gain evidence if they are added to a fit.

        They are those that gained evidence in addition to a subset of its effects. The list is
        empty if no subset was screened; all candidates are screened then.

        Args:
            best: Fit of the vessel model with some candidate effects.
        """
        key = frozenset(best.effects)
        gained = set[str]()
        for other, found in self.screenings.items():
            if other <= key:
                gained.update(fits_with_evidence_above(found, self.fits[other].evidence))
        return [n for n in self.candidates if n in gained]
