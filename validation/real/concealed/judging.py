"""Judgement of a diagnosis of recordings in which a cause is concealed."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from boatsim.diagnosis.answer.parameters import parameter_key
from boatsim.diagnosis.answer.schema import EffectEntry
from boatsim.diagnosis.candidates import FURTHER, name_without_prefixes
from boatsim.diagnosis.fit import converge, gauss_newton
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.screening import add_effect
from boatsim.physics.base import Effect
from validation.real.common import (
    by_name,
    effects_of,
    names_of,
    parameter_text,
    values_of,
)

VISIBLE = 6.0  # [nats] gained by the true structure, from which a cause is visible
# a size is right within so many sds, or within this share of it
MAX_SDS = 2.0
MAX_SHARE = 0.15
START = 0.1  # of a prior sd: start of a parameter that the truth does not specify


@dataclass(frozen=True)
class Cause:
    """A concealed cause, named as the candidate effect that describes it."""

    name: str
    # by parameter with unit, as in an answer
    values: Mapping[str, float] = field(default_factory=dict)
    alike: tuple["Cause", ...] = ()  # causes that are equivalent for this recording

    @property
    def either(self) -> tuple["Cause", ...]:
        """The cause and those equivalent to it."""
        return (self, *self.alike)


@dataclass(frozen=True)
class Size:
    """A parameter with its sd; `absent` is its value if the cause is absent."""

    value: float
    sd: float
    absent: float = 0.0

    def with_own(self, own: "Size") -> "Size":
        """Return the size together with that of the unaltered boat.

        Factors multiply, all other parameters add.
        """
        if own.absent == 1.0:
            return Size(self.value * own.value, self.value * own.sd, 1.0)
        return Size(self.value + own.value, own.sd)


@dataclass(frozen=True)
class Verdict:
    """Result of one case."""

    outcome: str  # one of the six below
    answer: str
    # [nats] of the true structure; None where nothing was concealed or no candidate describes it
    gain: float | None
    # sizes of the same causes in the unaltered recordings
    own: str = ""


RIGHT = "right"
SIZE = "size off"
WRONG = "wrong name"
MISSED = "missed"
ALONE = "nothing reported"
FAINT = "right, though not visible"


def judge(
    diagnosis: Diagnosis, truth: Sequence[Cause], before: Diagnosis, others: Sequence[Cause] = ()
) -> Verdict:
    """Compare an answer with the concealed causes.

    Effects that are identified in the unaltered recordings too are not counted.

    Args:
        diagnosis: Diagnosis of the altered recordings.
        truth: The concealed causes.
        before: Diagnosis of the unaltered recordings with the same vessel.
        others: Causes that this vessel lacks anyway; they must be identified too.
    """
    every = (*truth, *others)
    known = set(names_of(others)) or identified_names(before)
    answer = diagnosis.findings.answer
    doubt = answer["unknown"]["flag"] and not before.findings.answer["unknown"]["flag"]
    gain = gain_of(diagnosis, truth, known)
    visible = gain is not None and gain > VISIBLE
    own = sizes_before(before, truth, known)
    new, wrong, words = [], [], []
    for effect in answer["effects"]:
        if not others and effect["name"] in known and effect["name"] not in accepted_names(truth):
            continue
        new.append(effect)
        words.append(effect_text(effect))
        if any(map(partial(_matches, effect), every)):
            continue
        if is_of_the_boat(before, effect, known):
            words[-1] += " (also in the unaltered recordings)"
        else:
            wrong.append(effect)
    hits = []
    for cause in every:
        hits.append(next((effect for effect in new if _matches(effect, cause)), None))
    if wrong:
        outcome = WRONG
    elif truth and all(hits):
        outcome = FAINT
        if visible:
            outcome = RIGHT
            for hit, cause in zip(hits, truth, strict=False):
                if hit and not size_is_right(hit, cause, own.get(hit["name"])):
                    outcome = SIZE
    elif visible or doubt:
        outcome = MISSED
    else:
        outcome = ALONE
    if doubt:
        words.append("an unknown cause")
    text = f"{'; '.join(words) or 'nothing new'} ({answer['verdict']})"
    return Verdict(outcome, text, gain, "; ".join(map(size_text, own.values())))


def is_of_the_boat(before: Diagnosis, entry: EffectEntry, known: Collection[str]) -> bool:
    """Whether an effect explains a residual that the unaltered recordings have too.

    This requires that something unknown remains in the unaltered recordings, and that the effect,
    fitted to them, gains and has the same sizes.
    """
    effect = candidate(before.problem, entry["name"])
    if effect is None or not before.findings.answer["unknown"]["flag"]:
        return False
    base = _with_known(before, (), known)
    whole = with_effect(before.problem, base, effect, values_of(entry))
    if not whole.evidence - base.evidence > VISIBLE:
        return False
    for key, (value, sd, _) in _parameters(whole, effect).items():
        found = entry["parameters"][key]
        limit = max(MAX_SDS * float(np.hypot(found["sd"], sd)), MAX_SHARE * abs(value))
        if abs(found["value"] - value) > limit:
            return False
    return True


def identified_names(diagnosis: Diagnosis) -> set[str]:
    """Return the names of the identified effects."""
    return {effect["name"] for effect in effects_of(diagnosis)}


def accepted_names(truth: Sequence[Cause]) -> set[str]:
    """Return all names that are right for some causes."""
    names: set[str] = set()
    for cause in truth:
        names.update(names_of(cause.either))
    return names


def _matches(entry: EffectEntry, cause: Cause) -> bool:
    """Whether an identified effect is that cause, or is reported as tied with it."""
    return bool(accepted_names([cause]) & {entry["name"], *entry["tied_with"]})


def size_is_right(entry: EffectEntry, cause: Cause, own: Mapping[str, Size] | None = None) -> bool:
    """Whether the sizes of an effect are those of a cause, alone or with the boat's own.

    Parameters with one unit are the components of one vector.

    Args:
        entry: An identified effect.
        cause: The concealed cause.
        own: Sizes of the same cause in the unaltered recordings, by parameter with unit.
    """
    alone: dict[str, Size] = {}
    for one in reversed(cause.either):
        if one.name == entry["name"]:
            alone = {key: Size(x, 0.0) for key, x in one.values.items()}
    both = dict(alone)
    for key in alone.keys() & (own or {}).keys():
        both[key] = alone[key].with_own((own or {})[key])
    return _near(entry, alone) or _near(entry, both)


def _near(entry: EffectEntry, expected: Mapping[str, Size]) -> bool:
    """Whether the sizes of an effect are near the expected ones."""
    parameters = {k: p for k, p in entry["parameters"].items() if k in expected}
    squares: dict[str, float] = {}  # of the vectors, by unit
    for key, p in parameters.items():
        squares[p["unit"]] = float(np.hypot(squares.get(p["unit"], 0.0), expected[key].value))
    for key, p in parameters.items():
        sd = np.hypot(p["sd"], expected[key].sd)
        limit = max(MAX_SDS * sd, MAX_SHARE * squares[p["unit"]])
        if abs(p["value"] - expected[key].value) > limit:
            return False
    return True


def effect_text(entry: EffectEntry) -> str:
    """Return the name and the sizes of an effect, and the effects tied with it."""
    return " or ".join([f"{entry['name']} {parameter_text(entry, '±')}", *entry["tied_with"]])


def sizes_of(truth: Sequence[Cause]) -> str:
    """Return causes with their sizes as text."""
    texts = []
    for cause in truth:
        sizes = ", ".join(f"{key} {x:.3g}" for key, x in cause.values.items())
        texts.append(f"{cause.name} {sizes}".strip())
    return "; ".join(texts)


def gain_of(diagnosis: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> float | None:
    """Return the evidence gained by the true structure with fitted sizes [nats].

    None where nothing is concealed or a candidate is not available.

    Args:
        diagnosis: Diagnosis of the altered recordings.
        truth: The concealed causes.
        known: Effects that are known to be missing and are part of both models.
    """
    base = whole = _with_known(diagnosis, truth, known)
    for cause in truth:
        effect = candidate(diagnosis.problem, cause.name)
        if effect is None:
            return None
        whole = with_effect(diagnosis.problem, whole, effect, cause.values)
    return whole.evidence - base.evidence if truth else None


def sizes_before(
    before: Diagnosis, truth: Sequence[Cause], known: Collection[str]
) -> dict[str, dict[str, Size]]:
    """Return sizes of causes fitted to the unaltered recordings, by name and parameter with unit.

    A real boat has a little of everything, to which an alteration adds.
    """
    whole = _with_known(before, truth, known)
    found = {}
    for cause in truth:
        effect = candidate(before.problem, cause.name)
        if effect is None:
            return {}
        whole = with_effect(before.problem, whole, effect, {})
        found[cause.name] = {key: Size(*x) for key, x in _parameters(whole, effect).items()}
    return found


def _parameters(fit: Fit, effect: Effect) -> dict[str, tuple[float, float, float]]:
    """Return fitted value, sd and absent value of an effect's parameters, by name with unit."""
    params = type(effect).params()
    found = {}
    for f in fit.free:
        if f.effect == effect.name and not f.relative:
            key = parameter_key(f.name, params[f.name].unit)
            found[key] = (*fit.value(effect.name, f.name), params[f.name].inactive_value)
    return found


