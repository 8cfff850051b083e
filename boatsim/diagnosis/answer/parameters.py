"""Keys and standard deviations of the fitted parameters that an answer reports."""

import numpy as np

from boatsim.diagnosis.config import AnswerConfig
from boatsim.diagnosis.problem import Fit
from boatsim.diagnosis.significance import distance_from_zero
from boatsim.physics.base import Effect


def parameter_key(name: str, unit: str) -> str:
    """Return the key under which diagnosis.json has a parameter, its name and its unit.

    For example, `force` in N is force_N and `north` in m/s is north_mps.

    Args:
        name: Name of the parameter.
        unit: Its unit; "" for a ratio, whose key is its name.
    """
    suffix = unit.replace("1/", "per").replace("/", "p").replace("^", "").replace(" ", "")
    if suffix:
        return f"{name}_{suffix}"
    return name


def reported_sd(best: Fit, effect: Effect, name: str, config: AnswerConfig) -> float:
    """Return the standard deviation of an effect's fitted parameter that diagnosis.json reports.

    It is larger than that of the fit, because a law is only nearly right.

    Args:
        best: Fit of the vessel model with the effect.
        effect: The effect.
        name: Name of the parameter.
        config: Settings of the answer, with the size of that error.
    """
    kind = type(effect)
    value, sd = best.value(effect.name, name)
    param = kind.params()[name]
    if name in (kind.strength or kind.params()):
        strength = min(distance_from_zero(best, effect, name), abs(value) or np.inf)
        return float(np.hypot(sd, config.law_error * strength))
    if param.unit == "rad":
        return float(np.hypot(sd, config.law_error))
    return sd
