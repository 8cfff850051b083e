"""The locate stage: along which axes, when and under which conditions a force is missing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from boatsim.diagnosis.locate.missing_force import (
    ForceStrength,
    Interval,
    MissingForce,
    missing_force_rms,
    significant_intervals,
)
from boatsim.diagnosis.locate.regions import Region, find_missing_force_conditions
from boatsim.diagnosis.problem import Fit, Problem


@dataclass(frozen=True)
class Location:
    """Where and when the vessel model lacks a force.

    Attributes:
        strengths: Size of the force that the vessel model without candidate effects lacks, by axis.
        remaining: Size of the force that the patched vessel leaves unexplained, by axis.
        intervals: Time intervals in which the first force is significant.
        regions: Conditions under which it is significant, the most significant first.
    """

    strengths: Mapping[str, ForceStrength]
    remaining: Mapping[str, ForceStrength]
    intervals: tuple[Interval, ...]
    regions: tuple[Region, ...]


def locate_force(
    problem: Problem,
    fit: Fit,
    missing: Sequence[MissingForce],
    remaining: Sequence[MissingForce],
    *,
    with_regions: bool,
) -> Location:
    """Find along which axes, when and under which conditions the vessel model lacks a force.

    Args:
        problem: The estimation problem.
        fit: The recalibrated vessel: its coefficients are fitted, and no candidate acts.
        missing: Force that the vessel model without candidate effects lacks in each recording.
        remaining: Force that the patched vessel leaves unexplained in each recording.
        with_regions: Whether to test conditions, which runs the smoother over all recordings.
    """
    regions: Sequence[Region] = ()
    if with_regions:
        regions = find_missing_force_conditions(problem, fit)
    return Location(
        strengths=missing_force_rms(problem, missing),
        remaining=missing_force_rms(problem, remaining),
        intervals=tuple(significant_intervals(problem, missing)),
        regions=tuple(regions),
    )
