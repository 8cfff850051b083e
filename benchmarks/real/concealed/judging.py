"""What a diagnosis says of a recording in which a cause is concealed, judged against that cause."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from boatsim.diagnose.analysis import Diagnosis
from boatsim.diagnose.fit import converge, descend
from boatsim.diagnose.problem import Fit, Problem
from boatsim.diagnose.report.answer import key_of
from boatsim.diagnose.report.entries import EffectEntry
from boatsim.diagnose.search.screen import joined
from boatsim.diagnose.tried import FURTHER, called
from boatsim.physics.base import Effect

VISIBLE = 6.0  # [nats] that the true structure gains over no cause, from which a cause can be told
SDS, NEAR = 2.0, 0.15  # a size is right within so many sds, or so near to it
SOME = 0.1  # of a bound or a prior sd: where a parameter that the truth does not state begins


@dataclass(frozen=True)
class Cause:
    """What is concealed, in the library's words; `alike` is what says the same of this recording."""

    name: str
    values: Mapping[str, float] = field(default_factory=dict)  # by parameter with unit, as an answer has them
    alike: tuple["Cause", ...] = ()

    @property
    def either(self) -> tuple["Cause", ...]:
        """Itself and what counts as it."""
        return (self, *self.alike)


@dataclass(frozen=True)
class Verdict:
    """What became of one case."""

    outcome: str  # one of `OUTCOMES`
    said: str
    gain: float | None  # [nats] of the true structure; None where nothing was concealed, or no entry can say it
    own: str = ""  # what the unaltered recordings have of the same causes, too little to be named or known already


RIGHT, SIZE, WRONG, MISSED, ALONE, FAINT = (
    "right",
    "size off",
    "wrong name",
    "missed",
    "left alone",
    "right, though faint",
)
OUTCOMES = (RIGHT, SIZE, WRONG, MISSED, ALONE, FAINT)


def judged(found: Diagnosis, truth: Sequence[Cause], before: Diagnosis, beside: Sequence[Cause] = ()) -> Verdict:
    """The answer against the causes concealed, less what is named of the unaltered recordings of the same boat.

    `beside` are causes that this vessel lacks all along: they must be named too.
    """
    answer, every = found.findings.answer, (*truth, *beside)
    known = {c.name for c in beside} or names_of(before)
    new = [e for e in answer["effects"] if beside or e["name"] not in known or e["name"] in meant(truth)]
    doubt = answer["unknown"]["flag"] and not before.findings.answer["unknown"]["flag"]
    gain = gain_of(found, truth, known)
    visible = gain is not None and gain > VISIBLE
    hits = [next((e for e in new if _says(e, cause)), None) for cause in every]
    wrong = [e for e in new if not any(_says(e, cause) for cause in every)]
    if wrong:
        outcome = WRONG
    elif truth and all(hits):
        sizes = all(right_size(e, cause) for e, cause in zip(hits, truth, strict=False) if e)
        outcome = (RIGHT if sizes else SIZE) if visible else FAINT
    elif visible:
        outcome = MISSED
    else:
        outcome = MISSED if doubt else ALONE
    said = "; ".join([*map(in_words, new), *(["a cause unknown"] if doubt else [])]) or "nothing new"
    return Verdict(outcome, f"{said} ({answer['verdict']})", gain, own_of(before, truth, known))


def names_of(found: Diagnosis) -> set[str]:
    """Names that an answer stands for."""
    return {e["name"] for e in found.findings.answer["effects"]}


def meant(truth: Sequence[Cause]) -> set[str]:
    """All names that would be right."""
    return {c.name for cause in truth for c in cause.either}


def _says(entry: EffectEntry, cause: Cause) -> bool:
    """Whether an entry is that cause, or is said to be hardly told from it."""
    return bool({c.name for c in cause.either} & {entry["name"], *entry["tied_with"]})


def right_size(entry: EffectEntry, cause: Cause) -> bool:
    """Whether the sizes stated are those of the cause; those of one unit are the parts of one arrow."""
    true = next((c.values for c in cause.either if c.name == entry["name"]), {})
    units = {k: entry["parameters"][k]["unit"] for k in true if k in entry["parameters"]}
    for key, unit in units.items():
        size = np.hypot.reduce([true[k] for k in units if units[k] == unit])
        found = entry["parameters"][key]
        if abs(found["value"] - true[key]) > max(SDS * found["sd"], NEAR * size):
            return False
    return True


