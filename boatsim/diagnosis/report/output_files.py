"""All files of a diagnosis: report, answer, patched vessel, next experiment, and the boats in rerun."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.diagnosis.experiment_design.next_experiment import scenario_text
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.pipeline import NEXT, Diagnosis
from boatsim.diagnosis.report import before_after, patched_vessel
from boatsim.diagnosis.report import page as report
from boatsim.errors import BadPhysics
from boatsim.files import replacing
from boatsim.physics.signals import COMPONENTS, Array
from boatsim.recordings.table import Recording

FORCE_NAMES = {axis: f"force_{component}" for axis, component in COMPONENTS.items()}


def write(found: Diagnosis, out: Path) -> None:
    """All files of a diagnosis, or none."""
    try:
        answer = json.dumps(found.findings.answer, indent=1, allow_nan=False) + "\n"
    except ValueError:
        raise BadPhysics(
            f"{found.vessel.name}: a fitted boat diverges; are the units of the recording right?"
        ) from None
    with atomic_folder(out) as new:
        report.write(found.findings, new)
        laws = found.ranking.laws
        patched = patched_vessel.patched(
            found.problem, found.vessel, found.ranking.best, out / "patched.toml", laws
        )
        (new / "patched.toml").write_text(patched, encoding="utf-8")
        if found.plan is not None:
            (new / NEXT).write_text(scenario_text(found.plan, found.vessel), encoding="utf-8")
        overlay(found, new / "diagnosis.rrd")
        (new / "diagnosis.json").write_text(answer, encoding="utf-8")
    if found.plan is None:  # that of an earlier diagnosis
        (out / NEXT).unlink(missing_ok=True)


def overlay(found: Diagnosis, path: Path) -> None:
    """diagnosis.rrd: recorded, nominal, recalibrated and patched boats of the first unseen run on one time line."""
    from boatsim.view import rerun_log, water

    stretches = [s for s in found.findings.free_runs if s.run == found.findings.free_runs[0].run]
    boats = (
        {m: [_of_model(s, m) for s in stretches] for m in before_after.MODELS} if stretches else {}
    )
    if stretches:
        boats = {"recording": [_whole(stretches)], **boats}
    chosen = next(
        (m for m in found.findings.missing if stretches and m.run == stretches[0].run), None
    )
    missing = None
    if chosen is not None:
        signals: dict[str, Array] = {}
        for axis, mean in chosen.force.items():
            name, sd = FORCE_NAMES[axis], chosen.sd[axis]
            signals |= {name: mean, f"{name}_low": mean - 2 * sd, f"{name}_high": mean + 2 * sd}
        missing = Recording(chosen.run, chosen.t, signals)
    scene = water.around(found.vessel, boats)
    intervals = [
        i
        for i in found.findings.answer["where"]["intervals"]
        if chosen is not None and i["run"] == chosen.run
    ]
    with replacing(path) as temporary:
        rerun_log.log_overlay(temporary, boats, missing, intervals, scene)


def _whole(stretches: Sequence[FreeRun]) -> Recording:
    """The recording under consecutive free runs, which share their ends."""
    t, rows = np.unique(np.concatenate([s.t for s in stretches]), return_index=True)
    names = stretches[0].channels["recorded"]
    joined = {
        n: np.concatenate([s.channels["recorded"][n] for s in stretches])[rows] for n in names
    }
    return Recording("recording", t, joined)


def _of_model(stretch: FreeRun, model: str) -> Recording:
    """A free run of one model, with its distance from the recording."""
    signals, recorded = dict(stretch.channels[model]), stretch.channels["recorded"]
    if {"x_m", "y_m"} <= signals.keys():
        off = np.hypot(signals["x_m"] - recorded["x_m"], signals["y_m"] - recorded["y_m"])
        seen = np.isfinite(off)  # fixes may be fewer than rows
        signals["off_m"] = np.interp(stretch.t, stretch.t[seen], off[seen]) if seen.any() else off
    return Recording(model, stretch.t, signals)
