"""Check for positions that are older than the headings in the same row, or the opposite.

The delay is removed from the recordings, and the vessel model with refitted coefficients must then
explain them far better than as recorded, where it may also have effects that look alike: lags of
the drives, other forces in sway, an antenna that is not at the mass centre.

Each file has its own clock. One delay of all files is compared with one delay per file, and
each further delay must add evidence.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

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
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.errors import BadInput
from boatsim.physics.base import Array
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
class _Delays:
    """Delays of some columns, and the log likelihood or evidence with them [nats].

    Attributes:
        name: Name of the finding, a key of `COLUMNS`.
        seconds: Delay of each recording [s]; 0: it is on time.
        value: Log likelihood or evidence [nats].
        further: Number of delays beyond one that were chosen.
    """

    name: str
    seconds: tuple[float, ...]
    value: float
    further: int = 0

    @property
    def changes(self) -> list[tuple[Change, ...]]:
        """Changes of each recording that remove its delay."""
        found = []
        for delay in self.seconds:
            if delay > 0.0:
                found.append(delay_corrections(COLUMNS[self.name][0], delay))
            else:
                found.append(())
        return found

    def lead(self, lead_per_delay: float) -> float:
        """Value less a lead that each further delay must add [nats]."""
        return self.value - lead_per_delay * self.further


def check_late_sensors(recordings: Sequence[Recording], problem: Problem) -> list[Finding]:
    """Find positions that are late against the headings, or headings against the positions.

    Args:
        recordings: Prepared and cleaned recordings.
        problem: The problem with the vessel as specified; its configuration is used.

    Returns:
        A finding "late_positions" or "late_heading" for each file that is late, with its own
        delay; a remark of kind "unchecked" if the comparison fails.
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
            suspects = _likeliest_delays(compared, step)
            if not suspects:
                return []
            return _findings(compared, suspects, step)
    except (BadInput, np.linalg.LinAlgError, FloatingPointError) as error:
        return [unchecked_finding("whether positions or headings are late", error)]


def _likeliest_delays(compared: FaultComparison, step: float) -> list[_Delays]:
    """The likeliest delay of all files and delays per file, before any refit, if they gain enough.

    The noise levels are those of the recordings as they are.
    """
    recorded = compared.problem_with_changes(())
    fitted = fit_noise(recorded, recorded.nominal_hypothesis())
    config = recorded.config.checks
    stride = _stride(compared, step)
    base = _log_likelihoods(recorded, fitted)
    if not np.isfinite(base).all():  # the vessel does not follow the log, late or not
        return []
    common, own = list[_Delays](), list[_Delays]()
    for name in COLUMNS:
        delays, values = _likelihoods_of_delays(compared, name, fitted, step)
        common.append(_common_delay(name, delays, values))
        own.append(_own_delays(name, delays, values, compared))
    lead = config.compare_min_lead
    longest = compared.lost - 2.0 * step
    one = max(common, key=lambda each: each.value)
    several = max(own, key=lambda each: each.value)
    found = []
    if one.value - base.sum() >= lead and max(one.seconds) <= longest:
        found.append(one)
    differ = bool(np.ptp(several.seconds) > stride)
    better = several.lead(lead) > max(one.value, float(base.sum()))
    if differ and better and max(several.seconds) <= longest:
        found.append(several)
    return found


def _stride(compared: FaultComparison, step: float) -> float:
    """Distance of the delays that are compared first [s]."""
    return max(step, _shortest_delay(compared))


def _shortest_delay(compared: FaultComparison) -> float:
    """Smallest delay that is reported [s]; smaller ones look like many other effects."""
    problem = compared.problem
    return problem.config.checks.late_min_delay * froude_time_scale(problem.program.vessel)


def _likelihoods_of_delays(
    compared: FaultComparison, name: str, fit: Fit, step: float
) -> tuple[Array, Array]:
    """Delays (K,) [s] of columns, of which the first is 0, and log likelihoods (K, R) [nats]."""
    stride = _stride(compared, step)
    delays, rows = list[float](), list[Array]()
    for multiple in np.arange(0.0, compared.lost + 1e-9, stride).tolist():
        seconds = step * round(multiple / step)
        changes = delay_corrections(COLUMNS[name][0], seconds)
        delays.append(seconds)
        rows.append(_log_likelihoods(compared.problem_with_changes(changes), fit))
    values = np.array(rows)
    return np.array(delays), np.where(np.isfinite(values), values, -np.inf)


def _log_likelihoods(problem: Problem, fit: Fit) -> Array:
    """Log likelihood (R,) [nats] of each recording with the values of a fit without effects."""
    on = problem.program.effect_switches()
    found = []
    for mapped in problem.recordings:
        one = problem.with_recordings([mapped])
        found.append(one.log_likelihood(fit.free, fit.theta, on, fit.levels))
    return np.array(found)


def _common_delay(name: str, delays: Array, values: Array) -> _Delays:
    """The likeliest delay (K,) of all recordings, whose log likelihoods are (K, R) [nats]."""
    total = values.sum(axis=1)
    best = int(np.argmax(total))
    seconds = (float(delays[best]),) * values.shape[1]
    return _Delays(name, seconds, float(total[best]))


def _own_delays(name: str, delays: Array, values: Array, compared: FaultComparison) -> _Delays:
    """The likeliest delay (K,) of each file, with log likelihoods (K, R) [nats] of recordings."""
    lead = compared.problem.config.checks.compare_min_lead
    seconds, value = np.zeros(values.shape[1]), 0.0
    clocks = _recordings_by_file(compared.recordings)
    for members in clocks:
        total = values[:, members].sum(axis=1)
        best = int(np.argmax(total))
        if total[best] - total[0] < lead:
            best = 0
        seconds[members] = delays[best]
        value += float(total[best])
    return _Delays(name, tuple(seconds.tolist()), value, len(clocks) - 1)


