"""The answer file of a diagnosis: verdict, effects with their parameters, where, limits, fit."""

from collections.abc import Iterable, Sequence

import numpy as np

from boatsim.control.base import wrap
from boatsim.diagnosis.candidates import called
from boatsim.diagnosis.config import as_plain
from boatsim.diagnosis.free_runs import FreeRun, errors
from boatsim.diagnosis.locate import missing_force as locate
from boatsim.diagnosis.locate.regions import regions
from boatsim.diagnosis.locate.residual_structure import Structure
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report.described_terms import described_entries
from boatsim.diagnosis.report.schema import (
    Acting,
    Answer,
    CandidateEntry,
    EffectEntry,
    FitEntry,
    NextEntry,
    ParameterEntry,
    StructureEntry,
)
from boatsim.diagnosis.report.sentences import sentence
from boatsim.diagnosis.search.pruning import Named
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.physics.base import Channel, Effect
from boatsim.physics.vessel import Vessel
from boatsim.version import version

ONE_SIDED_95 = 1.645  # [sd]
# nature's law is never quite the entry's: an sd holds this share of what was found [rad for
# directions]
SHAPE = 0.05
AT_BOUND = 1e-3  # of a bound: a value this near to it is at it
TOLD = 0.5  # a fitted sd above this share of the prior one means that the data say nothing


def compose(
    problem: Problem,
    ranking: Ranking,
    forces: Sequence[locate.MissingForce],
    left: Sequence[locate.MissingForce],
    stretches: Sequence[FreeRun],
    held_out: Sequence[str],
    horizon: float,
    wanted: NextEntry,
) -> Answer:
    """diagnosis.json as a dictionary, without the seconds; `wanted` is what it says of the next experiment."""
    effects = [_effect(problem, ranking.best, n) for n in ranking.named]
    verdict = (
        "ambiguous"
        if any(e["tied_with"] for e in effects)
        else "named"
        if effects
        else "nothing_missing"
    )
    laws = described_entries(ranking.description, problem.program.vessel)
    verdict = ("described" if laws else "unknown") if ranking.unknown else verdict
    answer: Answer = {
        "verdict": verdict,
        "sentence": "",
        "seconds": 0.0,
        "version": version(),
        "effects": effects,
        "unknown": {
            "flag": ranking.unknown,
            "gain_nats": round(ranking.left_over, 3),
            "told_from_nats": round(ranking.told_from, 3),
        },
        "described": laws,
        "candidates": _candidates(ranking),
        "upper_limits": {
            called(name): _limits(problem, fitted, name) for name, fitted in ranking.last.items()
        },
        "where": {
            "axes": locate.strength(problem, forces),
            "intervals": [
                {"run": i.run, "from_s": i.from_s, "to_s": i.to_s, "axis": i.axis}
                for i in locate.intervals(problem, forces)
            ],
            "region": [
                {"variable": r.variable, "statement": r.statement, "p_value": r.p_value}
                for r in regions(problem, ranking.recalibrated)
            ],
        },
        "fit": _fit(stretches, held_out, horizon),
        "next_experiment": wanted,
        "patch": "patched.toml",
        "config": as_plain(problem.config),
    }
    if ranking.unknown:
        answer["unknown"]["rest"] = locate.strength(problem, left)
    if ranking.structure.significant:
        answer["unknown"]["structure"] = _structure(ranking.structure)
    answer["sentence"] = sentence(
        answer, meanings(problem.program.candidates, problem.program.vessel)
    )
    return answer


def _structure(found: Structure) -> StructureEntry:
    return {
        "axis": found.axis,
        "goes_with": found.goes_with,
        "gain_nats": round(found.gain, 3),
        "p_value": float(f"{found.p_value:.2g}"),
        "tried": found.tested,
    }


def meanings(candidates: Iterable[Effect], vessel: Vessel) -> dict[str, str]:
    """What each entry says, by name, and each of its parameters and ratios, by "entry.parameter" as in the answer."""
    there = [(called(e.name), type(e)) for e in candidates]
    fitted = (
        (entry, name, p) for entry, kind in there for name, p in kind.params().items() if p.fit
    )
    ratios = (
        (called(e.name), key, words)
        for e in candidates
        for key, (_, words) in e.ratios(vessel).items()
    )
    of_parameters = {f"{n}.{key_of(name, p.unit)}": p.words for n, name, p in fitted}
    return (
        {n: k.words for n, k in there}
        | of_parameters
        | {f"{n}.{key}": words for n, key, words in ratios}
    )


def key_of(name: str, unit: str) -> str:
    """Parameter name with its unit: force in N -> force_N, north in m/s -> north_mps, a ratio stays as it is."""
    suffix = unit.replace("1/", "per").replace("/", "p").replace("^", "").replace(" ", "")
    return f"{name}_{suffix}" if suffix else name


def _fit(stretches: Sequence[FreeRun], held_out: Sequence[str], horizon: float) -> FitEntry:
    """Errors of the free runs; that in roll only where it was recorded."""
    found = errors(stretches)
    fit: FitEntry = {
        "horizon_s": horizon,
        "held_out": list(held_out),
        "position_rms_m": found.get("position_rms_m", {}),
        "heading_rms_rad": found.get("heading_rms_rad", {}),
    }
    if "roll_rms_rad" in found:
        fit["roll_rms_rad"] = found["roll_rms_rad"]
    return fit


