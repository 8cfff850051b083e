"""Check for positions that are older than the headings in the same row, or the opposite.

The delay is removed from the recording, and the vessel model with refitted coefficients must then
explain the recording far better than as recorded, where it may also have effects that look alike:
lags of the drives, other forces in sway, an antenna that is not at the mass centre.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.candidates import program_with_candidates
from boatsim.diagnosis.checks.finding import Change, Finding, apply_changes, delay_changes
from boatsim.diagnosis.checks.initial_actuator_state import with_initial_actuators
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.filter import map_recording, prior_levels
from boatsim.diagnosis.fit import converge, unfitted_hypothesis
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.priors import froude_time
from boatsim.diagnosis.problem import Fit, Problem, free_parameter_values
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.errors import BadInput
from boatsim.recordings.table import Recording

# Effects that make a log on time look late
RIVALS = (
    "position_frame_error",
    "lateral_centre_shift",
    "sway_yaw_coupling",
    "mass_centre_shift",
    "added_mass_error",
    "thrust_lag",
    "command_delay",
    "steering_rate_limit",
    "weak_reverse",
    "thrust_imbalance",
    "quadratic_damping",
    "current",
    "wind",
)
LATE_COLUMNS = {"late_positions": ("x_m", "y_m"), "late_heading": ("psi_rad",)}


@dataclass(frozen=True)
class _Delay:
    """A delay of some columns, and the log evidence with it [nats]."""

    name: str
    seconds: float
    evidence: float

    @property
    def changes(self) -> tuple[Change, ...]:
        return delay_changes(LATE_COLUMNS[self.name], self.seconds)


class _Comparison:
    """Estimation problems of recordings without a delay, over the rows that all delays leave."""

    def __init__(self, recordings: Sequence[Recording], problem: Problem, longest: float) -> None:
        self.recordings, self.problem, self.longest = recordings, problem, longest
        self.levels = prior_levels(problem.program.vessel, recordings, problem.config)

    def on(self, problem: Problem, name: str, seconds: float) -> Problem:
        """Return the problem of the recordings without a delay. Raises BadInput."""
        mapped = []
        for recording in self.recordings:
            changed = recording
            if seconds:
                changed = apply_changes(recording, delay_changes(LATE_COLUMNS[name], seconds))
            part = changed.between(recording.t[0] + 1e-6, recording.t[-1] - self.longest)
            one = map_recording(part, problem.program)
            mapped.append(with_initial_actuators(one, self.levels))
        return problem.on(mapped)


def check_late_sensors(recordings: Sequence[Recording], problem: Problem) -> list[Finding]:
    """Find positions that are late against the headings, or headings against the positions.

    Args:
        recordings: Prepared and cleaned recordings.
        problem: The problem with the vessel as specified; its configuration is used.

    Returns:
        One finding "late_positions" or "late_heading", or none.
    """
    config = problem.config.checks
    vessel = problem.program.vessel
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        return []
    for recording in recordings:
        if not {"x_m", "y_m", "psi_rad"} <= recording.signals.keys():
            return []
    scale = froude_time(vessel)
    step = max(float(np.median(np.diff(recording.t))) for recording in recordings)
    longest = config.late_max_delay * scale
    shortest = min(float(np.ptp(recording.t)) for recording in recordings)
    if shortest < config.late_min_durations * longest:
        return []
    compared = _Comparison(recordings, problem, longest)
    rows = sum(map(len, recordings))
    required = max(config.compare_min_gain, config.compare_min_gain_per_row * rows)
    try:
        least = max(config.late_min_delay * scale, step)
        suspect = _likeliest_delay(compared, step, least, required)
        if suspect is None:
            return []
        return _test(compared, suspect, step, required)
    except (BadInput, np.linalg.LinAlgError, FloatingPointError):
        return []


def _likeliest_delay(
    compared: _Comparison, step: float, least: float, required: float
) -> _Delay | None:
    """The delay with the largest likelihood before any refit; None if it gains too little.

    The noise levels are those of the recording as it is.
    """
    problem = compared.problem
    recorded = compared.on(problem, "late_positions", 0.0)
    nominal = recorded.nominal_hypothesis()
    levels = fit_noise(recorded, nominal).levels
    on = problem.program.switches()

    def log_likelihood(name: str, seconds: float) -> float:
        changed = compared.on(problem, name, seconds)
        value = changed.log_likelihood(nominal.free, nominal.theta, on, levels)
        return value if np.isfinite(value) else -np.inf

    base = log_likelihood("late_positions", 0.0)
    best = _Delay("", 0.0, base)
    for name in LATE_COLUMNS:
        stride = max(step, least)
        for seconds in np.arange(stride, compared.longest + 1e-9, stride).tolist():
            seconds = step * round(seconds / step)
            value = log_likelihood(name, seconds)
            if value > best.evidence:
                best = _Delay(name, seconds, value)
    if best.evidence - base < required or best.seconds > compared.longest - 2.0 * step:
        return None
    return best


def _test(compared: _Comparison, suspect: _Delay, step: float, required: float) -> list[Finding]:
    """The finding of a delay that explains the recording better than all other effects."""
    config = compared.problem.config.checks
    vessel = compared.problem.program.vessel
    best = _refined_delay(compared, suspect, step)
    _, recorded = fit_baseline(compared.on(compared.problem, best.name, 0.0))
    if best.evidence - recorded.evidence < required:
        return []
    program = program_with_candidates(vessel, RIVALS)
    first = compared.problem
    problem = Problem(
        [map_recording(r, program) for r in compared.recordings],
        compared.levels,
        first.uncertainty,
        None,
        first.config,
    )
    rival = _best_rival(compared.on(problem, best.name, 0.0), config)
    without = compared.on(problem, best.name, best.seconds)
    patched = converge(without, _initial_fit(without, rival))
    _, plain = fit_baseline(without)
    gain = max(patched.evidence, plain.evidence) - rival.evidence
    if gain < required:
        return []
    columns = LATE_COLUMNS[best.name]
    others = "psi_rad" if best.name == "late_positions" else "x_m, y_m"
    verb = "are" if len(columns) > 1 else "is"
    return [
        Finding(
            best.name,
            f"{', '.join(columns)} {verb} {best.seconds:.3g} s older than {others} in the same "
            f"row. Without this delay, the log is more likely by {gain:.0f} nats on "
            f"{vessel.name} with refitted coefficients",
            probability=config.probability_strong,
            changes=best.changes,
            words=f"{', '.join(columns)} {verb} late",
        )
    ]


def _refined_delay(compared: _Comparison, suspect: _Delay, step: float) -> _Delay:
    """The delay of the largest evidence with refitted coefficients, to a step of the rows."""

    def fitted(seconds: float) -> _Delay:
        _, found = fit_baseline(compared.on(compared.problem, suspect.name, seconds))
        return _Delay(suspect.name, seconds, found.evidence)

    best = fitted(suspect.seconds)
    for way in (-1.0, 1.0):
        while step / 2.0 < best.seconds + way * step < compared.longest:
            beside = fitted(best.seconds + way * step)
            if beside.evidence <= best.evidence:
                break
            best = beside
    return best


def _best_rival(problem: Problem, config: ChecksConfig) -> Fit:
    """The vessel with the effects that explain the recording as it is, added one by one."""
    _, best = fit_baseline(problem)
    left = [name for name in RIVALS if name in problem.program.candidate_names]
    for _ in range(config.late_max_rivals):
        fits: dict[str, Fit] = {}
        for name in left:
            fits[name] = converge(problem, _with_effect(problem, best, name))
        if not fits:
            break
        name = max(fits, key=lambda each: fits[each].evidence)
        if not fits[name].evidence > best.evidence + config.late_rival_gain:
            break
        best = fits[name]
        left.remove(name)
    return best


def _with_effect(problem: Problem, best: Fit, name: str) -> Fit:
    effects = (*best.effects, name)
    free = problem.parameters(effects)
    return unfitted_hypothesis(
        effects, free, free_parameter_values(free, best.values()), best.levels
    )


def _initial_fit(problem: Problem, rival: Fit) -> Fit:
    """The effects of a rival on another recording, before a fit."""
    free = problem.parameters(rival.effects)
    values = free_parameter_values(free, rival.values())
    return unfitted_hypothesis(rival.effects, free, values, rival.levels)
