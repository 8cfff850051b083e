"""Comparison of a log as recorded with its reinterpretations, each fitted to the vessel.

Nothing is compared if the vessel explains the log: if the unexplained force is a small share of
the force of the drives, and the bow points along the course. A reinterpretation is accepted only if
the log becomes far more likely than as recorded and than under any other reinterpretation, and if
simulations with the recorded commands follow it better. The coefficients are refitted in all cases.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis.checks.finding import (
    Change,
    Finding,
    apply_corrections,
    apply_corrections_to_all,
    corrected_columns,
    scaling_corrections,
    unchecked_finding,
)
from boatsim.diagnosis.checks.holes import part_before_first_hole
from boatsim.diagnosis.checks.reinterpretations import (
    Reinterpretation,
    heading_disagrees_with_course,
    heading_offset_hypothesis,
    reinterpretations,
)
from boatsim.diagnosis.checks.steering_sense import commands_with_corrected_sign
from boatsim.diagnosis.config import ChecksConfig, DiagnosisConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.free_runs import free_run_horizon, free_runs, rms_errors
from boatsim.diagnosis.locate import nominal_forces
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.output_error.errors import MODEL, output_errors
from boatsim.diagnosis.output_error.fit import fit_to_free_runs
from boatsim.diagnosis.priors import downsampling_rate
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording
from boatsim.view.formatting import format_number, format_odds

PLANAR_AXES = ("surge", "sway", "yaw")
MAX_LEAD = 50.0  # [nats] limit of an exponent
POSITION_FIX, BY_SATELLITES = "position_fix", "gnss"  # fact and its value
MapRecording = Callable[[Recording], MappedRecording]


class Score(NamedTuple):
    """How well a vessel model with refitted coefficients explains a recording.

    The log evidence in nats, and the unexplained force as a share of the force of the drives.
    """

    evidence: float  # [nats], coefficients refitted
    unexplained: float  # unexplained force as a share of the force of the drives
    error: Exception | None = None  # why the recording could not be fitted


_Scored = tuple[Reinterpretation, Score]


@dataclass(frozen=True)
class Comparison:
    """Compares interpretations of recordings by how well a vessel model explains each of them.

    An interpretation is a set of changes of columns, such as another sign of the heading. Holds the
    vessel's estimation problem, and the function that maps a recording to the vessel's program.
    """

    problem: Problem
    map_recording: MapRecording
    config: ChecksConfig

    def problem_with_changes(
        self, recordings: Sequence[Recording], changes: Sequence[Change] = ()
    ) -> Problem:
        """Return the estimation problem of recordings whose columns are changed.

        Raises:
            BadInput: A changed recording cannot be mapped to the vessel.
        """
        changed = apply_corrections_to_all(recordings, changes)
        return self.problem.with_recordings(list(map(self.map_recording, changed)))

    def goodness_of_fit(self, recordings: Sequence[Recording], changes: Sequence[Change]) -> Score:
        """Return how well the vessel model explains recordings whose columns are changed.

        The coefficients of the vessel are refitted. The log evidence is minus infinity if the
        changed recordings cannot be fitted; the score then has the error.
        """
        try:
            problem = self.problem_with_changes(recordings, changes)
            _, recalibrated = fit_baseline(problem)
        except (BadInput, np.linalg.LinAlgError, FloatingPointError) as error:
            return Score(-np.inf, np.inf, error)
        return Score(recalibrated.evidence, unexplained_force_share(problem, recalibrated))

    def simulations_agree(self, recordings: Sequence[Recording], changes: Sequence[Change]) -> bool:
        """Whether free runs follow recordings better if their columns are changed.

        A vessel model that is far from the truth may make a wrong interpretation likelier from
        sample to sample. The coefficients are fitted to the free runs in both cases.

        Args:
            recordings: Prepared recordings.
            changes: The changes.
        """
        recorded = self._simulation_errors(self.problem_with_changes(recordings))
        changed = self._simulation_errors(self.problem_with_changes(recordings, changes))
        if not recorded.keys() <= changed.keys():  # a simulation with the changes diverges
            return False
        logs = [np.log(changed[family] / recorded[family]) for family in recorded]
        if not logs:
            return True
        return bool(np.mean(logs) < -np.log(self.problem.config.simulate.better))

    def _simulation_errors(self, problem: Problem) -> dict[str, float]:
        """Rms errors of free runs of the vessel fitted to them; those that diverge are left out."""
        horizon = free_run_horizon(problem, problem.recordings)
        start = fit_baseline(problem).recalibrated
        errors = output_errors(problem, start, problem.recordings, horizon)
        found = fit_to_free_runs(errors, start).model
        runs = free_runs(problem, {MODEL: found}, problem.recordings, horizon)
        found_errors = {family: rms[MODEL] for family, rms in rms_errors(runs).items()}
        return {family: rms for family, rms in found_errors.items() if 0.0 < rms < np.inf}

    def is_explained(self, problem: Problem) -> bool:
        """Whether the vessel model as specified explains the recordings of an estimation problem.

        Only the noise levels are fitted. The unexplained force must be a small share of the force
        of the drives.
        """
        nominal = fit_noise(problem, problem.nominal_hypothesis())
        return unexplained_force_share(problem, nominal) < self.config.unexplained_max_share


def compare_reinterpretations(
    recordings: Sequence[Recording], map_recording: MapRecording, problem: Problem
) -> list[Finding]:
    """Find faults of recordings by comparing how well a vessel model explains corrected versions.

    Examples are other axes, a heading of opposite sense and exchanged drives. The coefficients of
    the vessel are refitted to each version, and the log evidence decides.

    Args:
        recordings: Prepared and cleaned recordings.
        map_recording: Function that maps a recording to the program of the problem.
        problem: The problem with the vessel as specified; its configuration is used.

    Returns:
        Findings; a second fault is sought after the first is corrected. Last come remarks of kind
        "unchecked" on versions that could not be fitted.

    Raises:
        BadInput: A recording cannot be mapped to the vessel.
    """
    config = problem.config.checks
    vessel = problem.program.vessel
    comparison = Comparison(problem, map_recording, config)
    short = _shortened(recordings, vessel, problem.config)
    with threadpool_limits(1, "blas"):
        explained = comparison.is_explained(comparison.problem_with_changes(short))
        if explained and not heading_disagrees_with_course(recordings, vessel, config):
            return []
        return _find_faults(list(map(_with_recorded_rudder, short)), comparison)


def unexplained_force_share(problem: Problem, fit: Fit) -> float:
    """Return the rms of the unexplained force relative to the rms force of the drives.

    The largest ratio over surge, sway and yaw is returned.

    Args:
        problem: The problem with its recordings.
        fit: A fit of the vessel model; the rms of its latent (unmodelled) force counts as
            unexplained.

    Returns:
        The ratio; 0 for a vessel without drives.
    """
    vessel = problem.program.vessel
    axes = dof_in_state_order(vessel)
    config = problem.config.checks
    drives = np.zeros(len(axes))
    for recording in problem.recordings:
        drives = np.maximum(drives, _drive_force(recording, config.unexplained_rows))
    thrust = 0.0
    for axis, force in zip(axes, drives.tolist(), strict=True):
        if axis in ("surge", "sway"):
            thrust = max(thrust, force)
    if not thrust > 0.0:
        return 0.0
    least_moment = config.unexplained_min_lever * thrust * vessel.length
    largest = 0.0
    for i, axis in enumerate(axes):
        if axis in PLANAR_AXES:
            scale = max(float(drives[i]), least_moment) if axis == "yaw" else thrust
            largest = max(largest, float(fit.levels.force[i]) / scale)
    return largest


def _per_cent(share: float) -> str:
    return f"{format_number(100.0 * share, 2)} %"


def _drive_force(recording: MappedRecording, rows: int) -> Array:
    """(axes,) rms force of the drives on the vessel at rest, over about so many rows."""
    step = max(1, len(recording.times) // rows)
    held = nominal_forces.actuator_states(recording)[::step]
    rest = np.zeros((len(held), 2 * recording.program.module.NQ))
    forces = nominal_forces.body_forces(recording, rest, held, recording.values)
    return np.asarray(np.sqrt(np.mean(forces**2, axis=0)))


def _shortened(
    recordings: Sequence[Recording], vessel: Vessel, config: DiagnosisConfig
) -> list[Recording]:
    """The first rows of the first recordings, which suffice because a fault concerns all rows.

    Recordings with separate rows for each instrument are reduced to the usual rate first.
    """
    runs = list(recordings)[: config.checks.compare_max_recordings]
    usual = downsampling_rate(vessel, config=config.load)
    rows = config.checks.compare_max_rows // len(runs)
    short = []
    for run in runs:
        excess = len(run) / float(run.t[-1] - run.t[0]) / usual
        if excess > config.checks.compare_max_rate:
            run = run.thinned(usual / excess)
        run = part_before_first_hole(run, vessel, config.checks)
        short.append(run.between(float(run.t[0]), float(run.t[min(len(run), rows) - 1])))
    return short


def _with_recorded_rudder(recording: Recording) -> Recording:
    """The recording with the rudder signs of its file."""
    return apply_corrections(
        recording, scaling_corrections(commands_with_corrected_sign(recording), -1.0)
    )


def _find_faults(recordings: list[Recording], comparison: Comparison) -> list[Finding]:
    found: list[Finding] = []
    remarks: list[Finding] = []
    corrected: tuple[Change, ...] = ()
    for _ in range(comparison.config.compare_max_faults):
        current = apply_corrections_to_all(recordings, corrected)
        finding, unfitted = _best_finding(current, comparison)
        remarks += [remark for remark in unfitted if remark not in remarks]
        if finding is None:
            break
        found.append(finding)
        if corrected_columns(finding.changes) & corrected_columns(corrected):
            break
        corrected = (*corrected, *finding.changes)
        if comparison.is_explained(comparison.problem_with_changes(current, finding.changes)):
            break
    return [*found, *remarks]


def _best_finding(
    recordings: list[Recording], comparison: Comparison
) -> tuple[Finding | None, list[Finding]]:
    """The finding for the best reinterpretation, if it is clearly better than the log as recorded.

    The second result holds remarks on what could not be fitted.
    """
    candidates = _likeliest(recordings, comparison)
    if not candidates:
        return None, []
    remarks = []
    recorded = comparison.goodness_of_fit(recordings, ())
    if recorded.error is not None:
        question = "whether the columns have another meaning than the recorded one"
        remarks.append(unchecked_finding(question, recorded.error))
    scored = []
    for candidate in candidates:
        score = comparison.goodness_of_fit(recordings, candidate.changes)
        if score.error is not None:
            remarks.append(unchecked_finding(f"whether {candidate.words}", score.error))
        if np.isfinite(score.evidence):
            scored.append((candidate, score))
    if not scored or not np.isfinite(recorded.evidence):
        return None, remarks
    return _clear_finding(scored, recorded, recordings, comparison), remarks


def _clear_finding(
    scored: list[_Scored],
    recorded: Score,
    recordings: list[Recording],
    comparison: Comparison,
) -> Finding | None:
    """The finding for the best of some fitted reinterpretations, if it is clearly better.

    It must be better than the log as recorded. Other reinterpretations that fit about as well are
    its alternatives.
    """
    config = comparison.config
    best = max(score.evidence for _, score in scored)
    ties, rivals = list[_Scored](), list[_Scored]()
    second = recorded.evidence
    for candidate, score in _without_near_rotations(scored, config):
        behind = best - score.evidence
        if behind < config.compare_tie_gain:
            ties.append((candidate, score))
        elif behind < config.compare_min_lead:
            rivals.append((candidate, score))
        else:
            second = max(second, score.evidence)
    rows = sum(map(len, recordings))
    gain = best - recorded.evidence
    required = max(config.compare_min_gain, config.compare_min_gain_per_row * rows)
    if gain < required or best - second < config.compare_min_lead:
        return None
    by_satellites = _positions_are_by_satellites(recordings)
    if by_satellites:
        ties.sort(key=lambda each: each[0].moves_positions)  # stable
    chosen, score = ties[0]
    if not comparison.simulations_agree(recordings, chosen.changes):
        return None
    if chosen.name == "heading_turned":
        chosen = _refined_rotation(chosen, recordings, comparison)
    vessel = comparison.problem.program.vessel.name
    evidence = [f"{chosen.words}. With this correction, {vessel} with refitted coefficients"]
    evidence.append(f" fits the log better ({format_odds(gain)})")
    if score.unexplained < recorded.unexplained:
        evidence.append(
            f". The unexplained force is {_per_cent(score.unexplained)} of the force of the "
            f"drives instead of {_per_cent(recorded.unexplained)}"
        )
    others = []
    for candidate, _ in ties[1:]:
        others += [(candidate.words, candidate.changes), *candidate.alternatives]
    if others:
        evidence.append(
            f". Because this boat is symmetric, another fault fits equally well: {others[0][0]}"
        )
        evidence.append(_evidence_of_satellites(ties, by_satellites))
    rivals.sort(key=lambda each: -each[1].evidence)
    if rivals and not others:
        evidence.append(f". Another fault fits almost as well: {rivals[0][0].words}")
    others += [(candidate.words, candidate.changes) for candidate, _ in rivals]
    lead = min(best - second, MAX_LEAD)
    return Finding(
        chosen.name,
        "".join(evidence),
        probability=1.0 - float(np.exp(-lead / config.compare_lead_scale)),
        changes=chosen.changes,
        alternatives=(*chosen.alternatives, *others),
        words=chosen.words,
    )


def _positions_are_by_satellites(recordings: Sequence[Recording]) -> bool:
    """Whether the notes on all recordings state that a satellite receiver measured the positions.

    An import from latitudes and longitudes states it. Its positions count north and east, so that
    they are mirrored only if another program has changed them.
    """
    return all(one.notes.facts.get(POSITION_FIX) == BY_SATELLITES for one in recordings)


def _evidence_of_satellites(ties: Sequence[_Scored], by_satellites: bool) -> str:
    """A sentence on tied faults by the kind of receiver; "" if all or none change positions."""
    if len({candidate.moves_positions for candidate, _ in ties}) < 2:
        return ""
    if by_satellites:
        return (
            ", but it is less likely: a satellite receiver measured the positions, which counts "
            "north and east"
        )
    return (
        ". The log does not show which: if a satellite receiver measured the positions, the "
        "drives are the likelier fault"
    )


def _without_near_rotations(scored: list[_Scored], config: ChecksConfig) -> list[_Scored]:
    """Drop rotations of the heading near a better one, because they are no rivals of it."""
    limit = np.radians(config.rotation_min_distance)
    kept: list[_Scored] = []
    rotations: list[float] = []
    for candidate, score in sorted(scored, key=lambda each: -each[1].evidence):
        if candidate.name == "heading_turned":
            angle = candidate.changes[0].offset
            distances = np.abs(np.angle(np.exp(1j * (angle - np.array(rotations)))))
            if not (distances > limit).all():
                continue
            rotations.append(angle)
        kept.append((candidate, score))
    return sorted(kept, key=scored.index)


def _likeliest(recordings: list[Recording], comparison: Comparison) -> list[Reinterpretation]:
    """The reinterpretations that are more likely than the log as recorded, before any refit.

    The noise levels are those of the log as recorded. If the heading may be rotated, the likeliest
    of many rotations is included.
    """
    config = comparison.config
    problem = comparison.problem_with_changes(recordings)
    nominal = problem.nominal_hypothesis()
    levels = fit_noise(problem, problem.nominal_hypothesis()).levels
    on = problem.program.effect_switches()

    def log_likelihood_with_changes(each: Reinterpretation) -> float:
        try:
            changed = comparison.problem_with_changes(recordings, each.changes)
        except BadInput:
            return -np.inf
        value = changed.log_likelihood(nominal.free, nominal.theta, on, levels)
        return value if np.isfinite(value) else -np.inf

    candidates = reinterpretations(recordings, problem.program.vessel, config)
    if any(each.name == "heading_turned" for each in candidates):
        step = config.rotation_coarse_step
        angles = np.arange(-180.0 + step, 180.0 + 0.5 * step, step)
        rotations = np.radians(angles[angles % 90.0 != 0.0]).tolist()
        candidates.append(
            max(map(heading_offset_hypothesis, rotations), key=log_likelihood_with_changes)
        )
    scores = {each.words: log_likelihood_with_changes(each) for each in candidates}
    recorded = log_likelihood_with_changes(Reinterpretation("as recorded", "", ()))
    better = [each for each in candidates if scores[each.words] > recorded]
    better.sort(key=lambda each: -scores[each.words])
    return sorted(better[: config.compare_max_candidates], key=candidates.index)


def _refined_rotation(
    rotation: Reinterpretation, recordings: list[Recording], comparison: Comparison
) -> Reinterpretation:
    """The rotation of the heading to a degree: the maximum of a parabola through three angles.

    A result near a quarter turn is replaced by the quarter turn.
    """
    config = comparison.config
    step = config.rotation_step
    steps = step * np.arange(-config.rotation_steps, config.rotation_steps + 1)
    angles = np.degrees(rotation.changes[0].offset) + steps
    scores = []
    for angle in angles:
        changes = heading_offset_hypothesis(float(np.radians(angle))).changes
        scores.append(comparison.goodness_of_fit(recordings, changes).evidence)
    top = int(np.clip(np.argmax(scores), 1, len(steps) - 2))
    near = slice(top - 1, top + 2)
    curvature, slope, _ = np.polyfit(steps[near], scores[near], 2)
    best = angles[top]
    if curvature < 0.0:
        best = angles[top] - steps[top] - 0.5 * slope / curvature
    quarter = 90.0 * np.round(best / 90.0)
    if abs(best - quarter) < config.rotation_quarter_tolerance:
        best = quarter
    return heading_offset_hypothesis(float(np.radians(np.round(best))))