def size_text(sizes: Mapping[str, Size]) -> str:
    """Return sizes with their sds as text."""
    return ", ".join(f"{s.value:.2g} ± {s.sd:.1g}" for s in sizes.values())


def _with_known(diagnosis: Diagnosis, truth: Sequence[Cause], known: Collection[str]) -> Fit:
    """Return the refitted vessel with the effects that are known to be missing.

    The vessel of the answer may have coefficients of the file, with which a comparison of evidence
    would be one of the coefficients, too.
    """
    problem = diagnosis.problem
    base = converge(problem, gauss_newton(problem, diagnosis.ranking.recalibrated, 4, 0.1))
    for name in sorted(set(known) - accepted_names(truth)):
        effect = candidate(diagnosis.problem, name)
        if effect is not None:
            base = with_effect(diagnosis.problem, base, effect, _fitted(diagnosis, effect))
    return base


def candidate(problem: Problem, name: str) -> Effect | None:
    """Return the candidate effect of that name in a compiled program, if it has one."""
    candidates = by_name(problem.program.candidates)
    return candidates.get(FURTHER + name) or candidates.get(name)


def with_effect(problem: Problem, base: Fit, effect: Effect, values: Mapping[str, float]) -> Fit:
    """Return a fit with one more effect that starts at these values, all refitted."""
    params = type(effect).params()
    start = {}
    for f in problem.free_parameters((effect.name,)):
        if f.effect == effect.name and not f.relative:
            usual = f.mean + START * f.sd
            start[f.name] = values.get(parameter_key(f.name, params[f.name].unit), usual)
    added = add_effect(problem, base, effect.name, start)
    return converge(problem, gauss_newton(problem, added, 4, 0.1))


