"""Fit of the coefficients of a new boat to its logs, with validation on held-out parts.

The first two thirds of each log are fitted, the last third is held out. A few candidate effects are
tested in addition to the coefficients, and kept if the evidence increases enough. Effects of the
boat (added mass, thrust lag, weak reverse, ...) are written into its file. A current belongs to the
day and is only reported.
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
from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.checks.data_cleaning import clean_recording, total_duration
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.fit import converge, unfitted_hypothesis
from boatsim.diagnosis.free_runs import free_runs, rms_errors
from boatsim.diagnosis.loading import open_recording_parts
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.errors import BadInput
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, ignore_progress, report_part_of
from boatsim.recordings.table import Recording

# Candidate effects that belong to the boat
OF_BOAT = (
    "added_mass_error",
    "lateral_centre_shift",
    "quadratic_damping",
    "thrust_lag",
    "weak_reverse",
    "thrust_deadband",
)
OF_DAY = ("current",)  # candidate effects of the water during the log
MIN_GAIN = 3.0  # [nats] evidence that an effect must add
FITTED_PART = 2 / 3  # of each log
# Smallest relative standard deviation of a fitted coefficient, for no two days are the same
MIN_SD = 0.05
LONG_NUMBER = re.compile(
    r"(?<== )-?\d+\.\d{5,}(?:e[+-]?\d+)?$|(?<== )-?\d+\.\d{5,}(?:e[+-]?\d+)?(?= #)", re.MULTILINE
)


@dataclass(frozen=True)
class FittedBoat:
    """Vessel whose coefficients were fitted to logs, with its errors on held-out data.

    Attributes:
        boat: The boat before the fit.
        problem: Estimation problem of the fitted parts.
        best: The fit.
        judge: Estimation problem of the held-out parts.
        before: Family of signals -> rms of free runs on the held-out parts before the fit.
        after: The same after the fit.
    """

    boat: Vessel
    problem: Problem
    best: Fit
    judge: Problem
    before: Mapping[str, float]
    after: Mapping[str, float]

    @property
    def reduces_error(self) -> bool:
        """Whether the fit of the coefficients reduces the errors on held-out data.

        A log with a fault gives wrong numbers.
        """
        return all(self.after[family] <= before for family, before in self.before.items())


def fit_boat(
    vessel_file: Path,
    logs: Sequence[Path],
    held_out: Sequence[Path] = (),
    report: Report = ignore_progress,
) -> FittedBoat:
    """Fit the coefficients of a vessel to logs and validate the fit on held-out data.

    Args:
        vessel_file: The vessel.toml.
        logs: Recordings; the last third of each is held out unless `held_out` is given.
        held_out: Held-out recordings; effects of the day do not apply to them.
        report: Called with the progress.

    Raises:
        BadInput: If a recording cannot be used.
    """
    report(f"reading {len(logs) + len(held_out)} logs")
    opened: list[Recording] = []
    fitted = 0  # number of parts of the logs
    for path in (*logs, *held_out):
        parts, boat = open_recording_parts(path, str(vessel_file), ())
        opened += parts
        if path in logs:
            fitted = len(opened)
    duration = total_duration(opened)
    cleaned = [clean_recording(part, boat, duration) for part in opened]
    if held_out:
        first, last = cleaned[:fitted], cleaned[fitted:]
    else:
        first, last = map(list, zip(*map(_split_recording, cleaned), strict=True))
    report("compiling, or loading what was compiled before", 0.05)
    problem, judge = _make_problems(boat, first, last)
    try:
        with threadpool_limits(1, "blas"):
            report("fitting the coefficients", 0.1)
            nominal, best = fit_baseline(problem)
            best = _add_candidates(problem, best, report_part_of(report, 0.3, 0.9))
            report("validating on held-out data", 0.9)
            before, after = _held_out_errors(
                judge, nominal, _remove_effects(best, OF_DAY) if held_out else best
            )
    except (np.linalg.LinAlgError, FloatingPointError) as error:
        raise BadInput(
            f"{logs[0]}: {boat.name} cannot follow this recording ({error}); are its units right?"
        ) from None
    return FittedBoat(boat, problem, best, judge, before, after)


def fit_report_lines(found: FittedBoat) -> list[str]:
    """Return lines of text that report a vessel's fitted effects and the errors on held-out data.

    Args:
        found: The fit.
    """
    return [*_fit_lines(found.best), *_error_lines(found)]


def fitted_vessel_text(found: FittedBoat, logs: Sequence[Path]) -> str:
    """Return the text of a vessel.toml with the fitted coefficients in place of the previous ones.

    Args:
        found: The fit.
        logs: Files of the recordings, for comments.
    """
    own = _remove_effects(found.best, OF_DAY)
    return _fitted_vessel_file(
        found.problem, found.boat, own, ", ".join(path.name for path in logs)
    )


def _split_recording(whole: Recording) -> tuple[Recording, Recording]:
    """The first two thirds and the last third of a recording."""
    at = float(whole.t[0] + FITTED_PART * (whole.t[-1] - whole.t[0]))
    step = float(np.median(np.diff(whole.t)))
    return whole.between(float(whole.t[0]), at), whole.between(at + 0.5 * step, float(whole.t[-1]))


def _make_problems(
    boat: Vessel, first: Sequence[Recording], last: Sequence[Recording]
) -> tuple[Problem, Problem]:
    """The estimation problems of the fitted and the held-out parts."""
    program = program_with_candidates(boat, (*OF_BOAT, *OF_DAY))
    levels = prior_noise_levels(boat, first)
    mapped = [infer_initial_actuator_state(map_recording(r, program), levels) for r in first]
    problem = Problem(mapped, levels, priors.coefficient_uncertainty(boat))
    return problem, problem.with_recordings([map_recording(r, program) for r in last])


def _add_candidates(problem: Problem, best: Fit, report: Report) -> Fit:
    """Add the candidate effects that increase the evidence enough, the best first."""
    candidates = [n for n in (*OF_BOAT, *OF_DAY) if n in problem.program.candidate_names]
    while candidates:
        fits: dict[str, Fit] = {}
        for i, candidate in enumerate(candidates):
            share = (len(best.effects) + i / len(candidates)) / (len(best.effects) + 2)
            report("testing candidate effects", share, candidate.replace("_", " "))
            fits[candidate] = converge(problem, _initial_fit(problem, best, candidate))
        name = max(fits, key=lambda n: fits[n].evidence)
        if not fits[name].evidence > best.evidence + MIN_GAIN:
            break
        best = fits[name]
        candidates = [n for n in candidates if n != name and fits[n].evidence > -np.inf]
    return best


def _initial_fit(problem: Problem, best: Fit, name: str) -> Fit:
    """The initial values of a fit with one more effect."""
    effects = (*best.effects, name)
    free = problem.free_parameters(effects)
    return unfitted_hypothesis(
        effects, free, free_parameter_values(free, best.values()), best.levels
    )


def _remove_effects(best: Fit, names: Sequence[str]) -> Fit:
    """The fit without some effects."""
    keep = []
    free = []
    for index, parameter in enumerate(best.free):
        if parameter.effect not in names:
            keep.append(index)
            free.append(parameter)
    effects = tuple(n for n in best.effects if n not in names)
    return replace(
        best,
        effects=effects,
        free=tuple(free),
        theta=best.theta[keep],
        covariance=best.covariance[np.ix_(keep, keep)],
    )


def _held_out_errors(
    judge: Problem, nominal: Fit, best: Fit
) -> tuple[dict[str, float], dict[str, float]]:
    """Errors of free runs on held-out data before and after the fit.

    Raises BadInput if the data are too short.
    """
    found = rms_errors(
        free_runs(judge, {"before": nominal, "after": best}, judge.recordings, judge.horizon)
    )
    if not found:
        raise BadInput(f"the held-out part is shorter than a free run of {judge.horizon:g} s")
    before: dict[str, float] = {}
    after: dict[str, float] = {}
    for family, rms in found.items():
        before[family] = rms["before"]
        after[family] = rms["after"]
    return before, after


def _fitted_vessel_file(problem: Problem, boat: Vessel, own: Fit, logs: str) -> str:
    """The text of the vessel file with the fitted numbers and their uncertainty."""
    document = tomlkit.parse(
        LONG_NUMBER.sub(
            _shorten_number, patched_vessel.patched_vessel_text(problem, boat, own, boat.file)
        )
    )
    for key in ("based_on", "found"):  # the file is no patch of another vessel
        del document[key]
    by_rule = boat.diagnosis.coefficient_uncertainty
    sd = dict.fromkeys(map(str, by_rule), MIN_SD)
    for f, x, variance in zip(own.free, own.theta, np.diag(own.covariance), strict=True):
        names = []
        if f.relative:
            names = boat.names_of(f.effect)
        for number, effect in enumerate(boat.effects):
            if effect.name not in names:
                continue
            table = document["effect"][number]
            # Relative to the number of the rule if the fitted one is smaller
            spread = float(np.sqrt(variance)) / max(float(x), 1.0)
            kind = type(effect).params()[f.name].calibrates
            sd[kind] = max(sd[kind], float(f"{spread:.2g}"))
            table[f.name].comment(
                f"{_original_comment(table, f.name)}, x {x:.3g} +- {100 * spread:.2g} % by {logs}"
            )
    diagnosis = document["diagnosis"]
    diagnosis["coefficient_uncertainty"] = tomlkit.inline_table()
    diagnosis["coefficient_uncertainty"].update(
        {str(k): min(sd[str(k)], float(most)) for k, most in by_rule.items()}
    )
    diagnosis["coefficient_uncertainty"].comment(
        f"relative sd: the largest of those fitted, at least {MIN_SD:g}"
    )
    diagnosis["reasons"]["coefficient_uncertainty"] = f"fitted to {logs}"
    for group in boat.estimated:
        if group in sd:
            document["estimated"][group] = min(sd[group], float(boat.estimated[group]))
            document["estimated"][group].comment(f"fitted to {logs}")
    return str(tomlkit.dumps(document)).replace("# found by the diagnosis", f"# fitted to {logs}")


def _shorten_number(found: re.Match[str]) -> str:
    """A fitted number with five digits."""
    return str(float(f"{float(found[0]):.5g}"))


def _original_comment(table: Mapping[str, Any], key: str) -> str:
    """The comment of a key without the part that a patched file adds."""
    if key not in table:
        return "no value before"
    comment: str = table[key].trivia.comment
    before = comment.removeprefix("# ").partition("recalibrated")[0].removesuffix("; ")
    return before or "1 by definition"


def _fit_lines(best: Fit) -> list[str]:
    """Lines that report the number of coefficients and the identified effects."""
    lines = []
    for name in best.effects:
        cells = []
        for f, x, v in zip(best.free, best.theta, np.diag(best.covariance), strict=True):
            if f.effect == name:
                cells.append(f"{f.name} = {x:.3g} +- {np.sqrt(v):.2g}")
        where = "written into the vessel"
        if name in OF_DAY:
            where = "of the water on that day, not written"
        lines.append(f"  {name}: {', '.join(cells)} ({where})")
    return [f"fitted {sum(f.relative for f in best.free)} coefficients", *lines]


def _error_lines(found: FittedBoat) -> list[str]:
    """Lines that report the errors on held-out data before and after the fit."""
    horizon = f"{found.judge.horizon:g} s"
    lines = [f"free runs of {horizon} on the last third of each log, which were held out:"]
    for key in found.before:
        scale = 57.29578
        unit = "deg"
        if key.endswith("_m"):
            scale = 1.0
            unit = "m"
        before, after = found.before[key] * scale, found.after[key] * scale
        lines.append(
            f"  {key.partition('_')[0]} rms [{unit}]: from particulars {before:.4g}, fitted "
            f"{after:.4g}"
        )
    return lines
