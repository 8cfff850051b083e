"""A whole diagnosis: recordings and a vessel in, findings out."""

import os
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import (
    Library,
    less,
    library_for,
    with_stated_errors,
    without_ruled_out,
)
from boatsim.diagnosis.checks import data_cleaning, run_checks
from boatsim.diagnosis.checks.entry import column_sources, log_entry, on_one_line
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT, Finding
from boatsim.diagnosis.checks.hypothesis_test import compare_reinterpretations
from boatsim.diagnosis.checks.initial_actuator_state import with_initial_actuators
from boatsim.diagnosis.config import DEFAULT, ChecksConfig, DiagnosisConfig
from boatsim.diagnosis.correlation_time import with_correlation_time
from boatsim.diagnosis.covariance_inflation import inflate_covariance
from boatsim.diagnosis.experiment_design import next_experiment
from boatsim.diagnosis.filter import (
    MappedRecording,
    axes_of,
    map_recording,
    prior_levels,
    relative_noise,
    shared_noise,
)
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.locate import missing_force as locate
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.locate.mean_force import mean_residual_force
from boatsim.diagnosis.problem import Problem, check_uncertainty
from boatsim.diagnosis.report import assumptions, before_after
from boatsim.diagnosis.report.answer import compose, meanings
from boatsim.diagnosis.report.findings import Findings, Missing
from boatsim.diagnosis.report.formatting import capital, listed
from boatsim.diagnosis.report.schema import Answer, LogEntry
from boatsim.diagnosis.search.ranking import Ranking, rank
from boatsim.diagnosis.symbolic.residual_description import describe
from boatsim.diagnosis.symbolic.slots import write_term
from boatsim.errors import BadInput
from boatsim.files import Value
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report, part, silent
from boatsim.recordings.notes import notes_for
from boatsim.recordings.table import Recording, read

SAME_SCALE = 0.01  # scales this close are one
NEXT = "next.toml"  # scenario of the next experiment, in the folder of the answer
READ, RANKING, DESCRIBING, SHOWING = (
    0.05,
    (0.1, 0.7),
    (0.7, 0.85),
    0.9,
)  # shares of the work, by experience
LOOKING = "looking at the log"


@dataclass(frozen=True)
class Diagnosis:
    """Findings with what is needed to write patched vessel and overlay."""

    findings: Findings
    vessel: Vessel
    problem: Problem
    ranking: Ranking
    remarks: tuple[str, ...]  # what was read and not used
    plan: next_experiment.Plan | None = None  # what to record next

    def laid(
        self, recording: Recording, stated: Mapping[str, float] | None = None
    ) -> MappedRecording:
        """A further recording on the same program, with the laws that were described; `stated` is sensor noise."""
        mapped = map_recording(recording, self.problem.program, stated)
        made = with_initial_actuators(mapped, self.problem.ambient, self.problem.config.checks)
        for w in self.ranking.description.terms if self.ranking.description else ():
            write_term(self.problem, w.term.name, w.term, [made])
        return made


def vessel_for(path: Path, vessel: str | None, load: Sequence[str]) -> Vessel:
    """The vessel of a recording: the name on the command line, else the one its notes give. Raises BadInput."""
    file = notes_for(path)
    notes, name = file.notes, file.notes.vessel if vessel is None else vessel
    beside = file.folder if vessel is None else None
    if not path.exists():
        raise BadInput(f"{path}: there is no such file")
    if not name:
        raise BadInput(
            f"{path}: no vessel given; name one with --vessel or in a recording.toml beside it"
        )
    try:
        found = vessels.load(name, load or notes.load, notes.settings, base_folder=beside)
    except BadInput as error:
        by_notes = not vessel or notes.settings or (notes.load and not load)
        raise BadInput(
            f"{path} by its recording.toml: {error}" if by_notes else str(error)
        ) from None
    wanted = notes.scale
    if wanted is None or found.scale is None or abs(wanted / found.scale - 1.0) < SAME_SCALE:
        return found
    same = next(
        (n for n, scale in found.scales.items() if abs(wanted / scale - 1.0) < SAME_SCALE), None
    )
    if vessel or same is None:
        hint = f"; the vessel at that scale is {same}" if same else ""
        raise BadInput(
            f"{path}: scale = {wanted:g}, but {found.name} is at scale {found.scale:g}{hint}"
        )
    return vessels.load(same, load or notes.load, notes.settings)


