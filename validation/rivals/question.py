"""One trial as a textbook method sees it: recordings, program and candidates; and its answer."""

import contextlib
import io
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.cli import diagnosis as commands
from boatsim.control.base import wrap
from boatsim.diagnosis import priors
from boatsim.diagnosis.answer.parameters import parameter_key
from boatsim.diagnosis.candidates import candidate_library, name_without_prefixes
from boatsim.diagnosis.checks.position_outliers import drop_position_outliers
from boatsim.diagnosis.checks.repeated_values import drop_repeated_values
from boatsim.diagnosis.loading import open_recording
from boatsim.diagnosis.output import patched_vessel
from boatsim.diagnosis.prior_noise import prior_noise_levels, shared_noise
from boatsim.diagnosis.problem import Fit, FreeParameter, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics.base import Array, Effect
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from validation.entry import horizon_of, vessel_of

LEAST_SD = 1e-9  # smallest reported sd of a parameter


@dataclass(frozen=True)
class Question:
    """Recordings of a trial and the candidates that may be named."""

    vessel: Vessel
    problem: Problem
    entries: dict[str, Effect]  # candidates of this vessel that are not stochastic
    noise: dict[str, float]  # by family, estimated from the recordings [m, rad]
    # free parameters of hypotheses, cached
    known: dict[tuple[str, ...], tuple[FreeParameter, ...]] = field(default_factory=dict)

    def start(self) -> Array:
        """Return the nominal coefficients."""
        return np.array([f.mean for f in self.problem.free_parameters(())])


def read_question(trial: Path) -> Question:
    """Return the question of one trial.

    Rows, noise and candidates are those of the diagnosis, without stochastic forces.
    """
    opened = [open_recording(trial / f"run_{i}.csv", vessel_of(trial), ()) for i in (1, 2)]
    vessel = opened[0][1]
    runs = []
    for r, b in opened:
        runs.append(
            drop_position_outliers(drop_repeated_values(r.thinned(priors.downsampling_rate(b))), b)
        )
    columns = sorted({c for r in runs for c in r.signals})
    library = candidate_library(vessel, (), runs[0].notes.facts, columns)
    program = Program(vessel, library.compiled_effects)
    stated = shared_noise(vessel, runs)
    tracks = [map_recording(r, program, stated) for r in runs]
    uncertainty = priors.coefficient_uncertainty(vessel) | runs[0].notes.coefficient_uncertainty
    problem = Problem(tracks, prior_noise_levels(vessel, runs), uncertainty)
    entries = {}
    for e in library.entries:
        if e.name in library.tested_names and not type(e).random:
            entries[e.name] = e
    families = {f for t in tracks for f in t.families}
    noise = {f: priors.estimate_sensor_noise(vessel, runs, f) or stated[f] for f in families}
    return Question(vessel, problem, entries, noise)


def free_parameters(question: Question, effects: tuple[str, ...]) -> tuple[FreeParameter, ...]:
    """Return the free parameters: the nominal coefficients, then those of the effects."""
    if effects not in question.known:
        question.known[effects] = question.problem.free_parameters(effects)
    return question.known[effects]


def as_diagnosis_fit(
    question: Question, effects: tuple[str, ...], theta: Array, covariance: Array
) -> Fit:
    """Return the fit in the form of the diagnosis, for the patched vessel."""
    problem = question.problem
    return Fit(effects, free_parameters(question, effects), theta, covariance, problem.ambient, 0.0)


def write_answer(
    question: Question, found: Fit, gains: dict[str, float], unknown: bool, trial: Path, out: Path
) -> None:
    """Write diagnosis.json, patched.toml and replay.csv of one trial."""
    out.mkdir(parents=True, exist_ok=True)
    patched_vessel.write_patched_vessel(
        question.problem, question.vessel, found, out / "patched.toml"
    )
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        commands.replay(trial / "run_3.csv", str(out / "patched.toml"), [], horizon_of(trial), out)
    said: dict[str, Any] = {
        "effects": [
            {
                "name": name_without_prefixes(n),
                "parameters": parameter_entries(question, found, n),
                "gain_nats": round(gains[n], 2),
            }
            for n in found.effects
        ],
        "unknown": {"flag": unknown},
    }
    (out / "diagnosis.json").write_text(json.dumps(said, indent=1) + "\n")


def parameter_entries(question: Question, found: Fit, entry: str) -> dict[str, dict[str, Any]]:
    """Return value, sd and unit of an effect's parameters by their names in answers."""
    kind = type(question.entries[entry])
    stated = {}
    for f in found.free:
        if f.effect == entry and not f.relative:
            value, sd = found.value(entry, f.name)
            unit = kind.params()[f.name].unit
            value = wrap(value) if unit == "rad" else value
            stated[parameter_key(f.name, unit)] = {
                "value": value,
                "sd": max(sd, LEAST_SD),
                "unit": unit,
            }
    return stated
