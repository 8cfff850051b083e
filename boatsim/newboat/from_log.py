"""Fits the coefficients of a boat from particulars to logs of it, and says what that is worth on parts unseen.

Each log gives its first two thirds to the fit and its last to the judgement. Beside the coefficients a few things are
tried, each kept if the evidence gains enough: added mass, lag of the thrust, weak reverse and the like, which belong to
the boat and are written into its file, and a current, which belongs to the day and is only told.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from threadpoolctl import threadpool_limits

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import composed
from boatsim.diagnosis.checks.data_cleaning import clean_recording, total_duration
from boatsim.diagnosis.checks.initial_actuator_state import with_initial_actuators
from boatsim.diagnosis.filter import map_recording, prior_levels
from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.pipeline import open_recording
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.report import patched_vessel
from boatsim.diagnosis.search.ranking import baseline
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, part, silent
from boatsim.recordings.table import Recording

# its own, tried beside the coefficients
OF_BOAT = (
    "added_mass_error",
    "lateral_centre_shift",
    "quadratic_damping",
    "thrust_lag",
    "weak_reverse",
    "thrust_deadband",
)
OF_DAY = ("current",)  # what the water did while the log was taken
GAIN = 3.0  # [nats] that makes one worth its parameters
FITTED_PART = 2 / 3  # of each log
# relative sd that is left to a fitted coefficient: another day is never quite the same
LEAST = 0.05
LONG = re.compile(
    r"(?<== )-?\d+\.\d{5,}(?:e[+-]?\d+)?$|(?<== )-?\d+\.\d{5,}(?:e[+-]?\d+)?(?= #)", re.MULTILINE
)


@dataclass(frozen=True)
class Fitted:
    """A boat fitted to logs, and how it was judged."""

    boat: Vessel
    problem: Problem
    best: Fit
    judge: Problem  # the same question to what was not fitted
    before: Mapping[
        str, float
    ]  # family of signals -> rms of free runs on the unseen parts, as the file had it
    after: Mapping[str, float]

    @property
    def better(self) -> bool:
        """Whether the fit does better on what it has not seen: a log with a fault of its own teaches wrong numbers."""
        return all(self.after[family] <= before for family, before in self.before.items())


def fitted(
    vessel_file: Path, logs: Sequence[Path], held_out: Sequence[Path] = (), report: Report = silent
) -> Fitted:
    """The vessel of a file with its coefficients fitted to logs.

    Judged on the last third of each, or on the logs `unseen`, and then the others are fitted whole and what belongs to
    their day is left out. Raises BadInput.
    """
    report(f"reading {len(logs) + len(held_out)} logs")
    opened = [open_recording(path, str(vessel_file), ()) for path in (*logs, *held_out)]
    boat = opened[0][1]
    duration = total_duration([r for r, _ in opened])
    whole = [clean_recording(r, boat, duration) for r, _ in opened]
    parts = [_parted(r) for r in whole[: len(logs)]]
    first = whole[: len(logs)] if held_out else [a for a, _ in parts]
    last = whole[len(logs) :] if held_out else [b for _, b in parts]
    report("compiling, or loading what was compiled before", 0.05)
    problem, judge = _problems(boat, first, last)
    try:
        with threadpool_limits(1, "blas"):
            report("fitting the coefficients", 0.1)
            nominal, best = baseline(problem)
            best = _with_more(problem, best, part(report, 0.3, 0.9))
            report("judging on what was not fitted", 0.9)
            before, after = _errors(judge, nominal, _without(best, OF_DAY) if held_out else best)
    except (np.linalg.LinAlgError, FloatingPointError) as error:
        raise BadInput(
            f"{logs[0]}: {boat.name} can not follow this recording ({error}); are its units right?"
        ) from None
    return Fitted(boat, problem, best, judge, before, after)


def in_words(found: Fitted, on: str = "the last third of each log") -> list[str]:
    """What was fitted, and what that is worth."""
    return [*_told(found.best), *_judged(found, on)]


def text(found: Fitted, logs: Sequence[Path]) -> str:
    """The vessel file with the numbers that are the boat's own."""
    own = _without(found.best, OF_DAY)
    return _written(found.problem, found.boat, own, ", ".join(path.name for path in logs))


def _parted(whole: Recording) -> tuple[Recording, Recording]:
    """The first two thirds of a recording and its last."""
    at = float(whole.t[0] + FITTED_PART * (whole.t[-1] - whole.t[0]))
    step = float(np.median(np.diff(whole.t)))
    return whole.between(float(whole.t[0]), at), whole.between(at + 0.5 * step, float(whole.t[-1]))


def _problems(
    boat: Vessel, first: Sequence[Recording], last: Sequence[Recording]
) -> tuple[Problem, Problem]:
    """The question to the parts that are fitted, and the same to those that judge."""
    program, _ = composed(boat)
    levels = prior_levels(boat, first)
    laid = [with_initial_actuators(map_recording(r, program), levels) for r in first]
    problem = Problem(laid, levels, priors.uncertainty(boat))
    return problem, problem.on([map_recording(r, program) for r in last])