def open_recording(
    path: Path,
    vessel: str | None,
    load: Sequence[str],
    config: DiagnosisConfig = DEFAULT,
) -> tuple[Recording, Vessel]:
    """A recording read with its vessel's names of columns and command limits. Raises BadInput."""
    found = vessel_for(path, vessel, load)
    recording = read(path, found.limits(), found.columns)
    return data_cleaning.prepare_recording(recording, found, config.checks), found


def diagnose(
    runs: Sequence[Path],
    hold_out: Sequence[Path] = (),
    vessel: str | None = None,
    load: Sequence[str] = (),
    library: Sequence[str] = (),
    without: Sequence[str] = (),
    horizon: float | None = None,
    facts: Mapping[str, Value] | None = None,
    report: Report = silent,
    config: DiagnosisConfig = DEFAULT,
) -> Diagnosis:
    """Locate, name and model what the vessel leaves out of the recordings. Raises BadInput.

    `horizon` is the length [s] of the free runs by which it is judged, if not the usual one; `facts` are those of all
    the recordings that their notes do not state.
    """
    _check_apart([*runs, *hold_out])
    opened = []
    for i, path in enumerate(paths := (*runs, *hold_out)):
        report(
            f"reading {len(paths)} {'recording' if len(paths) == 1 else 'recordings'}",
            READ * i / len(paths),
        )
        opened.append(open_recording(path, vessel, load, config))
    report(LOOKING, READ)
    stated = [replace(r.notes, facts={**(facts or {}), **r.notes.facts}) for r, _ in opened]
    opened = [(replace(r, notes=notes), b) for (r, b), notes in zip(opened, stated, strict=True)]
    boats = [boat for _, boat in opened]
    if len({(b.file, b.dof) for b in boats}) > 1:
        raise BadInput(
            f"recordings of different vessels: {', '.join(sorted({b.name for b in boats}))}"
        )
    duration = data_cleaning.total_duration([r for r, _ in opened])
    thin = [data_cleaning.clean_recording(r, b, duration, config) for r, b in opened]
    seen = [
        f
        for (r, b), t in zip(opened, thin, strict=True)
        for f in run_checks.check_recording(r, t, b, config.checks)
    ]
    named = [replace(r, name=n) for r, n in zip(thin, _names([*runs, *hold_out]), strict=True)]
    fitted, held_out, note = before_after.split(named[: len(runs)], named[len(runs) :])
    remarks = tuple(dict.fromkeys(m for r in thin for m in r.remarks))
    vessels_of = {r.path: b for r, b in opened}
    rest = part(report, READ, 1.0)
    return diagnose_recordings(
        fitted, held_out, vessels_of, note, library, without, remarks, horizon, seen, rest, config
    )