def _recordings_by_file(recordings: Sequence[Recording]) -> list[list[int]]:
    """Places of the recordings of each file; the parts of a file have one clock."""
    found = dict[str, list[int]]()
    for place, recording in enumerate(recordings):
        found.setdefault(recording.origin, []).append(place)
    return list(found.values())


def _findings(compared: FaultComparison, suspects: Sequence[_Delays], step: float) -> list[Finding]:
    """Findings of delays that explain the recordings better than all other effects."""
    config = compared.problem.config.checks
    lead = config.compare_min_lead
    unchanged = fit_without_effects(compared.problem_with_changes(())).evidence
    refined = []
    for suspect in suspects:
        fit = _refit(compared, suspect)
        if fit.evidence > unchanged:  # else the other coefficients explain it as well
            refined.append(_refined_delays(compared, suspect, fit, step))
    further = len(_recordings_by_file(compared.recordings)) - 1
    for one in list(refined):
        if further and not one.further:
            several = replace(one, further=further)
            refined.append(_refined_own_delays(compared, several, _refit(compared, one), step))
    if not refined:
        return []
    best = max(refined, key=lambda each: each.lead(lead))
    least = _shortest_delay(compared) - 0.01 * step  # steps of recorded times are rounded
    if max(best.seconds) < least or best.lead(lead) - unchanged < lead:
        return []
    program = compared.program_with_rivals(RIVALS)
    enough = best.value + compared.required_gain
    rival = best_rival(compared.problem_with_changes((), program), config, enough)
    patched = fit_with_rival_effects(
        compared.problem_with_own_changes(best.changes, program), rival, rival.effects
    )
    gain = max(patched.evidence, best.value) - lead * best.further - rival.evidence
    if gain < compared.required_gain:
        return []
    found = []
    for members in _recordings_by_file(compared.recordings):
        first = members[0]
        if best.seconds[first] >= least:
            run = compared.recordings[first].origin
            found.append(_finding(best, best.seconds[first], run, gain, compared.problem))
    return found


def _finding(best: _Delays, seconds: float, run: str, gain: float, problem: Problem) -> Finding:
    """The finding of the delay of a file, with the evidence [nats] for all delays together."""
    columns, others = COLUMNS[best.name]
    names = ", ".join(columns)
    verb = "are" if len(columns) > 1 else "is"
    without, name = "this delay", problem.program.vessel.name
    if best.further:
        without = "the delays of the recordings, which differ"
    return Finding(
        best.name,
        f"{names} {verb} {seconds:.3g} s older than {others} in the same row. Without {without}, "
        f"{name} with refitted coefficients fits the log better ({format_odds(gain)})",
        probability=problem.config.checks.probability_strong,
        changes=delay_corrections(columns, seconds),
        words=f"{names} {verb} late",
        run=run,
        of_run_only=best.further > 0,
    )


def _refit(compared: FaultComparison, delays: _Delays) -> Fit:
    """The fit of the coefficients to recordings without their delays."""
    return fit_without_effects(compared.problem_with_own_changes(delays.changes))


def _refined_delays(compared: FaultComparison, first: _Delays, fit: Fit, step: float) -> _Delays:
    """The delays of the largest evidence with refitted coefficients, to a step of the rows."""
    best = replace(first, value=float(fit.evidence))
    if first.further:
        return _refined_own_delays(compared, best, fit, step)
    for way in (-step, step):
        while 0.5 * step < best.seconds[0] + way < compared.lost:
            seconds = (best.seconds[0] + way,) * len(best.seconds)
            moved = replace(best, seconds=seconds)
            moved = replace(moved, value=float(_refit(compared, moved).evidence))
            if moved.value <= best.value:
                break
            best = moved
    return best


def _refined_own_delays(
    compared: FaultComparison, first: _Delays, fit: Fit, step: float
) -> _Delays:
    """Delays per file, improved with fixed coefficients and with refitted ones in turn."""
    best = first
    while True:
        delays, values = _likelihoods_of_delays(compared, best.name, fit, step)
        moved = _own_delays(best.name, delays, values, compared)
        moved = _improved_delays(compared, moved, fit, step)
        if moved.seconds == best.seconds:
            return best
        fit = _refit(compared, moved)
        if not fit.evidence > best.value:
            return best
        best = replace(moved, value=float(fit.evidence))


def _improved_delays(compared: FaultComparison, start: _Delays, fit: Fit, step: float) -> _Delays:
    """The likeliest delays with fixed coefficients: with these, files are independent."""
    files = _recordings_by_file(compared.recordings)
    seconds = np.array(start.seconds)
    late = seconds > 0.0

    def likelihoods(own: Array) -> Array:
        delays = replace(start, seconds=tuple(own.tolist()))
        each = _log_likelihoods(compared.problem_with_own_changes(delays.changes), fit)
        return np.array([each[members].sum() for members in files])

    best = likelihoods(seconds)
    for way in (-step, step):
        moves = late.copy()
        while moves.any():
            beside = np.where(moves, seconds + way, seconds)
            moves &= (beside > 0.5 * step) & (beside < compared.lost)
            beside = np.where(moves, beside, seconds)
            values = likelihoods(beside)
            for place, members in enumerate(files):
                if moves[members[0]] and values[place] > best[place]:
                    seconds[members] = beside[members]
                    best[place] = values[place]
                else:
                    moves[members] = False
    return replace(start, seconds=tuple(seconds.tolist()))
