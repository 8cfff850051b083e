"""A whole diagnosis: recordings and a vessel in, findings out."""

import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnose import rules
from boatsim.diagnose.correlation_time import timed
from boatsim.diagnose.describe.describe import described
from boatsim.diagnose.describe.slots import write
from boatsim.diagnose.filter import Track, axes_of, noise_beside, noise_of, nominal_levels, track
from boatsim.diagnose.free_runs import errors, free_runs
from boatsim.diagnose.locate import forces as locate
from boatsim.diagnose.locate import hull_forces
from boatsim.diagnose.log.first_orders import begun
from boatsim.diagnose.log.held_fixes import without_repeats
from boatsim.diagnose.log.outlying_fixes import without_outliers
from boatsim.diagnose.log.position_frame import in_one_frame
from boatsim.diagnose.log.steering_sense import steered
from boatsim.diagnose.log.turning_readings import unwound
from boatsim.diagnose.next import experiment
from boatsim.diagnose.problem import Problem, check_taken_up
from boatsim.diagnose.report import show, taken
from boatsim.diagnose.report.answer import compose, meanings
from boatsim.diagnose.report.findings import Findings, Missing
from boatsim.diagnose.search.rank import Ranking, rank
from boatsim.diagnose.spread import widened
from boatsim.diagnose.tried import less, library_for, with_stated_errors, without_ruled_out
from boatsim.errors import BadInput
from boatsim.files import Value
from boatsim.physics import vessel as vessels
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import notes_for
from boatsim.recordings.table import Recording, read

SAME_SCALE = 0.01  # scales this close are one
NEXT = "next.toml"  # scenario of the next experiment, in the folder of the answer


@dataclass(frozen=True)
class Diagnosis:
    """Findings with what is needed to write patched vessel and overlay."""

    findings: Findings
    vessel: Vessel
    problem: Problem
    ranking: Ranking
    remarks: tuple[str, ...]  # what was read and not used
    plan: experiment.Plan | None = None  # what to record next

    def laid(self, recording: Recording, stated: Mapping[str, float] | None = None) -> Track:
        """A further recording on the same program, with the laws that were described; `stated` is sensor noise."""
        made = begun(track(recording, self.problem.program, stated), self.problem.ambient)
        for w in self.ranking.description.terms if self.ranking.description else ():
            write(self.problem, w.term.name, w.term, [made])
        return made


def vessel_for(path: Path, vessel: str | None, load: Sequence[str]) -> Vessel:
    """The vessel of a recording: the name on the command line, else the one its notes give. Raises BadInput."""
    file = notes_for(path)
    notes, name = file.notes, file.notes.vessel if vessel is None else vessel
    beside = file.folder if vessel is None else None
    if not path.exists():
        raise BadInput(f"{path}: there is no such file")
    if not name:
        raise BadInput(f"{path}: no vessel given; name one with --vessel or in a recording.toml beside it")
    try:
        found = vessels.load(name, load or notes.load, notes.settings, beside=beside)
    except BadInput as error:
        by_notes = not vessel or notes.settings or (notes.load and not load)
        raise BadInput(f"{path} by its recording.toml: {error}" if by_notes else str(error)) from None
    wanted = notes.scale
    if wanted is None or found.scale is None or abs(wanted / found.scale - 1.0) < SAME_SCALE:
        return found
    same = next((n for n, scale in found.scales.items() if abs(wanted / scale - 1.0) < SAME_SCALE), None)
    if vessel or same is None:
        hint = f"; the vessel at that scale is {same}" if same else ""
        raise BadInput(f"{path}: scale = {wanted:g}, but {found.name} is at scale {found.scale:g}{hint}")
    return vessels.load(same, load or notes.load, notes.settings)


def open_recording(path: Path, vessel: str | None, load: Sequence[str]) -> tuple[Recording, Vessel]:
    """A recording read with its vessel's names of columns and command limits. Raises BadInput."""
    found = vessel_for(path, vessel, load)
    recording = unwound(read(path, found.limits(), found.columns).used(), found)
    return in_one_frame(steered(recording, found)), found