def in_words(entry: EffectEntry) -> str:
    """Name and sizes of an entry, and what it is tied with."""
    sizes = ", ".join(f"{k} {p['value']:.3g} ± {p['sd']:.2g}" for k, p in entry["parameters"].items())
    tied = f" or {' or '.join(entry['tied_with'])}" if entry["tied_with"] else ""
    return f"{entry['name']} {sizes}{tied}"


def sizes_of(truth: Sequence[Cause]) -> str:
    """Causes with their sizes."""
    return "; ".join(f"{c.name} {', '.join(f'{k} {x:.3g}' for k, x in c.values.items())}".strip() for c in truth)


def gain_of(found: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> float | None:
    """Nats that the true structure, its sizes fitted, gains in the tool's own filter over what is known already.

    None where nothing is concealed or an entry is not there.
    """
    problem = found.problem
    base = whole = _with_known(found, truth, known)
    for cause in truth:
        effect = entry_of(problem, cause.name)
        if effect is None:
            return None
        whole = with_entry(problem, whole, effect, cause.values)
    return whole.evidence - base.evidence if truth else None


def own_of(before: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> str:
    """Sizes of the same causes fitted to the unaltered recordings: a real boat has a little of everything.

    An alteration adds to these, so a size that is off by them is none of the tool's.
    """
    whole, found = _with_known(before, truth, known), []
    for cause in truth:
        if (effect := entry_of(before.problem, cause.name)) is None:
            return ""
        whole = with_entry(before.problem, whole, effect, {})
        values = (whole.value(effect.name, f.name) for f in whole.free if f.effect == effect.name and not f.relative)
        found.append(", ".join(f"{x:.2g} ± {sd:.1g}" for x, sd in values))
    return "; ".join(found)


def _with_known(found: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> Fit:
    """The recalibrated vessel with what is known to be missing from it besides."""
    base = found.ranking.recalibrated
    for name in sorted(set(known) - meant(truth)):
        if (effect := entry_of(found.problem, name)) is not None:
            base = with_entry(found.problem, base, effect, _fitted(found, effect))
    return base


def entry_of(problem: Problem, name: str) -> Effect | None:
    """The library's entry of that name as it was composed with a vessel."""
    there = {e.name: e for e in problem.program.suspects}
    return there.get(FURTHER + name) or there.get(name)


def with_entry(problem: Problem, base: Fit, effect: Effect, values: Mapping[str, float]) -> Fit:
    """An entry added to a fit, begun at these values, all refitted."""
    params = type(effect).params()
    free = [f for f in problem.parameters((effect.name,)) if f.effect == effect.name and not f.relative]
    begin = {f.name: values.get(key_of(f.name, params[f.name].unit), f.mean + SOME * f.sd) for f in free}
    start = joined(problem, base, effect.name, {n: x for n, x in begin.items()})
    return converge(problem, descend(problem, start, 4, 0.1))


def _fitted(found: Diagnosis, effect: Effect) -> dict[str, float]:
    """Values that an answer gives an entry."""
    entries = [e for e in found.findings.answer["effects"] if e["name"] == called(effect.name)]
    return {k: p["value"] for e in entries for k, p in e["parameters"].items()}


def shares(verdicts: Sequence[Verdict]) -> list[tuple[str, str, str]]:
    """What the goals ask for: how many, of how many, the goal."""
    visible = [v for v in verdicts if v.gain is not None and v.gain > VISIBLE]
    faint = [v for v in verdicts if v.gain is None or v.gain <= VISIBLE]
    named = [v for v in visible if v.outcome == RIGHT]
    wrong = [v for v in verdicts if v.outcome == WRONG]
    alone = [v for v in faint if v.outcome in (ALONE, FAINT)]

    def of(some: Sequence[Verdict], all_of_them: Sequence[Verdict]) -> str:
        return f"{len(some)} of {len(all_of_them)}" + (f" = {len(some) / len(all_of_them):.2f}" if all_of_them else "")

    return [
        ("visible causes named, with their size", of(named, visible), ">= 0.80"),
        ("cases with a wrong name", of(wrong, verdicts), "<= 0.02"),
        ("invisible ones left alone, or named rightly all the same", of(alone, faint), "1.00"),
    ]
