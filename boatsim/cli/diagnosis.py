"""What `boatsim diagnose`, `replay` and `compare` do: files in, files and a few printed lines out."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.cli.exits import remark, say
from boatsim.cli.progress import reporting
from boatsim.diagnose.analysis import NEXT, Diagnosis, hint, open_recording
from boatsim.diagnose.analysis import diagnose as analyse
from boatsim.diagnose.filter import nominal_levels, track
from boatsim.diagnose.free_runs import FreeRun, errors, free_runs
from boatsim.diagnose.levels import fit_noise
from boatsim.diagnose.log.entry import in_words
from boatsim.diagnose.log.first_orders import begun
from boatsim.diagnose.next.experiment import scenario_text
from boatsim.diagnose.problem import Fit, Problem
from boatsim.diagnose.report import page as report
from boatsim.diagnose.report import patch, show, stays, taken
from boatsim.diagnose.report.described import what_of
from boatsim.diagnose.report.entries import Family
from boatsim.diagnose.tried import composed
from boatsim.errors import BadInput, BadPhysics
from boatsim.files import replacing
from boatsim.physics.signals import COMPONENTS, STATE, Array
from boatsim.physics.vessel import Vessel
from boatsim.progress import Report
from boatsim.recordings.table import Notes, Recording, write_csv
from boatsim.simulate import scenario as scenarios
from boatsim.view.outputs import filling

WRITING = 0.97  # of a diagnosis is done when its files are written, by experience
FORCE_NAMES = {axis: f"force_{component}" for axis, component in COMPONENTS.items()}


def diagnose(
    runs: list[Path], hold_out: list[Path], vessel: str | None, load: list[str], out: Path, library: list[str],
    without: list[str], horizon: float | None = None,
) -> int:  # fmt: skip
    """Diagnose recordings and write diagnosis.json, report.html, report.md, patched.toml, diagnosis.rrd to `out`."""
    with reporting() as told:
        try:
            found = analyse(runs, hold_out, vessel, load, library, without, horizon, report=told)
        except BadInput as error:
            raise BadInput(f"{error}{hint(runs, hold_out, vessel, load)}") from None
        told("writing the report", WRITING)
        full = _unwritten(found, out)
    faults = [e for e in found.findings.answer.get("log", []) if e["kind"] == "fault"]
    for line in (*(f"{e['run']}: {words.strip()}" for e in faults for words in in_words(e)), *found.remarks):
        remark(line)
    if full:  # which does not cost the answer
        say(summary(found))
        raise full
    plan = [NEXT] if found.plan else []
    files = ["report.html", "report.md", "diagnosis.json", "patched.toml", *plan, "diagnosis.rrd"]
    say([*summary(found), f"written to {out}: {', '.join(files)}"])
    return 0


def _unwritten(found: Diagnosis, out: Path) -> OSError | None:
    """Write its files; what a full disk says."""
    try:
        write(found, out)
    except OSError as error:
        return error
    return None


def write(found: Diagnosis, out: Path) -> None:
    """All files of a diagnosis, or none."""
    try:
        answer = json.dumps(found.findings.answer, indent=1, allow_nan=False) + "\n"
    except ValueError:
        raise BadPhysics(
            f"{found.vessel.name}: a fitted boat diverges; are the units of the recording right?"
        ) from None
    with filling(out) as new:
        report.write(found.findings, new)
        laws = found.ranking.laws
        patched = patch.patched(found.problem, found.vessel, found.ranking.best, out / "patched.toml", laws)
        (new / "patched.toml").write_text(patched, encoding="utf-8")
        if found.plan is not None:
            (new / NEXT).write_text(scenario_text(found.plan, found.vessel), encoding="utf-8")
        overlay(found, new / "diagnosis.rrd")
        (new / "diagnosis.json").write_text(answer, encoding="utf-8")
    if found.plan is None:  # that of an earlier diagnosis
        (out / NEXT).unlink(missing_ok=True)


def summary(found: Diagnosis) -> list[str]:
    """What is printed of a diagnosis."""
    answer = found.findings.answer
    lines = [answer["sentence"]]
    for effect in answer["effects"]:
        lines.append(
            f"  {effect['name']}: gains {effect['gain_nats']:.1f} nats, probability {effect['probability']:.2f}"
        )
        lines += [f"    {k} = {p['value']:.4g} +- {p['sd']:.2g}" for k, p in effect["parameters"].items()]
    for law in answer["described"]:
        lines += [
            f"  described: {what_of(law['axis'])} that goes with {term['of']}: gains {term['gain_nats']:.1f} nats\n"
            f"    {term['value']:.4g} +- {term['sd']:.2g} {term['unit']}".rstrip()
            for term in law["terms"]
        ]
    lines += [f"  {line}" for line in taken.in_words(answer)]
    fit = answer["fit"]
    lines.append(f"free runs of {fit['horizon_s']:g} s on unseen data ({found.findings.held_out_note}):")
    families: dict[Family, tuple[str, float]] = {
        "position_rms_m": ("m", 1.0), "heading_rms_rad": ("deg", 57.29578), "roll_rms_rad": ("deg", 57.29578),
    }  # fmt: skip
    for key, (unit, scale) in families.items():
        if rms := fit.get(key):
            cells = ", ".join(f"{m} {rms[m] * scale:.4g}" for m in show.MODELS)
            lines.append(f"  {key.split('_')[0]} rms [{unit}]: {cells}")
    lines += stays.in_words(answer, found.findings.patched)
    if wanted := answer["next_experiment"]:
        names, nats = ", ".join(wanted["separates"]), wanted["expected_gain_nats"]
        lines.append(f"to record next: {wanted['manoeuvre']} (tells apart {names}; expected gain {nats:.3g} nats)")
    return lines


def overlay(found: Diagnosis, path: Path) -> None:
    """diagnosis.rrd: recorded, nominal, recalibrated and patched boats of the first unseen run on one time line."""
    from boatsim.view import rerun_log, water

    stretches = [s for s in found.findings.free_runs if s.run == found.findings.free_runs[0].run]
    boats = {m: [_of_model(s, m) for s in stretches] for m in show.MODELS} if stretches else {}
    if stretches:
        boats = {"recording": [_whole(stretches)], **boats}
    chosen = next((m for m in found.findings.missing if stretches and m.run == stretches[0].run), None)
    missing = None
    if chosen is not None:
        signals: dict[str, Array] = {}
        for axis, mean in chosen.force.items():
            name, sd = FORCE_NAMES[axis], chosen.sd[axis]
            signals |= {name: mean, f"{name}_low": mean - 2 * sd, f"{name}_high": mean + 2 * sd}
        missing = Recording(chosen.run, chosen.t, signals)
    scene = water.around(found.vessel, boats)
    intervals = [
        i for i in found.findings.answer["where"]["intervals"] if chosen is not None and i["run"] == chosen.run
    ]
    with replacing(path) as temporary:
        rerun_log.log_overlay(temporary, boats, missing, intervals, scene)


def _whole(stretches: Sequence[FreeRun]) -> Recording:
    """The recording under consecutive free runs, which share their ends."""
    t, rows = np.unique(np.concatenate([s.t for s in stretches]), return_index=True)
    names = stretches[0].channels["recorded"]
    joined = {n: np.concatenate([s.channels["recorded"][n] for s in stretches])[rows] for n in names}
    return Recording("recording", t, joined)


def _of_model(stretch: FreeRun, model: str) -> Recording:
    """A free run of one model, with its distance from the recording."""
    signals, recorded = dict(stretch.channels[model]), stretch.channels["recorded"]
    if {"x_m", "y_m"} <= signals.keys():
        off = np.hypot(signals["x_m"] - recorded["x_m"], signals["y_m"] - recorded["y_m"])
        seen = np.isfinite(off)  # fixes may be fewer than rows
        signals["off_m"] = np.interp(stretch.t, stretch.t[seen], off[seen]) if seen.any() else off
    return Recording(model, stretch.t, signals)


def replay(run: Path, vessel: str | None, load: list[str], horizon: float, out: Path) -> int:
    """Free runs of a vessel over a recording, driven by the recorded commands alone: replay.csv and rms errors."""
    with reporting() as told:
        told("reading the recording")
        recording, boat = open_recording(run, vessel, load)
        problem, fitted = _as_written(recording, boat, told)
        told("free runs", 0.8)
        stretches = free_runs(problem, {"simulated": fitted}, problem.tracks, horizon)
        if not stretches:
            seconds = recording.t[-1] - recording.t[0]
            raise BadInput(f"{run}: {seconds:g} s long; a free run of {horizon:g} s does not fit")
        _write_replay(stretches, out / "replay.csv")
    for line in recording.remarks:
        remark(line)
    for family, found in errors(stretches).items():
        say([f"{family}: {found['simulated']:.5g} ({len(stretches)} free runs of {horizon:g} s)"])
    say([f"written to {out}: replay.csv"])
    return 0


def _as_written(recording: Recording, boat: Vessel, told: Report) -> tuple[Problem, Fit]:
    """A vessel file on a recording, nothing fitted but the noise that the smoothed starts need."""
    told("compiling, or loading what was compiled before", 0.1)
    program, acting = composed(boat)
    levels = nominal_levels(boat, [recording])
    problem = Problem([begun(track(recording, program), levels)], levels, {})
    told("fitting the noise", 0.3)
    return problem, fit_noise(problem, replace(problem.nominal(), suspects=acting))


def _write_replay(stretches: Sequence[FreeRun], path: Path) -> None:
    """Columns t_s, segment, pose; times as in the recording."""
    names = list(stretches[0].channels["simulated"])
    with replacing(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        file.write(",".join(["t_s", "segment", *names]) + "\n")
        for i, s in enumerate(stretches):
            for k, t in enumerate(s.t):
                cells = ",".join(f"{s.channels['simulated'][n][k]:.9g}" for n in names)
                file.write(f"{t:.10g},{i},{cells}\n")


def compare(run: Path, vessel: str | None, load: list[str], scenario: str | None, out: Path) -> int:
    """A recording beside a simulation: of its own commands from its smoothed first state, or of a scenario.

    Where a run of ours says which scenario it is of, the scenario's effects act too, unless a vessel is named.
    """
    with reporting() as told:
        told("reading the recording")
        recording, boat = open_recording(run, vessel, load)
        if vessel is None and not scenario:
            boat = _as_it_was(recording, boat)
        if scenario:
            told(f"running {scenario}", 0.1)
            simulated = _of_scenario(recording, scenario)
        else:
            problem, fitted = _as_written(recording, boat, told)
            told("the free run", 0.8)
            whole = float(recording.t[-1] - recording.t[0])
            simulated = free_runs(problem, {"simulated": fitted}, problem.tracks, whole)[0].channels["simulated"]
    for line in recording.remarks:
        remark(line)
    signals: dict[str, Array] = {}
    lines = [f"{'signal':10s} {'rms error':>12s} {'largest':>12s}   of a range of"]
    for name, value in simulated.items():
        off = value - recording.signals[name]
        signals |= {f"recorded_{name}": recording.signals[name], f"simulated_{name}": value, f"error_{name}": off}
        reach = float(np.nanmax(recording.signals[name]) - np.nanmin(recording.signals[name]))
        lines.append(f"{name:10s} {_rms(off):12.5g} {np.nanmax(np.abs(off)):12.5g}   {reach:.5g}")
    with filling(out) as new:
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
    if (found.file, found.freedoms) != (boat.file, boat.freedoms):
        remark(f"compared with the vessel alone; its scenario {name} is of another one, {found.name}")
        return boat
    added = [e for e in found.effects if boat.effect(e.name) is None]
    if added:
        remark(f"{name} adds {', '.join(e.name for e in added)}; --vessel {boat.name} compares with the vessel alone")
    seeded = tuple(e.seeded(seed) for e in found.effects) if isinstance(seed, int) else found.effects
    return replace(found, effects=seeded)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def _of_scenario(recording: Recording, name: str) -> dict[str, Array]:
    """A scenario's own run at the times of a recording."""
    from boatsim.simulate.run import run

    log = run(scenarios.load(name)).recording
    if recording.t[0] > log.t[-1]:
        raise BadInput(f"{name} ends at {log.t[-1]:g} s, before {recording.name} begins ({recording.t[0]:g} s)")
    shared = [s.column for s in STATE if s.column in recording.signals and s.column in log.signals]
    return {n: np.interp(recording.t, log.t, log.signals[n], right=np.nan) for n in shared}


def _compare_rrd(boat: Vessel, recording: Recording, simulated: Mapping[str, Array], path: Path) -> None:
    from boatsim.view import rerun_log, water

    measured = Recording("recording", recording.t, {n: recording.signals[n] for n in simulated})
    boats = {"recording": [measured], "simulated": [Recording("simulated", recording.t, dict(simulated))]}
    with replacing(path) as temporary:
        rerun_log.log_overlay(temporary, boats, None, [], water.around(boat, boats))
