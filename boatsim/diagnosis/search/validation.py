"""What recordings that no fit has seen say of a set: which of its members mislead there, what is no look-alike."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import free_runs
from boatsim.diagnosis.noise_levels import fit_force, force_prior
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.candidate_sets import Sets
from boatsim.diagnosis.search.evidence import left_over, told_from
from boatsim.diagnosis.search.forward_selection import SLIGHT
from boatsim.diagnosis.search.pruning import ALIKE, Named, beside

SURE = 2.0  # standard errors by which unseen errors must grow,
# and where it is but between look-alikes, or one is a random force, which foretells nothing
SURE_BETWEEN = 1.65
# where something is left over: an effect with which this share of the force is left is not stood
# for
DWARFED = 0.9


def misled(sets: Sets, best: Fit, held_out: Sequence[MappedRecording]) -> str:
    """The effect without which free runs over unseen recordings are best, if with all they are worse than with none."""
    problem, horizon = sets.problem, _horizon(sets, held_out)
    fits = {"none": sets.base, "all": best} | {n: sets.without(best, n) for n in best.effects}
    first = free_runs(problem, {n: fits[n] for n in ("none", "all")}, held_out, horizon)
    none = generalization.squares(first, "none")
    sure = SURE_BETWEEN if sets.random & set(best.effects) else SURE
    if not none or not generalization.grew(none, generalization.squares(first, "all"), sure):
        return ""
    rest = free_runs(problem, {n: fits[n] for n in best.effects}, held_out, horizon)
    return min(
        best.effects, key=lambda n: generalization.misfit(generalization.squares(rest, n), none)
    )


def refuted(
    sets: Sets, best: Fit, named: Sequence[Named], held_out: Sequence[MappedRecording]
) -> str:
    """The effect by which unseen recordings become unlikelier than without it, if clearly so: it does not carry over.

    Or by which all recordings together gain less, its look-alikes counted in, than its price and what the laws of the
    others may be off by. That asks of each row what the rows before foretell. Free runs over them must not ask for it
    all the same, as they may where unseen recordings go beyond the fitted ones.
    """
    if not held_out:
        return ""
    whole, rest = foretold(sets, best, held_out), {n: sets.without(best, n) for n in best.effects}
    gains = {n: whole - foretold(sets, f, held_out) for n, f in rest.items()}
    unlikelier = {n for n in gains if gains[n] < -told_from(sets.explained(best))}
    others = {n.name: SLIGHT * max(sets.explained(best) - n.gain, 0.0) for n in named}
    little = {n.name for n in named if n.shared + gains[n.name] < sets.price + others[n.name]}
    unlikelier, little = unlikelier - sets.vouched, little - sets.vouched
    if not unlikelier | little:
        return ""
    fits = {"": best, **{n: rest[n] for n in rest if n in unlikelier | little}}
    stretches = free_runs(sets.problem, fits, held_out, _horizon(sets, held_out))
    as_named = generalization.squares(stretches, "")
    if not as_named:
        return min(unlikelier, key=lambda n: gains[n], default="")
    misfits = {
        n: generalization.misfit(generalization.squares(stretches, n), as_named)
        for n in unlikelier | little
    }
    needless = sorted(n for n, misfit in misfits.items() if misfit < generalization.WORSE**2)
    return min(needless, key=lambda n: gains[n], default="")


def missed(sets: Sets, before: Fit, after: Fit, held_out: Sequence[MappedRecording]) -> bool:
    """Whether free runs over unseen recordings get worse by what became of a set without one of its members."""
    stretches = free_runs(
        sets.problem, {"before": before, "after": after}, held_out, _horizon(sets, held_out)
    )
    was, now = (
        generalization.squares(stretches, "before"),
        generalization.squares(stretches, "after"),
    )
    return bool(was) and not generalization.misfit(now, was) < generalization.WORSE**2


def foretold(sets: Sets, found: Fit, held_out: Sequence[MappedRecording]) -> float:
    """Log likelihood [nats] of unseen recordings by a fit to others, the water as rough as it is there."""
    problem = sets.problem.on(held_out)
    there = fit_force(problem, found)
    on = problem.program.switches(there.effects)
    return problem.log_likelihood(there.free, there.theta, on, there.levels) + force_prior(
        problem, there.levels
    )


def with_unseen(
    sets: Sets, best: Fit, rivals: Mapping[str, Fit], held_out: Sequence[MappedRecording]
) -> dict[str, Fit]:
    """Rivals of a member of a set with the evidence that they have beside it on all recordings, unseen ones too."""
    own = foretold(sets, best, held_out)
    if not np.isfinite(own):  # the boat runs away
        return dict(rivals)
    return {
        n: replace(f, evidence=f.evidence + foretold(sets, f, held_out) - own)
        for n, f in rivals.items()
    }


def lawful(
    sets: Sets, best: Fit, named: Sequence[Named], held_out: Sequence[MappedRecording]
) -> Fit | None:
    """A set with a law in the place of a random force, or of a law much like it, if unseen recordings ask for it.

    Free runs over them must get clearly better by it, or all recordings together be clearly likelier. What makes way,
    such as a random force, which foretells nothing and fits whatever sways, is then found to mislead.
    """
    horizon = _horizon(sets, held_out, generalization.FEWEST)
    for one in named:
        least = best.evidence - ALIKE
        if one.name in sets.random:
            least = sets.without(best, one.name).evidence + sets.price
        laws = {n: f for n, f in one.rivals.items() if n not in sets.random and f.evidence > least}
        if not laws:
            continue
        stretches = free_runs(sets.problem, {"": best, **laws}, held_out, horizon)
        as_named = generalization.squares(stretches, "")
        ahead = {
            n
            for n, f in with_unseen(sets, best, laws, held_out).items()
            if f.evidence > best.evidence + ALIKE
        }
        ahead |= {
            n
            for n in laws
            if generalization.grew(generalization.squares(stretches, n), as_named, SURE_BETWEEN)
        }
        better = [f for n, f in laws.items() if n in ahead]
        if better:
            sets.banned.add(one.name)
            return max(better, key=lambda f: f.evidence)
    return None


def told(
    sets: Sets, best: Fit, named: Sequence[Named], held_out: Sequence[MappedRecording]
) -> tuple[Named, ...]:
    """What is named, told from its rivals by all recordings: by evidence, and by unseen free runs that get worse."""
    horizon, found = _horizon(sets, held_out, generalization.FEWEST), []
    for one in named:
        rivals = with_unseen(sets, best, one.rivals, held_out)
        least = best.evidence - ALIKE
        alike = {n: f for n, f in rivals.items() if max(f.evidence, one.rivals[n].evidence) > least}
        stretches = free_runs(sets.problem, {"": best, **alike}, held_out, horizon) if alike else []
        as_named = generalization.squares(stretches, "")
        worse = {
            n
            for n in alike
            if generalization.grew(as_named, generalization.squares(stretches, n), SURE_BETWEEN)
        }
        rest = {n: f for n, f in rivals.items() if n not in worse}
        found.append(beside(one.name, best, sets.without(best, one.name), rest))
    return tuple(found)


def stood_for(sets: Sets, best: Fit, held_out: Sequence[MappedRecording]) -> Fit:
    """A set without those members, found to mislead, that may but stand for a part of what nothing explains.

    Much is left over, they take next to nothing of that force away, and unseen recordings do not ask for them either:
    free runs over these get no worse without them all.
    """
    whole: dict[str, list[float]] = {}
    while not left_over(sets.problem, best) < told_from(sets.explained(best)):
        rest = {n: sets.without(best, n) for n in best.effects}
        little = [
            n for n, f in rest.items() if np.min(best.levels.force / f.levels.force) > DWARFED
        ]
        if little:
            fits = {n: rest[n] for n in little} | ({} if whole else {"": best})
            stretches = free_runs(
                sets.problem, fits, held_out, _horizon(sets, held_out, generalization.FEWEST)
            )
            whole = whole or generalization.squares(stretches, "")
            little = [
                n
                for n in little
                if not generalization.grew(whole, generalization.squares(stretches, n), SURE)
            ]
        if not little:
            break
        name = max(little, key=lambda n: rest[n].evidence)
        sets.banned.add(name)
        best = rest[name]
    return best


def _horizon(sets: Sets, held_out: Sequence[MappedRecording], parts: int = 1) -> float:
    """Length [s] of free runs: the usual one, unless the longest recording holds not so many of them."""
    longest = max((float(np.ptp(t.times)) for t in held_out), default=0.0)
    return min(sets.problem.horizon, longest / parts)
