"""Whether an explanation carries over: free runs over recordings that no fit has seen."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis.free_runs import FAMILIES, FreeRun, mean_square

FEWEST = 3  # free runs from which their scatter is known
WORSE = 1.05  # ratio of rms errors from which they have grown


def squares(stretches: Sequence[FreeRun], model: str) -> dict[str, list[float]]:
    """Mean square error of each free run over which anything was recorded, by family of signals."""
    found: dict[str, list[float]] = {}
    for family, signals in FAMILIES.items():
        for s in stretches:
            recorded = s.channels["recorded"]
            off = [s.channels[model][n] - recorded[n] for n in signals if n in recorded]
            if any(np.isfinite(recorded[n]).any() for n in signals if n in recorded):
                found.setdefault(family, []).append(mean_square(off))
    return found


def grew(
    before: Mapping[str, Sequence[float]], after: Mapping[str, Sequence[float]], sure: float
) -> bool:
    """Whether the error of any family grew, by so many standard errors of its mean over the runs."""
    for family, old in before.items():
        if len(old) < FEWEST or not np.isfinite(old).all():
            continue
        rise = np.array(after[family]) - np.array(old)
        if not np.isfinite(rise).all():  # the boat runs away
            return True
        scatter = sure * rise.std(ddof=1) / np.sqrt(len(rise))
        if rise.mean() > max(scatter, (WORSE**2 - 1.0) * np.mean(old)):
            return True
    return False


def misfit(found: Mapping[str, Sequence[float]], per: Mapping[str, Sequence[float]]) -> float:
    """Geometric mean over the families of the mean square errors, in those of another model."""
    return float(np.exp(np.mean([np.log(np.mean(found[f]) / np.mean(per[f])) for f in found])))
