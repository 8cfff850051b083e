"""Compares free runs of models over recordings that no fit has used."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.config import DEFAULT, ValidateConfig
from boatsim.diagnosis.free_runs import FAMILIES, FreeRun, mean_square

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

    It is the geometric mean over position, heading, roll and heave.

    Args:
        found: Mean square errors of a model.
        reference: Those of the model that it is compared with.
    """
    ratios = []
    for family, errors in found.items():
        ratios.append(np.log(np.mean(errors) / np.mean(reference[family])))
    return float(np.exp(np.mean(ratios)))