def pose(
    fitted: Sequence[Recording],
    held_out: Sequence[Recording],
    boats: Mapping[Path | None, Vessel],
    library: Sequence[str] = (),
    horizon: float | None = None,
    config: DiagnosisConfig = DEFAULT,
) -> tuple[Problem, list[MappedRecording], Callable[[Recording], MappedRecording], Library]:
    """The question that opened recordings put: them on one program, those unseen, how one is laid, what is tried."""
    boat, facts = boats[fitted[0].path], fitted[0].notes.facts
    columns = sorted({c for r in fitted for c in r.signals})
    known = {
        path: with_stated_errors(without_ruled_out(b, facts), facts) for path, b in boats.items()
    }
    there = {path: library_for(b, library, facts, columns) for path, b in known.items()}
    programs = {path: Program(b, there[path].compiled) for path, b in known.items()}
    stated, levels = shared_noise(boat, fitted), prior_levels(boat, fitted)

    def lay(recording: Recording) -> MappedRecording:
        mapped = map_recording(recording, programs[recording.path], stated)
        return with_initial_actuators(mapped, levels, config.checks)

    laid = [lay(r) for r in fitted]
    laid += [
        with_initial_actuators(
            map_recording(r, programs[r.path], stated, relative_noise(boat, fitted, r)),
            levels,
            config.checks,
        )
        for r in held_out
    ]
    uncertainty = priors.uncertainty(boat)
    check_uncertainty(boat, uncertainty, f"{boat.file.parent.name}/{boat.file.name}: diagnosis")
    for r in (*fitted, *held_out):
        check_uncertainty(
            boats[r.path],
            r.notes.coefficient_uncertainty,
            f"{r.path or r.name} by its recording.toml",
        )
    uncertainty |= fitted[0].notes.coefficient_uncertainty
    problem = Problem(laid[: len(fitted)], levels, uncertainty, horizon, config)
    return problem, laid[len(fitted) :], lay, there[fitted[0].path]


def check(
    runs: Sequence[Path],
    vessel: str | None = None,
    load: Sequence[str] = (),
    config: DiagnosisConfig = DEFAULT,
) -> tuple[dict[Path, list[LogEntry]], list[BadInput]]:
    """What is wrong with each of some files, and what can not be told from it; and those that can not be read at all.

    A file whose table is at fault is not laid on its vessel. Raises BadInput where no vessel is named, or several.
    """
    boats = {path: vessel_for(path, vessel, load) for path in runs}
    if len({(b.file, b.dof) for b in boats.values()}) > 1:
        raise BadInput(
            f"recordings of different vessels: {', '.join(sorted({b.name for b in boats.values()}))}"
        )
    found: list[Finding] = []
    refused, thin = list[BadInput](), list[Recording]()
    for path, boat in boats.items():
        table = []
        try:
            found += (table := run_checks.check_table(path, boat, config.checks))
            read_recording = read(path, boat.limits(), boat.columns)
            opened = data_cleaning.prepare_recording(read_recording, boat, config.checks)
        except BadInput as error:
            if not table:
                refused.append(error)
            continue
        duration = data_cleaning.total_duration([opened])
        thinned = data_cleaning.clean_recording(opened, boat, duration, config)
        found += [
            *run_checks.check_recording(opened, thinned, boat, config.checks),
            *run_checks.check_identifiability(opened, boat, config.checks),
        ]
        if not table:
            thin.append(replace(thinned, name=str(path)))
    if thin:
        try:
            known: dict[Path | None, Vessel] = dict(boats.items())
            problem, _, lay, _ = pose(thin, (), known, config=config)
            found += [
                replace(f, run=str(thin[0].path))
                for f in compare_reinterpretations(thin, lay, problem)
            ]
        except BadInput as error:
            refused.append(error)
    by_file = {path: [f for f in found if f.run == str(path)] for path in runs}
    return {
        p: [log_entry(f, column_sources(f.run, boats[p])) for f in fs] for p, fs in by_file.items()
    }, refused


def hint(
    runs: Sequence[Path], hold_out: Sequence[Path], vessel: str | None, load: Sequence[str]
) -> str:
    """What `check` would write into the recording.toml of the first file that is refused; "" where it knows nothing."""
    for path in (*runs, *hold_out):
        try:
            boat = vessel_for(path, vessel, load)
            found = run_checks.check_table(path, boat, DEFAULT.checks)
        except BadInput:
            return ""
        for made in (log_entry(f, column_sources(f.run, boat)) for f in found):
            if made["lines"]:
                return f"; {LOG_NOT_BOAT}: {made['name'].replace('_', ' ')}, write into recording.toml {on_one_line(made['lines'])}"
    return ""


