"""Check for commands in per cent whose numbers lie within the range of the channel in newtons.

Such a log can be read in both units. In newtons the boat seems to have another thrust ahead and
another one astern, and a diagnosis would name a weak reverse.
"""

from collections.abc import Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from boatsim.diagnosis.checks.finding import Change, Finding, unchecked_finding
from boatsim.diagnosis.checks.rivals import (
    FaultComparison,
    best_rival,
    fit_with_rival_effects,
    fit_without_effects,
)
from boatsim.diagnosis.config import ChecksConfig
from boatsim.diagnosis.problem import Problem
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.view.formatting import format_odds

# Effects that make commands in newtons look like per cent, and others of the thrust: each changes
# the thrust for a command, as another unit does. Settings are numbers, so that this list of names
# is no setting.
RIVALS = ("weak_reverse", "thrust_deadband", "thrust_imbalance", "thrust_lag")
FULL = 100.0  # [per cent]


def check_per_cent_commands(recordings: Sequence[Recording], problem: Problem) -> list[Finding]:
    """Find thrusts that are recorded in per cent of full thrust, although they fit as newtons.

    The numbers must look like per cent, and the vessel must move as these per cent say, better than
    in newtons with a weak reverse.

    Args:
        recordings: Prepared and cleaned recordings.
        problem: The problem with the vessel as specified; its configuration is used.

    Returns:
        One finding "command_unit", or none; a remark of kind "unchecked" if the comparison fails.
    """
    config = problem.config.checks
    vessel = problem.program.vessel
    channels = _thrusts(recordings, vessel)
    if not channels or not _look_like_per_cent(recordings, channels, config):
        return []
    if not any(_has_other_scale(vessel, name, config) for name in channels):
        return []
    changes = []
    for name in channels:
        command = vessel.commands[name]
        ahead, astern = command.high / FULL, -command.low / FULL
        changes.append(Change(name, name, ahead, factor_below=astern))
    compared = FaultComparison(recordings, problem)
    try:
        with threadpool_limits(1, "blas"):
            converted = fit_without_effects(compared.problem_with_changes(changes))
            recorded = fit_without_effects(compared.problem_with_changes(()))
            gain = converted.evidence - recorded.evidence
            if gain < config.compare_min_lead:
                return []
            program = compared.program_with_rivals(RIVALS)
            newtons = best_rival(compared.problem_with_changes((), program), config, np.inf)
            others = [name for name in newtons.effects if name != RIVALS[0]]
            per_cent = fit_with_rival_effects(
                compared.problem_with_changes(changes, program), newtons, others
            )
    except (BadInput, np.linalg.LinAlgError, FloatingPointError) as error:
        return [unchecked_finding("whether the thrusts are in per cent", error)]
    best = max(per_cent.evidence, converted.evidence)
    if RIVALS[0] not in newtons.effects or best - newtons.evidence < config.per_cent_min_lead:
        return []
    names = ", ".join(channels)
    verb = "are" if len(channels) > 1 else "is"
    return [
        Finding(
            "command_unit",
            f"{names} {verb} within -100 to 100 and may be in per cent of full thrust. Read so, "
            f"{vessel.name} fits the log better ({format_odds(gain)}); in newtons the boat "
            "would have another thrust ahead and a weak reverse",
            probability=config.probability_possible,
            changes=tuple(changes),
            words=f"{names} {verb} in per cent",
        )
    ]


def _thrusts(recordings: Sequence[Recording], vessel: Vessel) -> list[str]:
    """Thrusts of the vessel in newtons that all recordings have and that go astern too."""
    found = []
    for name, command in vessel.commands.items():
        recorded = all(name in recording.signals for recording in recordings)
        if recorded and unit_of(name) == "N" and command.low < 0.0 < command.high:
            if np.isfinite(command.low) and np.isfinite(command.high):
                found.append(name)
    return found


def _look_like_per_cent(
    recordings: Sequence[Recording], channels: Sequence[str], config: ChecksConfig
) -> bool:
    """Whether all values are within 100 and are rounded as per cent are."""
    values: Array = np.concatenate([r[name] for r in recordings for name in channels])
    values = values[np.isfinite(values)]
    largest = float(np.abs(values).max(initial=0.0))
    if not config.percent_min_command <= largest <= FULL * (1.0 + 1e-6):
        return False
    if len(np.unique(values)) < config.per_cent_min_levels:
        return False
    tenths = 10.0 * values
    rounded = np.abs(tenths - np.round(tenths)) < 1e-6
    return bool(rounded.mean() >= config.per_cent_min_rounded)


def _has_other_scale(vessel: Vessel, name: str, config: ChecksConfig) -> bool:
    """Whether per cent and newtons of a channel differ, and differently ahead and astern."""
    command = vessel.commands[name]
    ratio = command.high / -command.low
    return max(ratio, 1.0 / ratio) > config.per_cent_min_ratio
