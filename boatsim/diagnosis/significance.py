"""How far fitted parameters of an effect, alone or together, differ from zero effect."""

from collections.abc import Container

import numpy as np
from scipy.special import chdtri, ndtr

from boatsim.diagnosis.problem import Fit
from boatsim.physics.base import Effect


def distance_from_zero(fit: Fit, effect: Effect, name: str) -> float:
    """Return how far a fitted parameter of an effect is from the value without the effect.

    An effect with a limit, as of a rate, is absent at an infinite value; the distance of the
    inverse is the same in standard deviations as that of the limit from zero.

    Args:
        fit: Fit of the vessel model with the effect.
        effect: The effect.
        name: Name of one of its fitted parameters.
    """
    value, _ = fit.value(effect.name, name)
    if name in type(effect).limits:
        return abs(value)
    return abs(value - fit.prior_mean(effect.name, name))


def jointly_differ_from_zero(
    fit: Fit, effect: str, names: Container[str], certainty: float
) -> bool:
    """Return whether parameters of an effect together are clearly away from zero effect.

    Recordings may determine a combination of them and none of them alone, such as the difference of
    two scales. Their squared Mahalanobis distance is compared with the quantile of the chi-square
    distribution that is as improbable as `certainty` standard deviations of one parameter.

    Args:
        fit: Fit of the vessel model with the effect.
        effect: Name of the effect.
        names: Names of two or more of its parameters.
        certainty: Distance of one parameter that would be clear [sd].
    """
    places, offsets = [], []
    for place, free in enumerate(fit.free):
        if free.effect == effect and not free.relative and free.name in names:
            places.append(place)
            offsets.append(fit.theta[place] - free.mean)
    covariance = fit.covariance[np.ix_(places, places)]
    if len(places) < 2 or not np.isfinite(covariance).all():
        return False
    distance = float(np.array(offsets) @ np.linalg.pinv(covariance) @ np.array(offsets))
    return distance > float(chdtri(len(places), 2.0 * ndtr(-certainty)))