def diagnose_recordings(
    fitted: Sequence[Recording],
    held_out: Sequence[Recording],
    boats: Mapping[Path | None, Vessel],
    note: str,
    library: Sequence[str] = (),
    without: Sequence[str] = (),
    remarks: tuple[str, ...] = (),
    horizon: float | None = None,
    seen: Sequence[Finding] = (),
    report: Report = silent,
    config: DiagnosisConfig = DEFAULT,
) -> Diagnosis:
    """The same for recordings that are already opened, thinned and split: `boats` is the vessel of each file.

    `note` says in words what was kept unseen, `seen` is what is wrong with the files. Raises BadInput.
    """
    boat = boats[fitted[0].path]
    problem, held_out_tracks, lay, there = pose(fitted, held_out, boats, library, horizon, config)
    candidates = less(there, without)
    report("compiling, or loading what was compiled before")
    _compile(problem)
    begin = time.perf_counter()
    try:
        with threadpool_limits(
            1, "blas"
        ):  # matrices are small: threads cost more, on a busy machine twentyfold
            report("laying the log on the vessel, as it may have been meant", RANKING[0] / 2)
            seen = [*seen, *compare_reinterpretations(fitted, lay, problem)]
            ranking = rank(problem, candidates, held_out_tracks, report=part(report, *RANKING))
            a_fact = "time_constant_s" in fitted[0].notes.ambient
            report("choosing the correlation time of the water", RANKING[1])
            if (
                not a_fact
                and (again := with_correlation_time(problem, ranking.best)) is not problem
            ):
                report("selecting once more, with that time", RANKING[1])
                problem, ranking = again, rank(again, candidates, held_out_tracks, ranking.best)
            before, ranking = (
                ranking,
                _described(problem, ranking, held_out_tracks, part(report, *DESCRIBING)),
            )
            report("planning what to record next", DESCRIBING[1])
            plan = next_experiment.best_plan(
                problem,
                *next_experiment.open_question(replace(before, named=ranking.named), config),
            )
            report("free runs", SHOWING)
            findings = _findings(problem, ranking, held_out_tracks, boat, note, plan)
    except (np.linalg.LinAlgError, FloatingPointError) as error:
        where = fitted[0].path or fitted[0].name
        raise BadInput(
            f"{where}: {boat.name} can not follow this recording ({error}); are its units right?"
        ) from None
    assumptions.add(findings.answer, problem, there, candidates)
    _add_log(findings.answer, seen, fitted[0], boats, config.checks)
    findings.answer["seconds"] = round(time.perf_counter() - begin, 3)
    return Diagnosis(findings, boat, problem, ranking, remarks, plan)


def _add_log(
    answer: Answer,
    seen: Sequence[Finding],
    first: Recording,
    boats: Mapping[Path | None, Vessel],
    config: ChecksConfig,
) -> None:
    """What is wrong with the log itself; what is certain of the whole of it comes first in the verdict."""
    named = [f if f.run else replace(f, run=str(first.path or first.name)) for f in seen]
    paths = {str(path): boat for path, boat in boats.items()}
    answer["log"] = [
        log_entry(f, column_sources(f.run, paths.get(f.run, boats[first.path]))) for f in named
    ]
    if certain := [f.description for f in named if f.invalidates_log(config)]:
        rest = answer["sentence"]
        answer["sentence"] = (
            f"{capital(LOG_NOT_BOAT)}: {listed(certain)}. Taken as it is: {rest[:1].lower()}{rest[1:]}"
        )


def _check_apart(paths: Sequence[Path]) -> None:
    """What is judged on must not be what was fitted."""
    seen: set[str] = set()
    for path in paths:
        if (real := os.path.realpath(path)) in seen:
            raise BadInput(f"{path}: given twice; a recording is either fitted or held out, once")
        seen.add(real)


def _names(paths: Sequence[Path]) -> list[str]:
    """Short names that tell the recordings apart: the stem, with as many folders in front as that takes."""
    for depth in range(1, 9):
        short = ["/".join(p.resolve().with_suffix("").parts[-depth:]) for p in paths]
        if len(set(short)) == len(short):
            return short
    return [str(p) for p in paths]


