"""Output files of a diagnosis: report, answer, patched vessel, next experiment, and rerun scene."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.diagnosis.answer.compose import NEXT_SCENARIO
from boatsim.diagnosis.answer.findings import Findings, MissingForceCurve
from boatsim.diagnosis.experiment_design.next_experiment import scenario_text
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS, MODELS
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.pipeline import Diagnosis
from boatsim.diagnosis.report import page
from boatsim.diagnosis.report.figures import BAND, group_by_recording
from boatsim.diagnosis.report.what_if import WhatIf
from boatsim.errors import BadPhysics
from boatsim.files import replace_file
from boatsim.physics.signals import COMPONENTS, Array
from boatsim.recordings.table import Recording

FORCE_NAMES = {axis: f"force_{component}" for axis, component in COMPONENTS.items()}


def write_diagnosis(found: Diagnosis, out: Path, what_if: WhatIf | None = None) -> None:
    """Write all output files of a diagnosis (report, diagnosis.json, patched vessel), or none.

    Args:
        found: The diagnosis.
        out: Folder of the files.
        what_if: Content of the section of the report that repeats free runs; None for none.

    Raises:
        BadPhysics: A fitted vessel diverges, so that the answer has numbers that are not finite.
        OSError: The files cannot be written.
    """
    try:
        answer = json.dumps(found.findings.answer, indent=1, allow_nan=False) + "\n"
    except ValueError:
        raise BadPhysics(
            f"{found.vessel.name}: a fitted vessel diverges; are the units of the recording right?"
        ) from None
    with atomic_folder(out) as new:
        page.write_report(found.findings, new, what_if)
        best, laws = found.ranking.best, found.ranking.described_terms
        patched = patched_vessel.patched_vessel_text(
            found.problem, found.vessel, best, out / "patched.toml", laws
        )
        (new / "patched.toml").write_text(patched, encoding="utf-8")
        if found.plan is not None:
            (new / NEXT_SCENARIO).write_text(
                scenario_text(found.plan, found.vessel), encoding="utf-8"
            )
        write_rerun_scene(found, new / "diagnosis.rrd")
        (new / "diagnosis.json").write_text(answer, encoding="utf-8")
    if found.plan is None:
        (out / NEXT_SCENARIO).unlink(missing_ok=True)  # of an earlier diagnosis


def write_rerun_scene(found: Diagnosis, path: Path) -> None:
    """Write diagnosis.rrd, a rerun scene of the first held-out recording with its simulations.

    Args:
        found: The diagnosis.
        path: Path of the file diagnosis.rrd.
    """
    from boatsim.view import rerun_log, water

    boats: dict[str, list[Recording]] = {}
    missing, intervals = None, []
    if found.findings.free_runs:
        runs = group_by_recording(found.findings.free_runs)[0]
        boats["recording"] = [_joined(runs)]
        for model in MODELS:
            boats[MODEL_WORDS[model]] = [_simulated(r, model) for r in runs]
        missing = _missing_force(found.findings, runs[0].run)
        if missing is not None:
            flagged = found.findings.answer["where"]["intervals"]
            intervals = [i for i in flagged if i["run"] == missing.name]
    scene = water.comparison_scene(found.vessel, boats)
    with replace_file(path) as temporary:
        rerun_log.write_diagnosis_log(temporary, boats, missing, intervals, scene)


def _missing_force(findings: Findings, run: str) -> Recording | None:
    """Return the missing force of a recording with its band; None if it is not known."""
    for m in findings.missing:
        if m.run == run:
            return Recording(m.run, m.t, _with_band(m))
    return None


def _with_band(m: MissingForceCurve) -> dict[str, Array]:
    signals: dict[str, Array] = {}
    for axis, force in m.force.items():
        name, sd = FORCE_NAMES[axis], m.sd[axis]
        signals[name] = force
        signals[f"{name}_low"] = force - BAND * sd
        signals[f"{name}_high"] = force + BAND * sd
    return signals


def _joined(runs: Sequence[FreeRun]) -> Recording:
    """Return the recording under consecutive free runs, which share their first and last rows."""
    t, rows = np.unique(np.concatenate([r.t for r in runs]), return_index=True)
    joined = {}
    for name in runs[0].channels["recorded"]:
        joined[name] = np.concatenate([r.channels["recorded"][name] for r in runs])[rows]
    return Recording("recording", t, joined)


def _simulated(run: FreeRun, model: str) -> Recording:
    """Return a free run of one model with its distance from the recording."""
    signals, recorded = dict(run.channels[model]), run.channels["recorded"]
    if {"x_m", "y_m"} <= signals.keys():
        off = np.hypot(signals["x_m"] - recorded["x_m"], signals["y_m"] - recorded["y_m"])
        seen = np.isfinite(off)  # position fixes may be rarer than rows
        signals["off_m"] = off
        if seen.any():
            signals["off_m"] = np.interp(run.t, run.t[seen], off[seen])
    return Recording(model, run.t, signals)
