"""Implementation of `boatsim diagnose`, `replay` and `compare`."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import print_lines, print_note, print_notes
from boatsim.cli.progress import report_stages
from boatsim.diagnosis.answer.compose import NEXT_SCENARIO
from boatsim.diagnosis.answer.log_entry import finding_lines
from boatsim.diagnosis.checks.data_cleaning import drop_faulty_values
from boatsim.diagnosis.config import from_settings
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.diagnosis.loading import open_recording, open_recording_parts
from boatsim.diagnosis.log_check import correction_hint
from boatsim.diagnosis.output.files import write_diagnosis
from boatsim.diagnosis.output.what_if import collect_what_if
from boatsim.diagnosis.pipeline import diagnose as analyse
from boatsim.diagnosis.replay import fit_noise_only, free_run_columns, replay_recording
from boatsim.diagnosis.report.sentences import console_lines
from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.physics.native.declarations import NotTranslatable
from boatsim.physics.signals import STATE, Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Notes, Recording, write_csv
from boatsim.simulate import scenario as scenarios
from boatsim.sweeps.diagnoses import DiagnosisOptions
from boatsim.webassembly.compiler import NoWasmCompiler, find_compiler

# Shares of the work done when these stages start, by experience.
WRITING = 0.97
RUNNING = 0.1
FREE_RUN = 0.8


def diagnose(runs: list[Path], options: DiagnosisOptions, out: Path, what_if: bool = False) -> int:
    """Diagnose recordings together: identify missing effects, write the report, print a summary.

    Args:
        runs: Recordings.
        options: Options of the diagnosis.
        out: Output folder of diagnosis.json, report.html, report.md, patched.toml, diagnosis.rrd.
        what_if: Whether report.html repeats free runs while sliders move.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument or a recording is wrong, or there is no compiler for sliders. Where
            the compiler fails on this vessel, all files are written nevertheless, without sliders.
        OSError: The report cannot be written; the summary is printed nevertheless.
    """
    compiler = find_compiler() if what_if else None  # before the long work
    held_out = list(map(Path, options.hold_out))
    load = list(options.load)
    with report_stages() as report:
        try:
            found = analyse(
                runs,
                held_out,
                options.vessel,
                load,
                list(options.library),
                list(options.without),
                options.horizon,
                report=report,
                config=from_settings(dict(options.settings)),
            )
        except BadInput as error:
            raise BadInput(
                f"{error}{correction_hint(runs, held_out, options.vessel, load)}"
            ) from None
        report("writing the report", WRITING)
        section, compiler_error, write_error = None, None, None
        if compiler is not None:
            try:
                section = collect_what_if(found, compiler)
            except (NotTranslatable, NoWasmCompiler) as error:
                compiler_error = error
        try:
            write_diagnosis(found, out, section)
        except OSError as error:
            write_error = error
    for entry in found.findings.answer.get("log", []):
        if entry["kind"] == "fault":
            for line in finding_lines(entry):
                print_note(f"{entry['run']}: {line.strip()}")
    print_notes(found.remarks)
    print_lines(console_lines(found.findings))
    if write_error:
        raise write_error
    files = ["report.html", "report.md", "diagnosis.json", "patched.toml"]
    if found.plan:
        files.append(NEXT_SCENARIO)
    files.append("diagnosis.rrd")
    print_lines([f"written to {out}: {', '.join(files)}"])
    if compiler_error:
        raise compiler_error
    if what_if and section is None:
        print_note("the report has no sliders, because there is no free run to repeat")
    return 0


def replay(run: Path, vessel: str | None, load: list[str], horizon: float, out: Path) -> int:
    """Compare a recording with free runs of its vessel; write replay.csv and print rms errors.

    Args:
        run: Recording.
        vessel: Vessel; None for the one that recording.toml names.
        load: Load conditions.
        horizon: Length of each free run [s].
        out: Output folder.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument or the recording is wrong.
    """
    with report_stages() as report:
        report("reading the recording")
        parts, boat = open_recording_parts(run, vessel, load)
        stretches, remarks = list[FreeRun](), list[str]()
        for part in parts:
            cleaned = drop_faulty_values(part, boat)
            remarks += cleaned.remarks
            stretches += replay_recording(cleaned, boat, horizon, report)
    print_notes(tuple(dict.fromkeys(remarks)))
    _write_replay(stretches, out / "replay.csv")
    for family, found in rms_errors(stretches).items():
        count = f"{len(stretches)} free runs of {horizon:g} s"
        print_lines([f"{family}: {found['simulated']:.5g} ({count})"])
    print_lines([f"written to {out}: replay.csv"])
    return 0


def _write_replay(stretches: Sequence[FreeRun], path: Path) -> None:
    """Write all rows of each free run, also where the ends of two share a time."""
    table = free_run_columns(stretches)
    formats = ["%.10g", *["%.9g"] * (len(table) - 1)]  # times as in the recording
    rows = np.column_stack(list(table.values()))
    with replace_file(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        np.savetxt(file, rows, formats, ",", header=",".join(table), comments="")


def compare(run: Path, vessel: str | None, load: list[str], scenario: str | None, out: Path) -> int:
    """Compare a recording with a simulation; write compare.csv and compare.rrd.

    Without a scenario, the simulation starts from the smoothed first state of the recording and
    applies the recorded commands. If the recording names the scenario it came from, the effects of
    that scenario act too, unless a vessel or a load is given.

    Args:
        run: Recording.
        vessel: Vessel; None for the one that recording.toml names.
        load: Load conditions.
        scenario: Scenario to compare with; None for the recorded commands.
        out: Output folder.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument or the recording is wrong.
    """
    with report_stages() as report:
        report("reading the recording")
        recording, boat = open_recording(run, vessel, load)
        recording = drop_faulty_values(recording, boat)
        if vessel is None and not load and not scenario:
            boat = _add_scenario_effects(recording, boat)
        if scenario:
            report(f"running {scenario}", RUNNING)
            simulated = _simulate_scenario(recording, scenario)
        else:
            problem, fitted = fit_noise_only(recording, boat, report)
            report("the free run", FREE_RUN)
            duration = float(recording.t[-1] - recording.t[0])
            stretches = free_runs(problem, {"simulated": fitted}, problem.recordings, duration)
            simulated = stretches[0].channels["simulated"]
    print_notes(recording.remarks)
    signals: dict[str, Array] = {}
    lines = [f"{'signal':10s} {'rms error':>12s} {'largest':>12s}   range of the signal"]
    for name, value in simulated.items():
        recorded = recording.signals[name]
        error = value - recorded
        signals[f"recorded_{name}"] = recorded
        signals[f"simulated_{name}"] = value
        signals[f"error_{name}"] = error
        rms = np.sqrt(np.nanmean(error**2))
        span = np.nanmax(recorded) - np.nanmin(recorded)
        lines.append(f"{name:10s} {rms:12.5g} {np.nanmax(np.abs(error)):12.5g}   {span:.5g}")
    with atomic_folder(out) as new:
        write_csv(Recording(recording.name, recording.t, signals, Notes()), new / "compare.csv")
        _write_compare_rrd(boat, recording, simulated, new / "compare.rrd")
    print_lines([*lines, f"written to {out}: compare.csv, compare.rrd"])
    return 0


def _add_scenario_effects(recording: Recording, boat: Vessel) -> Vessel:
    """The vessel with the effects of the recording's scenario, if that scenario can be used."""
    name = recording.notes.facts.get("scenario")
    if not isinstance(name, str):
        return boat
    vessel_alone = "compared with the vessel alone; its scenario"
    try:
        found = scenarios.load(name).vessel
    except BadInput as error:
        print_note(f"{vessel_alone} {name} cannot be used: {error}")
        return boat
    if (found.file, found.dof) != (boat.file, boat.dof):
        print_note(f"{vessel_alone} {name} is of another vessel, {found.name}")
        return boat
    added = [effect.name for effect in found.effects if boat.effect(effect.name) is None]
    if added:
        if Path(name).is_file():
            name = min(name, os.path.relpath(name), key=len)
        print_note(
            f"{name} adds {', '.join(added)}; --vessel {boat.name} compares with the vessel alone"
        )
    seed = recording.notes.facts.get("seed")
    if not isinstance(seed, int):
        return found
    return replace(found, effects=tuple(effect.with_seed(seed) for effect in found.effects))


def _simulate_scenario(recording: Recording, name: str) -> dict[str, Array]:
    """Signals of a run of a scenario at the times of a recording."""
    from boatsim.simulate.run import run

    log = run(scenarios.load(name)).recording
    if recording.t[0] > log.t[-1]:
        raise BadInput(
            f"{name} ends at {log.t[-1]:g} s, before {recording.name} starts ({recording.t[0]:g} s)"
        )
    signals = {}
    for signal in STATE:
        column = signal.column
        if column in recording.signals and column in log.signals:
            signals[column] = np.interp(recording.t, log.t, log.signals[column], right=np.nan)
    return signals


def _write_compare_rrd(
    boat: Vessel, recording: Recording, simulated: Mapping[str, Array], path: Path
) -> None:
    from boatsim.view import rerun_log, water

    measured = {name: recording.signals[name] for name in simulated}
    boats = {
        "recording": [Recording("recording", recording.t, measured)],
        "simulated": [Recording("simulated", recording.t, dict(simulated))],
    }
    with replace_file(path) as temporary:
        rerun_log.write_diagnosis_log(
            temporary, boats, None, [], water.comparison_scene(boat, boats)
        )