def _compile(problem: Problem) -> None:
    """Compile or load the filter before the clock starts: the first time takes far longer than any diagnosis."""
    nominal, on = problem.nominal(), problem.program.switches()
    track = problem.recordings[0]
    track.free_runs(
        problem.values(track, nominal.free, nominal.theta),
        on,
        problem.ambient,
        float(np.ptp(track.times)),
    )
    rest = np.zeros((1, 2 * problem.program.module.NQ))
    nominal_forces.body_forces(track, rest, nominal_forces.actuator_states(track)[:1], track.values)


def _described(
    problem: Problem, ranking: Ranking, held_out: Sequence[MappedRecording], report: Report
) -> Ranking:
    """The same with a law written down for what nothing explains, and without entries that but stood for it."""
    found = (
        describe(problem, ranking.best, ranking.recalibrated, held_out, report)
        if ranking.unknown
        else None
    )
    if found is None:
        return ranking
    named = tuple(n for n in ranking.named if n.name in found.fit.effects)
    best = ranking.best if found.fit is ranking.best else inflate_covariance(problem, found.fit)
    terms = (
        replace(w, sd=best.value(w.term.name, "coefficient")[1]) if w.carries else w
        for w in found.terms
    )
    return replace(ranking, best=best, named=named, description=replace(found, terms=tuple(terms)))


def _findings(
    problem: Problem,
    ranking: Ranking,
    held_out: Sequence[MappedRecording],
    vessel: Vessel,
    note: str,
    plan: next_experiment.Plan | None,
) -> Findings:
    """Locate and show, then the answer."""
    longest = max(float(np.ptp(t.times)) for t in held_out)
    horizon = min(problem.horizon, float(f"{longest:.3g}") if longest < problem.horizon else np.inf)
    fits = before_after.fits_of(problem, ranking)
    everything = before_after.in_time([*problem.recordings, *held_out])
    forces = locate.missing_force(problem, ranking.recalibrated, everything)
    left = locate.residual_force(problem, ranking.best, everything)
    stretches = free_runs(problem, fits, held_out, horizon)
    parts = before_after.by_part(problem, fits, everything, horizon) if ranking.adds else []
    table = before_after.table_of(parts, problem.recordings, horizon)
    axes = axes_of(vessel)

    def columns(values: Array) -> dict[str, Array]:
        return {axis: values[:, i] for i, axis in enumerate(axes)}

    missing = tuple(
        Missing(
            f.run,
            f.t,
            columns(f.mean),
            columns(f.sd),
            {a: locate.FORCE_UNITS[a] for a in axes},
            columns(g.mean),
        )
        for f, g in zip(forces, left, strict=True)
    )
    recalibrated = ranking.recalibrated
    sd = np.sqrt(np.diag(recalibrated.covariance))
    coefficients = {
        f"{f.effect}.{f.name}": (float(x), float(s))
        for f, x, s in zip(recalibrated.free, recalibrated.theta, sd, strict=True)
    }
    held_out_names = tuple(t.name for t in held_out)
    answer = compose(
        problem,
        ranking,
        forces,
        left,
        stretches,
        held_out_names,
        horizon,
        next_experiment.plan_entry(plan, NEXT),
    )
    answer["mean_left"] = mean_residual_force(problem, ranking.best, everything)
    return Findings(
        answer,
        vessel.name,
        tuple(t.name for t in problem.recordings),
        held_out_names,
        note,
        missing,
        tuple(stretches),
        tuple(before_after.remarks(parts, problem.recordings, errors(stretches), ranking)),
        coefficients,
        (table,) if table[2] else (),
        meanings(problem.program.candidates, problem.program.vessel),
        ranking.description.terms if ranking.description else (),
        next_experiment.command_steps(plan),
        (vessel.length, vessel.beam),
    )
