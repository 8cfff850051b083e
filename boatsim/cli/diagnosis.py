"""What `boatsim diagnose`, `replay` and `compare` do: files in, files and a few printed lines out."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import remark, say
from boatsim.cli.progress import reporting
from boatsim.diagnosis.checks.entry import entry_text
from boatsim.diagnosis.config import from_settings
from boatsim.diagnosis.free_runs import FreeRun, errors, free_runs
from boatsim.diagnosis.loading import open_recording
from boatsim.diagnosis.log_check import correction_hint
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.pipeline import diagnose as analyse
from boatsim.diagnosis.replay import as_written, columns, replayed
from boatsim.diagnosis.report.answer import NEXT_SCENARIO
from boatsim.diagnosis.report.output_files import write
from boatsim.diagnosis.report.sentences import printed
from boatsim.errors import BadInput
from boatsim.files import replacing
from boatsim.physics.signals import STATE, Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording, write_csv
from boatsim.simulate import scenario as scenarios

WRITING = 0.97  # of a diagnosis is done when its files are written, by experience


def diagnose(
    runs: list[Path],
    hold_out: list[Path],
    vessel: str | None,
    load: list[str],
    out: Path,
    library: list[str],
    without: list[str],
    horizon: float | None = None,
    settings: Mapping[str, str] | None = None,
) -> int:
    """Diagnose recordings and write diagnosis.json, report.html, report.md, patched.toml, diagnosis.rrd to `out`."""
    config = from_settings(settings or {})
    with reporting() as told:
        try:
            found = analyse(
                runs,
                hold_out,
                vessel,
                load,
                library,
                without,
                horizon,
                report=told,
                config=config,
            )
        except BadInput as error:
            raise BadInput(f"{error}{correction_hint(runs, hold_out, vessel, load)}") from None
        told("writing the report", WRITING)
        full = _unwritten(found, out)
    faults = [e for e in found.findings.answer.get("log", []) if e["kind"] == "fault"]
    for line in (
        *(f"{e['run']}: {words.strip()}" for e in faults for words in entry_text(e)),
        *found.remarks,
    ):
        remark(line)
    if full:  # which does not cost the answer
        say(printed(found.findings))
        raise full
    plan = [NEXT_SCENARIO] if found.plan else []
    files = ["report.html", "report.md", "diagnosis.json", "patched.toml", *plan, "diagnosis.rrd"]
    say([*printed(found.findings), f"written to {out}: {', '.join(files)}"])
    return 0


def _unwritten(found: Diagnosis, out: Path) -> OSError | None:
    """Write its files; what a full disk says."""
    try:
        write(found, out)
    except OSError as error:
        return error
    return None


def replay(run: Path, vessel: str | None, load: list[str], horizon: float, out: Path) -> int:
    """Free runs of a vessel over a recording, driven by the recorded commands alone: replay.csv and rms errors."""
    with reporting() as told:
        told("reading the recording")
        recording, boat = open_recording(run, vessel, load)
        stretches = replayed(recording, boat, horizon, told)
    for line in recording.remarks:
        remark(line)
    _write_replay(stretches, out / "replay.csv")
    for family, found in errors(stretches).items():
        say([f"{family}: {found['simulated']:.5g} ({len(stretches)} free runs of {horizon:g} s)"])
    say([f"written to {out}: replay.csv"])
    return 0


def _write_replay(stretches: Sequence[FreeRun], path: Path) -> None:
    """Each free run whole, also where two share a time; times as in the recording."""
    found = columns(stretches)
    digits = ["%.10g", *["%.9g"] * (len(found) - 1)]
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        np.savetxt(
            file,
            np.column_stack(list(found.values())),
            digits,
            ",",
            header=",".join(found),
            comments="",
        )


def compare(run: Path, vessel: str | None, load: list[str], scenario: str | None, out: Path) -> int:
    """A recording beside a simulation: of its own commands from its smoothed first state, or of a scenario.

    Where a run of ours says which scenario it is of, the scenario's effects act too, unless a vessel or load is named.
    """
    with reporting() as told:
        told("reading the recording")
        recording, boat = open_recording(run, vessel, load)
        if vessel is None and not load and not scenario:
            boat = _as_it_was(recording, boat)
        if scenario:
            told(f"running {scenario}", 0.1)
            simulated = _of_scenario(recording, scenario)
        else:
            problem, fitted = as_written(recording, boat, told)
            told("the free run", 0.8)
            whole = float(recording.t[-1] - recording.t[0])
            simulated = free_runs(problem, {"simulated": fitted}, problem.recordings, whole)[
                0
            ].channels["simulated"]
    for line in recording.remarks:
        remark(line)
    signals: dict[str, Array] = {}
    lines = [f"{'signal':10s} {'rms error':>12s} {'largest':>12s}   of a range of"]
    for name, value in simulated.items():
        off = value - recording.signals[name]
        signals |= {
            f"recorded_{name}": recording.signals[name],
            f"simulated_{name}": value,
            f"error_{name}": off,
        }
        reach = float(np.nanmax(recording.signals[name]) - np.nanmin(recording.signals[name]))
        lines.append(f"{name:10s} {_rms(off):12.5g} {np.nanmax(np.abs(off)):12.5g}   {reach:.5g}")
    with atomic_folder(out) as new:
        write_csv(Recording(recording.name, recording.t, signals, Notes()), new / "compare.csv")
        _compare_rrd(boat, recording, simulated, new / "compare.rrd")
    say([*lines, f"written to {out}: compare.csv, compare.rrd"])
    return 0


def _as_it_was(recording: Recording, boat: Vessel) -> Vessel:
    """The boat with what its scenario added to it; as it is where no scenario can be found that is of this boat."""
    name, seed = recording.notes.facts.get("scenario"), recording.notes.facts.get("seed")
    if not isinstance(name, str):
        return boat
    try:
        found = scenarios.load(name).vessel
    except BadInput as error:
        remark(f"compared with the vessel alone; its scenario {name} can not be used: {error}")
        return boat
    if (found.file, found.dof) != (boat.file, boat.dof):
        remark(
            f"compared with the vessel alone; its scenario {name} is of another one, {found.name}"
        )
        return boat
    added = [e for e in found.effects if boat.effect(e.name) is None]
    if added:
        near = min(name, os.path.relpath(name), key=len) if Path(name).is_file() else name
        remark(
            f"{near} adds {', '.join(e.name for e in added)}; --vessel {boat.name} compares with the vessel alone"
        )
    seeded = (
        tuple(e.seeded(seed) for e in found.effects) if isinstance(seed, int) else found.effects
    )
    return replace(found, effects=seeded)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def _of_scenario(recording: Recording, name: str) -> dict[str, Array]:
    """A scenario's own run at the times of a recording."""
    from boatsim.simulate.run import run

    log = run(scenarios.load(name)).recording
    if recording.t[0] > log.t[-1]:
        raise BadInput(
            f"{name} ends at {log.t[-1]:g} s, before {recording.name} begins ({recording.t[0]:g} s)"
        )
    shared = [s.column for s in STATE if s.column in recording.signals and s.column in log.signals]
    return {n: np.interp(recording.t, log.t, log.signals[n], right=np.nan) for n in shared}


def _compare_rrd(
    boat: Vessel, recording: Recording, simulated: Mapping[str, Array], path: Path
) -> None:
    from boatsim.view import rerun_log, water

    measured = Recording("recording", recording.t, {n: recording.signals[n] for n in simulated})
    boats = {
        "recording": [measured],
        "simulated": [Recording("simulated", recording.t, dict(simulated))],
    }
    with replacing(path) as temporary:
        rerun_log.log_overlay(temporary, boats, None, [], water.around(boat, boats))
