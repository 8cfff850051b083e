"""Compares free runs of models over recordings that no fit has used."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.config import DEFAULT, ValidateConfig
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.free_runs import FAMILIES, FreeRun, free_runs, mean_square
from boatsim.diagnosis.problem import Fit, Problem

Squares = Mapping[str, Sequence[float]]  # mean square error of each free run by family of signals


def mean_square_errors(runs: Sequence[FreeRun], model: str) -> dict[str, list[float]]:
    """Return the mean square error of each simulation (free run) over held-out recordings.

    The key is the family of signals: position, heading, roll or heave.

    Args:
        runs: Free runs; those over which nothing was recorded are omitted.
        model: Name of the model.
    """
    found: dict[str, list[float]] = {}
    for family, signals in FAMILIES.items():
        for run in runs:
            recorded = run.channels["recorded"]
            own = [recorded[name] for name in signals if name in recorded]
            if any(np.isfinite(values).any() for values in own):
                error = mean_square(run.deviations(model, signals))
                found.setdefault(family, []).append(error)
    return found


def errors_grew(
    before: Squares, after: Squares, sure: float, config: ValidateConfig = DEFAULT.validate
) -> bool:
    """Whether simulations of held-out recordings by one model are clearly worse than by another.

    The errors of position, heading, roll and heave are compared; one that has grown suffices.

    Args:
        before: Mean square errors of a model.
        after: Those of another model over the same free runs.
        sure: Number of standard errors of the mean by which it must grow.
        config: Fewest free runs, and the ratio by which it must grow, too.
    """
    for family, old in before.items():
        if len(old) < config.fewest_runs or not np.isfinite(old).all():
            continue
        rise = np.array(after[family]) - np.array(old)
        if not np.isfinite(rise).all():  # the simulated boat diverges
            return True
        scatter = sure * rise.std(ddof=1) / np.sqrt(len(rise))
        if rise.mean() > max(scatter, (config.worse**2 - 1.0) * np.mean(old)):
            return True
    return False


def error_ratio(found: Squares, reference: Squares) -> float:
    """Return the ratio of the mean square simulation errors of two models.

    It is the geometric mean over position, heading, roll and heave; nan if simulations by both
    diverge.

    Args:
        found: Mean square errors of a model.
        reference: Those of the model that it is compared with.
    """
    ratios = []
    with np.errstate(invalid="ignore", divide="ignore"):
        for family, errors in found.items():
            ratios.append(np.log(np.mean(errors) / np.mean(reference[family])))
        return float(np.exp(np.mean(ratios)))


def recordings_by_group(recordings: Sequence[MappedRecording]) -> dict[str, list[MappedRecording]]:
    """Return the recordings of each group to which some of them belong, but not all.

    Args:
        recordings: Mapped recordings with the names of their groups.
    """
    found: dict[str, list[MappedRecording]] = {}
    for group in sorted({group for mapped in recordings for group in mapped.groups}):
        own = [mapped for mapped in recordings if group in mapped.groups]
        if len(own) < len(recordings):
            found[group] = own
    return found


def error_growth_by_group(
    problem: Problem,
    before: Fit,
    after: Fit,
    held_out: Sequence[MappedRecording],
    horizon: float,
) -> dict[str, float]:
    """Return how far the simulation errors in each group of held-out recordings differ.

    The result is the ratio of the rms errors over all free runs of a group, of that family of
    signals where it is largest. A few long errors suffice, as they do for a user of the model.

    Args:
        problem: The estimation problem with the settings.
        before: The model that serves as reference.
        after: The other model.
        held_out: Held-out recordings.
        horizon: Length of each free run [s].

    Returns:
        Ratio by group; infinite where a simulation by `after` diverges. Groups with few free runs,
        or in which the reference diverges, are omitted.
    """
    found: dict[str, float] = {}
    for group, recordings in recordings_by_group(held_out).items():
        runs = free_runs(problem, {"before": before, "after": after}, recordings, horizon)
        new = mean_square_errors(runs, "after")
        for family, old in mean_square_errors(runs, "before").items():
            if len(old) < problem.config.validate.fewest_runs or not np.isfinite(old).all():
                continue
            ratio = float(np.sqrt(np.mean(new[family]) / np.mean(old)))
            if not np.isfinite(ratio):
                ratio = np.inf
            found[group] = max(found.get(group, 0.0), ratio)
    return found


def harmed_groups(
    problem: Problem,
    before: Fit,
    after: Fit,
    held_out: Sequence[MappedRecording],
    horizon: float,
) -> tuple[str, ...]:
    """Return the groups of held-out recordings that one model simulates much worse than another.

    The arguments are those of `error_growth_by_group`.
    """
    growth = error_growth_by_group(problem, before, after, held_out, horizon)
    limit = problem.config.validate.group_harm
    return tuple(group for group, ratio in growth.items() if ratio > limit)
