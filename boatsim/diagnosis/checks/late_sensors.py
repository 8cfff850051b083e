"""Check for positions that are older than the headings in the same row, or the opposite.

The delay is removed from the recordings, and the vessel model with refitted coefficients must then
explain them far better than as recorded, where it may also have effects that look alike: lags of
the drives, other forces in sway, an antenna that is not at the mass centre.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis.checks.finding import (
    Change,
    Finding,
    delay_corrections,
    unchecked_finding,
)
from boatsim.diagnosis.checks.rivals import (
    FaultComparison,
    best_rival,
    fit_with_rival_effects,
    fit_without_effects,
)
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.priors import froude_time_scale
from boatsim.diagnosis.problem import Problem
from boatsim.errors import BadInput
from boatsim.physics.signals import PLANAR_DOF
from boatsim.recordings.table import Recording
from boatsim.view.formatting import format_odds

# Effects that make a log on time look late: each shifts the motion against the commands or one
# signal against another, or changes the response of the hull. Settings are numbers, so that this
# list of names is no setting.
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
# Finding -> late columns, and the columns that are on time
COLUMNS = {
    "late_positions": (("x_m", "y_m"), "psi_rad"),
    "late_heading": (("psi_rad",), "x_m, y_m"),
}


@dataclass(frozen=True)
class _Delay:
    """A delay of some columns, and the log likelihood or evidence with it [nats]."""

    name: str
    seconds: float
    value: float

    @property
    def changes(self) -> tuple[Change, ...]:
        return delay_corrections(COLUMNS[self.name][0], self.seconds)


def check_late_sensors(recordings: Sequence[Recording], problem: Problem) -> list[Finding]:
    """Find positions that are late against the headings, or headings against the positions.

    Args:
        recordings: Prepared and cleaned recordings.
        problem: The problem with the vessel as specified; its configuration is used.

    Returns:
        One finding "late_positions" or "late_heading", or none; a remark of kind "unchecked" if
        the comparison fails.
    """
    config = problem.config.checks
    vessel = problem.program.vessel
    if not set(vessel.dof) >= PLANAR_DOF:
        return []
    for recording in recordings:
        if not {"x_m", "y_m", "psi_rad"} <= recording.signals.keys():
            return []
    longest = config.late_max_delay * froude_time_scale(vessel)
    shortest = min(float(np.ptp(recording.t)) for recording in recordings)
    if shortest < config.late_min_durations * longest:
        return []
    step = max(float(np.median(np.diff(recording.t))) for recording in recordings)
    compared = FaultComparison(recordings, problem, longest)
    try:
        with threadpool_limits(1, "blas"):
            suspect = _likeliest_delay(compared, step)
            if suspect is None:
                return []
            return _findings(compared, suspect, step)
    except (BadInput, np.linalg.LinAlgError, FloatingPointError) as error:
        return [unchecked_finding("whether positions or headings are late", error)]


def _likeliest_delay(compared: FaultComparison, step: float) -> _Delay | None:
    """The delay with the largest likelihood before any refit; None if it gains too little.

    The noise levels are those of the recordings as they are.
    """
    recorded = compared.problem_with_changes(())
    nominal = recorded.nominal_hypothesis()
    levels = fit_noise(recorded, nominal).levels
    on = recorded.program.effect_switches()
    config = recorded.config.checks
    stride = max(step, config.late_min_delay * froude_time_scale(recorded.program.vessel))
    base = recorded.log_likelihood(nominal.free, nominal.theta, on, levels)
    if not np.isfinite(base):  # the vessel does not follow the log, late or not
        return None
    best = _Delay("", 0.0, base)
    for name in COLUMNS:
        for seconds in np.arange(stride, compared.lost + 1e-9, stride).tolist():
            one = _Delay(name, step * round(seconds / step), 0.0)
            changed = compared.problem_with_changes(one.changes)
            value = changed.log_likelihood(nominal.free, nominal.theta, on, levels)
            if np.isfinite(value) and value > best.value:
                best = _Delay(name, one.seconds, value)
    at_the_end = best.seconds > compared.lost - 2.0 * step
    if not best.name or at_the_end or not best.value - base >= config.compare_min_lead:
        return None
    return best


def _findings(compared: FaultComparison, suspect: _Delay, step: float) -> list[Finding]:
    """The finding of a delay that explains the recordings better than all other effects."""
    config = compared.problem.config.checks
    vessel = compared.problem.program.vessel
    unchanged = fit_without_effects(compared.problem_with_changes(())).evidence
    first = _refitted_delay(compared, suspect.name, suspect.seconds)
    if not first.value > unchanged:  # the other coefficients explain it as well
        return []
    best = _refined_delay(compared, first, step)
    if best.value - unchanged < config.compare_min_lead:
        return []
    program = compared.program_with_rivals(RIVALS)
    enough = best.value + compared.required_gain
    rival = best_rival(compared.problem_with_changes((), program), config, enough)
    patched = fit_with_rival_effects(
        compared.problem_with_changes(best.changes, program), rival, rival.effects
    )
    gain = max(patched.evidence, best.value) - rival.evidence
    if gain < compared.required_gain:
        return []
    columns, others = COLUMNS[best.name]
    names = ", ".join(columns)
    verb = "are" if len(columns) > 1 else "is"
    return [
        Finding(
            best.name,
            f"{names} {verb} {best.seconds:.3g} s older than {others} in the same row. Without "
            f"this delay, {vessel.name} with refitted coefficients fits the log better "
            f"({format_odds(gain)})",
            probability=config.probability_strong,
            changes=best.changes,
            words=f"{names} {verb} late",
        )
    ]


def _refitted_delay(compared: FaultComparison, name: str, seconds: float) -> _Delay:
    """A delay with its evidence where the coefficients are refitted."""
    found = fit_without_effects(compared.problem_with_changes(_Delay(name, seconds, 0.0).changes))
    return _Delay(name, seconds, float(found.evidence))


def _refined_delay(compared: FaultComparison, first: _Delay, step: float) -> _Delay:
    """The delay of the largest evidence with refitted coefficients, to a step of the rows."""
    best = first
    for way in (-step, step):
        while 0.5 * step < best.seconds + way < compared.lost:
            beside = _refitted_delay(compared, first.name, best.seconds + way)
            if beside.value <= best.value:
                break
            best = beside
    return best
