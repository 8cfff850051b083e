"""Maps loaded recordings to one compiled program with all candidate effects."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.candidates import (
    CandidateLibrary,
    candidate_library,
    candidate_names_except,
    with_specified_position_drift,
    without_excluded_effects,
)
from boatsim.diagnosis.checks.initial_actuator_state import infer_initial_actuator_state
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import MappedRecording, NoiseLevels
from boatsim.diagnosis.loading import LoadedRecordings
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.near_track import small_track_fact
from boatsim.diagnosis.prior_noise import prior_noise_levels, relative_noise, shared_noise
from boatsim.diagnosis.problem import Problem, check_uncertain_coefficients
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.work import WorkCount
from boatsim.physics.facts import BEGIN
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording


@dataclass(frozen=True)
class RecordingMapper:
    """Maps recordings to the compiled programs of their vessels, with common noise levels."""

    programs: Mapping[Path | None, Program]  # by the file of a recording
    noise: Mapping[str, float]  # sensor noise that all recordings share, by family
    levels: NoiseLevels
    config: DiagnosisConfig
    filtered: WorkCount = field(default_factory=WorkCount)  # work done for all of them

    def __call__(
        self, recording: Recording, noise_ratio: Mapping[str, float] | None = None
    ) -> MappedRecording:
        """Return a recording mapped to the program of its vessel.

        Args:
            recording: A recording of one of the vessels.
            noise_ratio: Its noise in shared levels, by family.
        """
        program = self.programs[recording.path]
        mapped = map_recording(recording, program, self.noise, noise_ratio, self.config)
        mapped = replace(mapped, filtered=self.filtered)
        return infer_initial_actuator_state(mapped, self.levels, self.config.checks)


@dataclass(frozen=True)
class Question:
    """A complete diagnosis task: fitted and held-out recordings, priors and candidate effects."""

    problem: Problem
    held_out: tuple[MappedRecording, ...]
    map_recording: Callable[[Recording], MappedRecording]
    library: CandidateLibrary
    candidates: tuple[str, ...]  # names of the effects that are tested


def set_up_estimation_problem(
    loaded: LoadedRecordings,
    config: DiagnosisConfig = DEFAULT,
    done: WorkCount | None = None,
    *,
    with_candidates: bool = True,
) -> Question:
    """Set up the estimation problem of a diagnosis from recordings that have been read.

    The vessel is compiled with its candidate effects, and the recordings are mapped to the program.

    Args:
        loaded: Fitted and held-out recordings with their vessels.
        config: Settings of the diagnosis.
        done: Count of the work of the diagnosis so far, to which that of the problem is added;
            None: a new count.
        with_candidates: Whether the compiled program holds the candidates. Without them it has the
            same numbers for the vessel as specified, and compiles faster.

    Raises:
        BadInput: A column is missing, or a level or an uncertainty cannot be used.
    """
    first, vessel = loaded.fitted[0], loaded.vessel
    uncertainty = _uncertainty(loaded, vessel, config)
    facts = first.notes.facts
    columns = sorted({column for recording in loaded.fitted for column in recording.signals})
    recordings = [*loaded.fitted, *loaded.held_out]
    derived = small_track_fact(recordings, vessel, config.load)
    derived[BEGIN] = min(float(recording.t[0]) for recording in recordings)
    libraries, programs = dict[Path | None, CandidateLibrary](), dict[Path | None, Program]()
    for path, own in loaded.vessels.items():
        equal = _file_of_equal_vessel(own, loaded.vessels, programs)
        if equal:
            libraries[path], programs[path] = libraries[equal], programs[equal]
            continue
        known = with_specified_position_drift(without_excluded_effects(own, facts), facts)
        known_facts = {**facts, **derived}
        libraries[path] = candidate_library(known, loaded.library, known_facts, columns, config)
        candidates = libraries[path].compiled_effects if with_candidates else ()
        programs[path] = Program(known, candidates)
    levels = prior_noise_levels(vessel, loaded.fitted, config)
    noise = shared_noise(vessel, loaded.fitted, config)
    mapper = RecordingMapper(programs, noise, levels, config, done or WorkCount())
    fitted = [mapper(recording) for recording in loaded.fitted]
    held_out = []
    for recording in loaded.held_out:
        ratio = relative_noise(vessel, loaded.fitted, recording, config)
        held_out.append(mapper(recording, ratio))
    problem = Problem(fitted, levels, uncertainty, loaded.horizon, config)
    library = libraries[first.path]
    names = candidate_names_except(library, loaded.without)
    names = (*names, *problem.candidates_in_single_groups(names))
    return Question(problem, tuple(held_out), mapper, library, names)


def _file_of_equal_vessel(
    vessel: Vessel, vessels: Mapping[Path | None, Vessel], known: Mapping[Path | None, Program]
) -> Path | None:
    """File of a recording whose vessel is the same and has a program already; None if none has."""
    for path in known:
        if vessels[path] == vessel:
            return path
    return None


def _uncertainty(
    loaded: LoadedRecordings, vessel: Vessel, config: DiagnosisConfig
) -> dict[str, float]:
    """Relative prior sd of coefficients by kind. Raises BadInput."""
    uncertainty = priors.coefficient_uncertainty(vessel, config.load)
    where = f"{vessel.file.parent.name}/{vessel.file.name}: diagnosis"
    check_uncertain_coefficients(vessel, uncertainty, where)
    for recording in (*loaded.fitted, *loaded.held_out):
        specified = recording.notes.coefficient_uncertainty
        where = f"{recording.origin} by its recording.toml"
        check_uncertain_coefficients(loaded.vessels[recording.path], specified, where)
    return uncertainty | loaded.fitted[0].notes.coefficient_uncertainty


def compile_program(problem: Problem) -> None:
    """Compile the program of an estimation problem, or load it from the cache, before it is needed.

    The functions that a diagnosis calls are called once.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
    """
    nominal, on = problem.nominal_hypothesis(), problem.program.effect_switches()
    mapped = problem.recordings[0]
    values = problem.parameter_vector(mapped, nominal.free, nominal.theta)
    mapped.free_runs(values, on, problem.ambient, float(np.ptp(mapped.times)))
    rest = np.zeros((1, 2 * problem.program.module.NQ))
    held = nominal_forces.actuator_states(mapped)[:1]
    nominal_forces.body_forces(mapped, rest, held, mapped.values)
