"""What a diagnosis says of a recording in which a cause is concealed, judged against that cause."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from boatsim.diagnosis.candidates import FURTHER, called
from boatsim.diagnosis.fit import converge, gauss_newton
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report.answer import key_of
from boatsim.diagnosis.report.schema import EffectEntry
from boatsim.diagnosis.search.screening import add_effect
from boatsim.physics.base import Effect

VISIBLE = 6.0  # [nats] that the true structure gains over no cause, from which a cause can be told
SDS, NEAR = 2.0, 0.15  # a size is right within so many sds, or so near to it
SOME = 0.1  # of a bound or a prior sd: where a parameter that the truth does not state begins


@dataclass(frozen=True)
class Cause:
    """What is concealed, in the library's words; `alike` is what says the same of this recording."""

    name: str
    # by parameter with unit, as an answer has them
    values: Mapping[str, float] = field(default_factory=dict)
    alike: tuple["Cause", ...] = ()

    @property
    def either(self) -> tuple["Cause", ...]:
        """Itself and what counts as it."""
        return (self, *self.alike)


@dataclass(frozen=True)
class Size:
    """A parameter with its sd; `absent` is its value where the cause is not there."""

    value: float
    sd: float
    absent: float = 0.0

    def with_own(self, own: "Size") -> "Size":
        """This and what a boat has of it already: factors multiply, all else adds up."""
        if own.absent == 1.0:
            return Size(self.value * own.value, self.value * own.sd, 1.0)
        return Size(self.value + own.value, own.sd)


@dataclass(frozen=True)
class Verdict:
    """What became of one case."""

    outcome: str  # one of `OUTCOMES`
    said: str
    gain: (
        float | None
    )  # [nats] of the true structure; None where nothing was concealed, or no entry can say it
    # what the unaltered recordings have of the same causes, too little to be named or known already
    own: str = ""


RIGHT, SIZE, WRONG, MISSED, ALONE, FAINT = (
    "right",
    "size off",
    "wrong name",
    "missed",
    "left alone",
    "right, though faint",
)
OUTCOMES = (RIGHT, SIZE, WRONG, MISSED, ALONE, FAINT)


def judged(
    found: Diagnosis, truth: Sequence[Cause], before: Diagnosis, beside: Sequence[Cause] = ()
) -> Verdict:
    """The answer against the causes concealed, less what is named of the unaltered recordings of the same boat.

    `beside` are causes that this vessel lacks all along: they must be named too.
    """
    answer, every = found.findings.answer, (*truth, *beside)
    known = {c.name for c in beside} or names_of(before)
    new = [
        e
        for e in answer["effects"]
        if beside or e["name"] not in known or e["name"] in meant(truth)
    ]
    doubt = answer["unknown"]["flag"] and not before.findings.answer["unknown"]["flag"]
    gain = gain_of(found, truth, known)
    visible = gain is not None and gain > VISIBLE
    own = own_of(before, truth, known)
    hits = [next((e for e in new if _says(e, cause)), None) for cause in every]
    wrong = [e for e in new if not any(_says(e, cause) for cause in every)]
    of_boat = [e for e in wrong if of_the_boat(before, e, known)]
    wrong = [e for e in wrong if e not in of_boat]
    if wrong:
        outcome = WRONG
    elif truth and all(hits):
        sizes = all(
            right_size(e, cause, own.get(e["name"]))
            for e, cause in zip(hits, truth, strict=False)
            if e
        )
        outcome = (RIGHT if sizes else SIZE) if visible else FAINT
    elif visible:
        outcome = MISSED
    else:
        outcome = MISSED if doubt else ALONE
    words = [f"{in_words(e)}{' (the unaltered ones have it)' if e in of_boat else ''}" for e in new]
    said = "; ".join([*words, *(["a cause unknown"] if doubt else [])]) or "nothing new"
    return Verdict(
        outcome, f"{said} ({answer['verdict']})", gain, "; ".join(map(in_numbers, own.values()))
    )


def of_the_boat(before: Diagnosis, entry: EffectEntry, known: Collection[str]) -> bool:
    """Whether a name says what is left over of the unaltered recordings too, where nothing was named for it.

    Only where something unknown is left there, and the entry, fitted to them, gains and has the same sizes.
    """
    effect = entry_of(before.problem, entry["name"])
    if effect is None or not before.findings.answer["unknown"]["flag"]:
        return False
    base = _with_known(before, (), known)
    values = {k: p["value"] for k, p in entry["parameters"].items()}
    whole = with_entry(before.problem, base, effect, values)
    if not whole.evidence - base.evidence > VISIBLE:
        return False
    params = type(effect).params()
    for name in (f.name for f in whole.free if f.effect == effect.name and not f.relative):
        found, (value, sd) = (
            entry["parameters"][key_of(name, params[name].unit)],
            whole.value(effect.name, name),
        )
        if abs(found["value"] - value) > max(
            SDS * float(np.hypot(found["sd"], sd)), NEAR * abs(value)
        ):
            return False
    return True


