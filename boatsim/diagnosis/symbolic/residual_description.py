"""A description of what no entry of the library explains, and how far it carries over to recordings not seen."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.description import Description, Written
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import free_runs
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search import generalization
from boatsim.diagnosis.search.evidence import left_over
from boatsim.diagnosis.symbolic.curves import curve
from boatsim.diagnosis.symbolic.term_forces import ways
from boatsim.diagnosis.symbolic.term_selection import Chosen, chosen, less
from boatsim.progress import Report, silent

# of the mean square errors: free runs must get that much better for one more term to carry over
BETTER = 0.98


def described(
    problem: Problem,
    best: Fit,
    recalibrated: Fit,
    held_out: Sequence[MappedRecording],
    report: Report = silent,
) -> Description | None:
    """What is left over beside a set, as terms; None where no term is worth its price."""
    found = chosen(problem, best, held_out, report)
    if not found.terms:
        return None
    alone = {name: less(problem, found, name).fit for name in found.terms}
    gains = {name: found.fit.evidence - f.evidence for name, f in alone.items()}
    kept = _carried(problem, found, Chosen(best, {}), gains, recalibrated, held_out)
    written, seen = [], ways(problem, found.fit)
    for name, term in sorted(found.terms.items(), key=lambda pair: -gains[pair[0]]):
        carries = name in kept.terms and not term.run
        value, sd = (kept if carries else found).fit.value(name, "coefficient")
        own = found.fit.value(name, "coefficient")
        shown = curve(seen, term, *own)
        written.append(
            Written(
                term.having({"name": name, "coefficient": value}), sd, gains[name], carries, shown
            )
        )
    return Description(tuple(written), kept.fit, left_over(problem, found.fit))


def _carried(
    problem: Problem,
    found: Chosen,
    begun: Chosen,
    gains: Mapping[str, float],
    recalibrated: Fit,
    held_out: Sequence[MappedRecording],
) -> Chosen:
    """As many of the terms that gain most as free runs over unseen recordings are best with, and all events.

    Or none of them, but the entries that made way for them, where these foretell unseen recordings best.
    """
    lasting = sorted((n for n, t in found.terms.items() if not t.run), key=lambda n: gains[n])
    chain = [found]
    for name in lasting:
        chain.append(less(problem, chain[-1], name))
    if not set(begun.fit.effects) <= set(chain[-1].fit.effects):
        chain.append(begun)
    fits = {"recalibrated": recalibrated} | {str(k): c.fit for k, c in enumerate(chain)}
    longest = max((float(t.times[-1] - t.times[0]) for t in held_out), default=0.0)
    stretches = (
        free_runs(problem, fits, held_out, min(problem.horizon, longest)) if held_out else []
    )
    before = generalization.squares(stretches, "recalibrated")
    if not before:  # nobody has seen a law carry over
        return chain[len(lasting)]
    misfits = [
        generalization.misfit(generalization.squares(stretches, str(k)), before)
        for k in range(len(chain))
    ]
    misfits = [m if np.isfinite(m) else np.inf for m in misfits]  # the boat runs away
    best = len(chain) - 1
    for k in reversed(range(len(chain))):
        if misfits[k] < BETTER * misfits[best]:
            best = k
    return chain[best]