def diagnose(
    runs: Sequence[Path],
    hold_out: Sequence[Path] = (),
    vessel: str | None = None,
    load: Sequence[str] = (),
    library: Sequence[str] = (),
    without: Sequence[str] = (),
    horizon: float | None = None,
    facts: Mapping[str, Value] | None = None,
) -> Diagnosis:
    """Locate, name and model what the vessel leaves out of the recordings. Raises BadInput.

    `horizon` is the length [s] of the free runs by which it is judged, if not the usual one; `facts` are those of all
    the recordings that their notes do not state.
    """
    _check_apart([*runs, *hold_out])
    opened = [open_recording(path, vessel, load) for path in (*runs, *hold_out)]
    stated = [replace(r.notes, facts={**(facts or {}), **r.notes.facts}) for r, _ in opened]
    opened = [(replace(r, notes=notes), b) for (r, b), notes in zip(opened, stated, strict=True)]
    boats = [boat for _, boat in opened]
    if len({(b.file, b.freedoms) for b in boats}) > 1:
        raise BadInput(f"recordings of different vessels: {', '.join(sorted({b.name for b in boats}))}")
    thin = [without_outliers(without_repeats(r.thinned(rules.rate(b))), b) for r, b in opened]
    named = [replace(r, name=n) for r, n in zip(thin, _names([*runs, *hold_out]), strict=True)]
    fitted, unseen, note = show.split(named[: len(runs)], named[len(runs) :])
    remarks = tuple(dict.fromkeys(m for r in thin for m in r.remarks))
    vessels_of = {r.path: b for r, b in opened}
    return diagnose_recordings(fitted, unseen, vessels_of, note, library, without, remarks, horizon)


def diagnose_recordings(
    fitted: Sequence[Recording],
    unseen: Sequence[Recording],
    boats: Mapping[Path | None, Vessel],
    note: str,
    library: Sequence[str] = (),
    without: Sequence[str] = (),
    remarks: tuple[str, ...] = (),
    horizon: float | None = None,
) -> Diagnosis:
    """The same for recordings that are already opened, thinned and split: `boats` is the vessel of each file.

    `note` says in words what was kept unseen. Raises BadInput.
    """
    boat, facts = boats[fitted[0].path], fitted[0].notes.facts
    columns = sorted({c for r in fitted for c in r.signals})
    known = {path: with_stated_errors(without_ruled_out(b, facts), facts) for path, b in boats.items()}
    there = {path: library_for(b, library, facts, columns) for path, b in known.items()}
    programs = {path: Program(b, there[path].compiled) for path, b in known.items()}
    stated = noise_of(boat, fitted)
    laid = [track(r, programs[r.path], stated) for r in fitted]
    laid += [track(r, programs[r.path], stated, noise_beside(boat, fitted, r)) for r in unseen]
    uncertainty = rules.uncertainty(boat)
    check_taken_up(boat, uncertainty, f"{boat.file.parent.name}/{boat.file.name}: diagnosis")
    for r in (*fitted, *unseen):
        check_taken_up(boats[r.path], r.notes.coefficient_uncertainty, f"{r.path or r.name} by its recording.toml")
    uncertainty |= fitted[0].notes.coefficient_uncertainty
    levels = nominal_levels(boat, fitted)
    laid = [begun(t, levels) for t in laid]
    unseen_tracks = laid[len(fitted) :]
    problem = Problem(laid[: len(fitted)], levels, uncertainty, horizon)
    candidates = less(there[fitted[0].path], without)
    _compile(problem)
    begin = time.perf_counter()
    try:
        with threadpool_limits(1, "blas"):  # matrices are small: threads cost more, on a busy machine twentyfold
            ranking = rank(problem, candidates, unseen_tracks)
            a_fact = "time_constant_s" in fitted[0].notes.ambient
            if not a_fact and (again := timed(problem, ranking.best)) is not problem:
                problem, ranking = again, rank(again, candidates, unseen_tracks, ranking.best)
            before, ranking = ranking, _described(problem, ranking, unseen_tracks)
            plan = experiment.next_experiment(problem, *experiment.question(replace(before, named=ranking.named)))
            findings = _findings(problem, ranking, unseen_tracks, boat, note, plan)
    except (np.linalg.LinAlgError, FloatingPointError) as error:
        where = fitted[0].path or fitted[0].name
        raise BadInput(f"{where}: {boat.name} can not follow this recording ({error}); are its units right?") from None
    taken.add(findings.answer, problem, there[fitted[0].path], candidates)
    findings.answer["seconds"] = round(time.perf_counter() - begin, 3)
    return Diagnosis(findings, boat, problem, ranking, remarks, plan)


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
    track = problem.tracks[0]
    track.free_runs(problem.values(track, nominal.free, nominal.theta), on, problem.ambient, float(np.ptp(track.times)))
    rest = np.zeros((1, 2 * problem.program.module.NQ))
    hull_forces.along(track, rest, hull_forces.actuators(track)[:1], track.values)