def names_of(found: Diagnosis) -> set[str]:
    """Names that an answer stands for."""
    return {e["name"] for e in found.findings.answer["effects"]}


def meant(truth: Sequence[Cause]) -> set[str]:
    """All names that would be right."""
    return {c.name for cause in truth for c in cause.either}


def _says(entry: EffectEntry, cause: Cause) -> bool:
    """Whether an entry is that cause, or is said to be hardly told from it."""
    return bool({c.name for c in cause.either} & {entry["name"], *entry["tied_with"]})


def right_size(entry: EffectEntry, cause: Cause, own: Mapping[str, Size] | None = None) -> bool:
    """Whether the sizes stated are those of the cause, or of it and what the boat has of it itself (`own`) together.

    Those of one unit are the parts of one arrow.
    """
    true = next((c.values for c in cause.either if c.name == entry["name"]), {})
    units = {k: entry["parameters"][k]["unit"] for k in true if k in entry["parameters"]}

    def near(expected: Mapping[str, Size]) -> bool:
        for key, unit in units.items():
            size = np.hypot.reduce([expected[k].value for k in units if units[k] == unit])
            found = entry["parameters"][key]
            sd = np.hypot(found["sd"], expected[key].sd)
            if abs(found["value"] - expected[key].value) > max(SDS * sd, NEAR * size):
                return False
        return True

    alone = {k: Size(x, 0.0) for k, x in true.items()}
    both = {k: s.with_own(own[k]) if own and k in own else s for k, s in alone.items()}
    return near(alone) or near(both)


def in_words(entry: EffectEntry) -> str:
    """Name and sizes of an entry, and what it is tied with."""
    sizes = ", ".join(
        f"{k} {p['value']:.3g} ± {p['sd']:.2g}" for k, p in entry["parameters"].items()
    )
    tied = f" or {' or '.join(entry['tied_with'])}" if entry["tied_with"] else ""
    return f"{entry['name']} {sizes}{tied}"


def sizes_of(truth: Sequence[Cause]) -> str:
    """Causes with their sizes."""
    return "; ".join(
        f"{c.name} {', '.join(f'{k} {x:.3g}' for k, x in c.values.items())}".strip() for c in truth
    )


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


def own_of(
    before: Diagnosis, truth: Sequence[Cause], known: Collection[str]
) -> dict[str, dict[str, Size]]:
    """Sizes of the same causes fitted to the unaltered recordings, by name and parameter with unit.

    A real boat has a little of everything, to which an alteration adds.
    """
    whole, found = _with_known(before, truth, known), dict[str, dict[str, Size]]()
    for cause in truth:
        if (effect := entry_of(before.problem, cause.name)) is None:
            return {}
        whole = with_entry(before.problem, whole, effect, {})
        params = type(effect).params()
        free = [f.name for f in whole.free if f.effect == effect.name and not f.relative]
        sizes = {n: (*whole.value(effect.name, n), params[n].absent) for n in free}
        found[cause.name] = {key_of(n, params[n].unit): Size(*s) for n, s in sizes.items()}
    return found


def in_numbers(sizes: Mapping[str, Size]) -> str:
    """Sizes with their sds."""
    return ", ".join(f"{s.value:.2g} ± {s.sd:.1g}" for s in sizes.values())


def _with_known(found: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> Fit:
    """The recalibrated vessel with what is known to be missing from it besides."""
    base = found.ranking.recalibrated
    for name in sorted(set(known) - meant(truth)):
        if (effect := entry_of(found.problem, name)) is not None:
            base = with_entry(found.problem, base, effect, _fitted(found, effect))
    return base


def entry_of(problem: Problem, name: str) -> Effect | None:
    """The library's entry of that name as it was composed with a vessel."""
    there = {e.name: e for e in problem.program.candidates}
    return there.get(FURTHER + name) or there.get(name)


def with_entry(problem: Problem, base: Fit, effect: Effect, values: Mapping[str, float]) -> Fit:
    """An entry added to a fit, begun at these values, all refitted."""
    params = type(effect).params()
    free = [
        f for f in problem.parameters((effect.name,)) if f.effect == effect.name and not f.relative
    ]
    begin = {
        f.name: values.get(key_of(f.name, params[f.name].unit), f.mean + SOME * f.sd) for f in free
    }
    start = add_effect(problem, base, effect.name, {n: x for n, x in begin.items()})
    return converge(problem, gauss_newton(problem, start, 4, 0.1))


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
        return f"{len(some)} of {len(all_of_them)}" + (
            f" = {len(some) / len(all_of_them):.2f}" if all_of_them else ""
        )

    return [
        ("visible causes named, with their size", of(named, visible), ">= 0.80"),
        ("cases with a wrong name", of(wrong, verdicts), "<= 0.02"),
        ("invisible ones left alone, or named rightly all the same", of(alone, faint), "1.00"),
    ]