def _fitted(diagnosis: Diagnosis, effect: Effect) -> dict[str, float]:
    """Return the values of an effect in an answer."""
    values: dict[str, float] = {}
    for entry in effects_of(diagnosis):
        if entry["name"] == name_without_prefixes(effect.name):
            values |= values_of(entry)
    return values


def goal_rows(verdicts: Sequence[Verdict]) -> list[list[str]]:
    """Return rows of what the goals require: name, count, goal."""
    visible, invisible = [], []
    for v in verdicts:
        if v.gain is not None and v.gain > VISIBLE:
            visible.append(v.outcome)
        else:
            invisible.append(v.outcome)
    everything = [*visible, *invisible]
    alone = invisible.count(ALONE) + invisible.count(FAINT)
    named, wrong = visible.count(RIGHT), everything.count(WRONG)
    return [
        ["visible causes identified, with their size", _share(named, visible), ">= 0.80"],
        ["cases with a wrong name", _share(wrong, everything), "<= 0.02"],
        [
            "invisible causes not reported, or identified correctly",
            _share(alone, invisible),
            "1.00",
        ],
    ]


def _share(count: int, cases: Sequence[str]) -> str:
    text = f"{count} of {len(cases)}"
    if cases:
        text += f" = {count / len(cases):.2f}"
    return text