def _described(problem: Problem, ranking: Ranking, unseen: Sequence[Track]) -> Ranking:
    """The same with a law written down for what nothing explains, and without entries that but stood for it."""
    found = described(problem, ranking.best, ranking.recalibrated, unseen) if ranking.unknown else None
    if found is None:
        return ranking
    named = tuple(n for n in ranking.named if n.name in found.fit.suspects)
    best = ranking.best if found.fit is ranking.best else widened(problem, found.fit)
    terms = (replace(w, sd=best.value(w.term.name, "coefficient")[1]) if w.carries else w for w in found.terms)
    return replace(ranking, best=best, named=named, description=replace(found, terms=tuple(terms)))


def _findings(
    problem: Problem,
    ranking: Ranking,
    unseen: Sequence[Track],
    vessel: Vessel,
    note: str,
    plan: experiment.Plan | None,
) -> Findings:
    """Locate and show, then the answer."""
    longest = max(float(np.ptp(t.times)) for t in unseen)
    horizon = min(problem.horizon, float(f"{longest:.3g}") if longest < problem.horizon else np.inf)
    fits = show.fits_of(problem, ranking)
    everything = [*problem.tracks, *unseen]
    forces = locate.missing_force(problem, ranking.recalibrated, everything)
    left = locate.force_left(problem, ranking.best, everything)
    stretches = free_runs(problem, fits, unseen, horizon)
    parts = show.by_part(problem, fits, everything, horizon) if ranking.adds else []
    table = show.table_of(parts, problem.tracks, horizon)
    axes = axes_of(vessel)

    def columns(values: Array) -> dict[str, Array]:
        return {axis: values[:, i] for i, axis in enumerate(axes)}

    missing = tuple(
        Missing(f.run, f.t, columns(f.mean), columns(f.sd), {a: locate.UNITS[a] for a in axes}, columns(g.mean))
        for f, g in zip(forces, left, strict=True)
    )
    recalibrated = ranking.recalibrated
    sd = np.sqrt(np.diag(recalibrated.covariance))
    coefficients = {
        f"{f.effect}.{f.name}": (float(x), float(s))
        for f, x, s in zip(recalibrated.free, recalibrated.theta, sd, strict=True)
    }
    held_out = tuple(t.name for t in unseen)
    return Findings(
        compose(problem, ranking, forces, left, stretches, held_out, horizon, experiment.entry(plan, NEXT)),
        vessel.name, tuple(t.name for t in problem.tracks), held_out, note, missing, tuple(stretches),
        tuple(show.remarks(parts, problem.tracks, errors(stretches), ranking)), coefficients,
        (table,) if table[2] else (), meanings(problem.program.suspects, problem.program.vessel),
        ranking.description.terms if ranking.description else (), experiment.steps(plan),
    )  # fmt: skip
