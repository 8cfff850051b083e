"""A whole diagnosis: recordings and a vessel in, findings out."""

import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from boatsim import vessel as vessels
from boatsim.base import Array, Effect
from boatsim.content import load_class, names
from boatsim.diagnose import locate, show
from boatsim.diagnose.answer import compose
from boatsim.diagnose.filter import axes_of, nominal_levels, track
from boatsim.diagnose.findings import Findings, Missing
from boatsim.diagnose.problem import Problem
from boatsim.diagnose.rank import Ranking, rank
from boatsim.errors import BadInput, unknown_name
from boatsim.program import Program
from boatsim.recording import Recording, read
from boatsim.vessel import Vessel


@dataclass(frozen=True)
class Diagnosis:
    """Findings with what is needed to write patched vessel and overlay."""

    findings: Findings
    vessel: Vessel
    problem: Problem
    ranking: Ranking


def vessel_for(recording: Recording, vessel: str | None, load: Sequence[str]) -> Vessel:
    """The vessel of a recording: the name on the command line, else the one its notes give. Raises BadInput."""
    name = vessel or recording.notes.vessel
    if not name:
        raise BadInput(f"{recording.path}: no vessel given; name one with --vessel or in a recording.toml beside it")
    return vessels.load(name, load or recording.notes.load, recording.notes.settings)


def open_recording(path: Path, vessel: str | None, load: Sequence[str]) -> tuple[Recording, Vessel]:
    """Read a recording twice over: for its vessel, then with that vessel's command limits. Raises BadInput."""
    found = vessel_for(read(path), vessel, load)
    return read(path, found.limits()).used(), found


def _thinned(recording: Recording, vessel: Vessel) -> tuple[Recording, Vessel]:
    return recording.thinned(vessel.diagnosis.rate), vessel


def _named_apart(opened: dict[Path, tuple[Recording, Vessel]]) -> dict[Path, tuple[Recording, Vessel]]:
    """Recordings of the same file name get their folder's name in front: sway_1/camera."""
    stems = [path.stem for path in opened]
    return {
        path: (replace(r, name=f"{path.resolve().parent.name}/{path.stem}") if stems.count(path.stem) > 1 else r, v)
        for path, (r, v) in opened.items()
    }


def suspects_of(vessel: Vessel, library: Sequence[str], without: Sequence[str]) -> tuple[Effect, ...]:
    """Entries to try: the vessel's list and --library, less --without and what the vessel already has."""
    wanted = dict.fromkeys([*vessel.diagnosis.suspects, *library])
    for name in without:
        if name not in wanted and name not in names("effect"):
            raise BadInput(unknown_name("--without", name, wanted))
    out = []
    for name in wanted:
        kind: type[Effect] = load_class("effect", name)
        if kind.name() in without or vessel.effect(kind.name()) is not None:
            continue
        out.append(absent(kind).completed(vessel))
    return tuple(out)


def absent(kind: type[Effect]) -> Effect:
    """An entry at the values at which it does nothing."""
    return kind.from_settings({n: p.absent for n, p in kind.params().items() if p.fit})


def diagnose(
    runs: Sequence[Path],
    hold_out: Sequence[Path] = (),
    vessel: str | None = None,
    load: Sequence[str] = (),
    library: Sequence[str] = (),
    without: Sequence[str] = (),
) -> Diagnosis:
    """Locate, name and model what the vessel leaves out of the recordings. Raises BadInput."""
    opened = {path: _thinned(*open_recording(path, vessel, load)) for path in dict.fromkeys([*runs, *hold_out])}
    opened = _named_apart(opened)
    boats = {id(r): v for r, v in opened.values()}
    whole = [opened[p][0] for p in runs]
    first = boats[id(whole[0])]
    fitted, unseen, note = show.split(whole, [opened[p][0] for p in hold_out])
    if len({v.name for _, v in opened.values()}) > 1:
        raise BadInput(f"recordings of different vessels: {', '.join(sorted({v.name for _, v in opened.values()}))}")
    programs = {key: Program(v, suspects_of(v, library, without)) for key, v in boats.items()}

    def program_of(part: Recording) -> Program:
        return programs[id(next((r for r, _ in opened.values() if r is part), whole[0]))]

    laid = [track(r, program_of(r)) for r in (*fitted, *unseen)]
    ambient = nominal_levels(first, fitted)
    uncertainty = {**first.diagnosis.coefficient_uncertainty, **fitted[0].notes.coefficient_uncertainty}
    problem = Problem(laid[: len(fitted)], ambient, uncertainty)
    begin = time.perf_counter()
    ranking = rank(problem, tuple(e.name() for e in programs[id(whole[0])].suspects))
    findings = _findings(problem, ranking, laid[len(fitted) :], first, begin)
    findings = replace(
        findings,
        runs=tuple(r.name for r in fitted),
        held_out=tuple(r.name for r in unseen),
        held_out_note=note,
    )
    for line in dict.fromkeys(m for r, _ in opened.values() for m in r.remarks):
        warnings.warn(line, stacklevel=2)
    return Diagnosis(findings, first, problem, ranking)


def _findings(problem: Problem, ranking: Ranking, unseen: Sequence, vessel: Vessel, begin: float) -> Findings:  # type: ignore[type-arg]
    """Locate and show, then the answer."""
    horizon = vessel.diagnosis.horizon
    fits = show.fits_of(problem, ranking)
    everything = [*problem.tracks, *unseen]
    forces = locate.missing_force(problem, ranking.recalibrated, everything)
    left = locate.missing_force(problem, ranking.best, everything)
    stretches = show.free_runs(problem, fits, unseen, horizon)
    parts = show.by_part(problem, fits, everything, horizon) if ranking.named else []
    tables = [show.table_of(parts, problem.tracks, horizon)]
    answer = compose(problem, ranking, forces, stretches, [t.name for t in unseen], horizon)
    answer["seconds"] = round(time.perf_counter() - begin, 3)
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
    return Findings(
        answer, vessel.name, (), (), "", missing, tuple(stretches), tuple(show.remarks(parts, problem.tracks)),
        coefficients, tuple(t for t in tables if t[2]),
    )  # fmt: skip