def _effect(problem: Problem, best: Fit, named: Named) -> EffectEntry:
    effect = next(e for e in problem.program.candidates if e.name == named.name)
    kind = type(effect)
    acting: Acting = {"on": list(effect.on)} if effect.on else {}
    return {
        "name": called(named.name),
        **acting,
        "kind": kind.kind,
        "probability": round(named.probability, 4),
        "gain_nats": round(named.gain, 2),
        "words": _words(best, effect),
        "tied_with": [called(n) for n in named.tied_with],
        "parameters": {
            key_of(f.name, kind.params()[f.name].unit): _parameter(best, effect, f.name)
            for f in best.free
            if f.effect == named.name and not f.relative
        }
        | _ratios(problem.program.vessel, best, effect),
    }


def _ratios(vessel: Vessel, best: Fit, effect: Effect) -> dict[str, ParameterEntry]:
    """What its parameters come to where recordings tell no more than a ratio."""
    own = {f.name: f for f in best.free if f.effect == effect.name and not f.relative}
    fitted = {n: best.value(effect.name, n)[0] for n in own}

    def ratios(name: str, step: float) -> dict[str, tuple[float, str]]:
        moved = np.clip(fitted[name] + step, own[name].low, own[name].high)
        return effect.having(fitted | {name: float(moved)}).ratios(vessel)

    found = effect.having(fitted).ratios(vessel)
    variance = dict.fromkeys(found, 0.0)
    for name in fitted if found else ():
        sd = _parameter(best, effect, name)["sd"]
        low, high = ratios(name, -0.5 * sd), ratios(name, 0.5 * sd)
        variance = {key: v + (high[key][0] - low[key][0]) ** 2 for key, v in variance.items()}
    return {
        key: {"value": x, "sd": float(np.sqrt(variance[key])), "unit": ""}
        for key, (x, _) in found.items()
    }


def _words(best: Fit, effect: Effect) -> str:
    """What an effect says; the other way round where what it takes away was added."""
    kind = type(effect)
    strength = next((f for f in best.free if f.effect == effect.name and not f.relative), None)
    above = (
        strength is not None
        and kind.words_above
        and best.value(effect.name, strength.name)[0] > 1.0
    )
    words = kind.words_above if above else kind.words
    if isinstance(effect, Channel) and effect.other_side:
        words += (
            ", in the actuator and not in its command"
            if kind.stage < 0
            else ", already in the command"
        )
    return words


def told_sd(best: Fit, effect: Effect, name: str) -> float:
    """Standard deviation of a fitted parameter, with what a law that is only nearly right may shift it by."""
    kind, (value, sd) = type(effect), best.value(effect.name, name)
    about = kind.params()[name]
    if name in (kind.strength or kind.params()):
        strength = min(
            abs(value - about.absent), abs(value) or np.inf
        )  # some laws are absent at "very fast"
        return float(np.hypot(sd, SHAPE * strength))
    return float(np.hypot(sd, SHAPE)) if about.unit == "rad" else sd


def _parameter(best: Fit, effect: Effect, name: str) -> ParameterEntry:
    """Value, sd and unit of a fitted parameter; angles within half a turn."""
    kind = type(effect)
    about = kind.params()[name]
    value, _ = best.value(effect.name, name)
    sd = told_sd(best, effect, name)
    shown = wrap(value) if about.unit == "rad" else value
    entry: ParameterEntry = {"value": shown, "sd": sd, "unit": about.unit}
    bounds = next((f.low, f.high) for f in best.free if f.effect == effect.name and f.name == name)
    ends = [end for end in bounds if end != about.absent]
    if any(abs(value - end) <= AT_BOUND * abs(end) for end in ends):
        entry["at_bound"] = True
    return entry


def _candidates(ranking: Ranking) -> list[CandidateEntry]:
    """Every entry tried alone, best first, with its probability against the others and against nothing."""
    names = sorted(ranking.first, key=lambda n: -ranking.first[n])
    gains = np.array([0.0, *(ranking.first[n] for n in names)])
    weights = np.exp(gains - gains.max())
    weights /= weights.sum()
    found: dict[str, CandidateEntry] = {}  # of an idea that was tried in two places the better one
    for n, g, w in zip(names, gains[1:], weights[1:], strict=True):
        entry: CandidateEntry = {
            "name": called(n),
            "gain_nats": round(float(g), 2),
            "probability": round(float(w), 4),
        }
        found.setdefault(called(n), entry)
    return list(found.values())


def _limits(problem: Problem, fitted: Fit, name: str) -> dict[str, float]:
    """How far each parameter can be from not acting at all, at 95 %."""
    kind = _kind(problem, name)
    params = kind.params()
    out = {}
    for f in fitted.free:
        if f.effect != name or f.relative or f.name not in (kind.strength or params):
            continue
        value, sd = fitted.value(name, f.name)
        if sd < TOLD * f.sd:  # otherwise the limit would only be the prior's
            strength = abs(value - params[f.name].absent) + ONE_SIDED_95 * sd
            out[key_of(f.name, params[f.name].unit)] = float(f"{strength:.3g}")
    return out


def _kind(problem: Problem, name: str) -> type[Effect]:
    return next(type(e) for e in problem.program.candidates if e.name == name)
