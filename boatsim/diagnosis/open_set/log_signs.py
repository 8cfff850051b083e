"""Signs of a whole log that a cause outside the candidates acts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.locate.residual_structure import Structure, find_structure_held_out
from boatsim.diagnosis.noise_levels import fit_noise
from boatsim.diagnosis.open_set.refinement import refines_estimated_number
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.evidence import unexplained_evidence, unknown_cause_threshold
from boatsim.diagnosis.search.ranking import Ranking


@dataclass(frozen=True)
class LogSigns:
    """Statistics of the recordings as a whole that indicate a cause outside the candidate effects.

    Attributes:
        coefficient_shift: Rms distance of the nominal coefficients from the vessel file, in prior
            standard deviations.
        force_ratio: Largest ratio of the fitted to the assumed level of the latent force.
        unexplained: Evidence for a force beyond the assumed disturbance, as a share of the
            threshold of an unknown cause.
        structure_gain: Evidence of the largest dependence of the remaining force on motion,
            commands, place or time [nats].
        effects_gain: Evidence that all identified effects gain together [nats].
        effects: Number of identified effects, without those that only refine an estimated number of
            the vessel file.
        held_out_unexplained: The same share as `unexplained` on held-out recordings, to which no
            parameter was fitted.
        held_out_structure: Evidence of the largest such dependence on held-out recordings [nats],
            beyond what the uncertainty of the parameters explains.
        held_out_structured: Whether that dependence is significant.
        unexplained_gain: Evidence for a force beyond the assumed disturbance [nats].
        structured: Whether the dependence with the evidence `structure_gain` is significant.
        estimated: Whether the vessel file calls any of its numbers estimated.
    """

    coefficient_shift: float
    force_ratio: float
    unexplained: float
    structure_gain: float
    effects_gain: float
    effects: int
    held_out_unexplained: float = 0.0
    held_out_structure: float = 0.0
    held_out_structured: bool = False
    unexplained_gain: float = 0.0
    structured: bool = False
    estimated: bool = False


NO_STRUCTURE = Structure("", "", 0.0, 1.0, 0, False)
# where nothing was fitted
NO_SIGNS = LogSigns(0.0, 1.0, 0.0, 0.0, 0.0, 0)


def unknown_cause_indicators(
    problem: Problem, ranking: Ranking, held_out: Sequence[MappedRecording]
) -> LogSigns:
    """Return statistics that indicate a cause which no candidate effect describes.

    They are computed from the recordings as a whole, after the selection of effects.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection of effects.
        held_out: Held-out recordings, which no fit has used.
    """
    best = ranking.best
    threshold = unknown_cause_threshold(problem.config.select, ranking.explained)
    missing = [e for e in ranking.named if not refines_estimated_number(problem, best, e.name)]
    remains, structure = _of_held_out(problem, best, held_out)
    return LogSigns(
        _coefficient_shift(best),
        float(np.max(best.levels.force / problem.ambient.force)),
        float(ranking.left_over / threshold),
        float(ranking.structure.gain),
        float(best.evidence - ranking.recalibrated.evidence),
        len(missing),
        remains / threshold,
        structure.gain,
        structure.significant,
        float(ranking.left_over),
        ranking.structure.significant,
        bool(problem.program.vessel.estimated),
    )


def _of_held_out(
    problem: Problem, best: Fit, held_out: Sequence[MappedRecording]
) -> tuple[float, Structure]:
    """Evidence of an unmodelled force on held-out recordings [nats], and its structure."""
    if not held_out:
        return 0.0, NO_STRUCTURE
    unseen = problem.with_recordings(held_out)
    fitted = fit_noise(unseen, best)
    remains = unexplained_evidence(unseen, fitted)
    if not np.isfinite(remains):
        return 0.0, NO_STRUCTURE
    return float(remains), find_structure_held_out(unseen, fitted)


def _coefficient_shift(fit: Fit) -> float:
    """Rms distance of the nominal coefficients from the vessel file, in prior sds."""
    shifts = []
    for parameter, x in zip(fit.free, fit.theta, strict=True):
        if parameter.relative:
            shifts.append((float(x) - parameter.mean) / parameter.sd)
    return float(np.sqrt(np.mean(np.square(shifts)))) if shifts else 0.0