def _with_more(problem: Problem, best: Fit, report: Report) -> Fit:
    """With those of the candidates that gain, the one that gains most first."""
    there = [n for n in (*OF_BOAT, *OF_DAY) if n in problem.program.entries]
    while there:
        tried = {}
        for i, n in enumerate(there):
            share = (len(best.effects) + i / len(there)) / (len(best.effects) + 2)
            report("trying what a boat may have besides", share, n.replace("_", " "))
            tried[n] = converge(problem, _start(problem, best, n))
        name = max(tried, key=lambda n: tried[n].evidence)
        if not tried[name].evidence > best.evidence + GAIN:
            break
        best = tried[name]
        there = [n for n in there if n != name and tried[n].evidence > -np.inf]
    return best


def _start(problem: Problem, best: Fit, name: str) -> Fit:
    """The start of a fit with one more."""
    effects = (*best.effects, name)
    free = problem.parameters(effects)
    known = {(f.effect, f.name): x for f, x in zip(best.free, best.theta, strict=True)}
    theta = np.array([known.get((f.effect, f.name), f.mean) for f in free])
    return Fit(effects, free, theta, np.diag([f.sd**2 for f in free]), best.levels, -np.inf)


def _without(best: Fit, names: Sequence[str]) -> Fit:
    """The fit less what is not the boat's."""
    keep = [j for j, f in enumerate(best.free) if f.effect not in names]
    effects = tuple(n for n in best.effects if n not in names)
    return replace(
        best,
        effects=effects,
        free=tuple(best.free[j] for j in keep),
        theta=best.theta[keep],
        covariance=best.covariance[np.ix_(keep, keep)],
    )


def _errors(judge: Problem, nominal: Fit, best: Fit) -> tuple[dict[str, float], dict[str, float]]:
    """Free runs on what was not fitted, before and after."""
    found = errors(
        free_runs(judge, {"before": nominal, "after": best}, judge.recordings, judge.horizon)
    )
    if not found:
        raise BadInput(
            f"the part kept to judge by is shorter than a free run of {judge.horizon:g} s"
        )
    return {k: v["before"] for k, v in found.items()}, {k: v["after"] for k, v in found.items()}


def _written(problem: Problem, boat: Vessel, own: Fit, logs: str) -> str:
    """The vessel file with the fitted numbers and how well they are known."""
    document = tomlkit.parse(
        LONG.sub(_shortened, patched_vessel.patched(problem, boat, own, boat.file))
    )
    for key in ("based_on", "found"):  # it is a vessel of its own
        del document[key]
    by_rule = boat.diagnosis.coefficient_uncertainty
    sd = {str(kind): LEAST for kind in by_rule}
    for f, x, variance in zip(own.free, own.theta, np.diag(own.covariance), strict=True):
        for effect in (e for e in boat.effects if f.relative and e.name in boat.names_of(f.effect)):
            table = document["effect"][boat.effects.index(effect)]
            # against the rule's number where less is left: what is next to nothing is not unsure
            spread, kind = (
                float(np.sqrt(variance)) / max(float(x), 1.0),
                type(effect).params()[f.name].calibrates,
            )
            sd[kind] = max(sd[kind], float(f"{spread:.2g}"))
            table[f.name].comment(
                f"{_before(table, f.name)}, x {x:.3g} +- {100 * spread:.2g} % by {logs}"
            )
    told = document["diagnosis"]
    told["coefficient_uncertainty"] = tomlkit.inline_table()
    told["coefficient_uncertainty"].update(
        {str(k): min(sd[str(k)], float(most)) for k, most in by_rule.items()}
    )
    told["coefficient_uncertainty"].comment(
        f"relative sd: the largest of those fitted, at least {LEAST:g}"
    )
    told["reasons"]["coefficient_uncertainty"] = f"fitted to {logs}"
    return str(tomlkit.dumps(document)).replace("# found by the diagnosis", f"# fitted to {logs}")


def _shortened(found: re.Match[str]) -> str:
    """A fitted number to as many digits as its spread bears."""
    return str(float(f"{float(found[0]):.5g}"))


def _before(table: Mapping[str, Any], key: str) -> str:
    """The comment of a key without what a patched file adds."""
    if key not in table:
        return "nobody stated it"
    comment: str = table[key].trivia.comment
    before = comment.removeprefix("# ").partition("recalibrated")[0].removesuffix("; ")
    return before or "1 by definition"


def _told(best: Fit) -> list[str]:
    """What was found beside the coefficients."""
    lines = []
    for name in best.effects:
        cells = [
            f"{f.name} = {x:.3g} +- {np.sqrt(v):.2g}"
            for f, x, v in zip(best.free, best.theta, np.diag(best.covariance), strict=True)
            if f.effect == name
        ]
        where = (
            "the water of that day, not written" if name in OF_DAY else "written into the vessel"
        )
        lines.append(f"  {name}: {', '.join(cells)} ({where})")
    return [f"fitted {sum(f.relative for f in best.free)} coefficients", *lines]


def _judged(found: Fitted, on: str) -> list[str]:
    """Before and after, on what was not fitted."""
    lines = [f"free runs of {found.judge.horizon:g} s on {on}, which no fit has seen:"]
    for key in found.before:
        scale, unit = (1.0, "m") if key.endswith("_m") else (57.29578, "deg")
        before, after = found.before[key] * scale, found.after[key] * scale
        lines.append(
            f"  {key.partition('_')[0]} rms [{unit}]: from particulars {before:.4g}, fitted {after:.4g}"
        )
    return lines
