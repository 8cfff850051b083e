"""Priors of a diagnosis: one rule for each number, the same for every boat.

Each rule is a setting of the configuration for a hull of 1.2 m, scaled to others by Froude's law:
forces with the weight, times and speeds with the square root of the length. A vessel may override a
rule in its [diagnosis] table and must give a reason, which the report prints.
"""

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np

from boatsim.diagnosis.config import DEFAULT, LoadConfig
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import STATE
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

REFERENCE_LENGTH = 1.2  # [m] of the hull for which times of the configuration are given
REFERENCE_BEAM = 0.44  # [m] of the same hull
CHI_SQUARE_MEDIAN = 0.455  # of the square of a standard normal variable
# Kinds of coefficients that are uncertain where no uncertainty is specified. Added mass is not one
# of them, because its error is a candidate effect (`added_mass_error`). Settings are numbers, so
# that this list of names is no setting; a vessel or the notes may specify the uncertainty of other
# kinds.
UNCERTAIN = ("damping", "thrust", "restoring", "wind", "wave", "current")


def froude_time_scale(vessel: Vessel) -> float:
    """Return the factor by which times on a vessel are longer than on a hull of 1.2 m.

    Times scale with the square root of the length (Froude's law).
    """
    return float(np.sqrt(vessel.length / REFERENCE_LENGTH))


def area_scale(vessel: Vessel) -> float:
    """Return the ratio of the area of a vessel, length times beam, to that of a hull of 1.2 m."""
    return vessel.length * vessel.beam / (REFERENCE_LENGTH * REFERENCE_BEAM)


def assumed_disturbance(vessel: Vessel, config: LoadConfig = DEFAULT.load) -> dict[str, float]:
    """Return the assumed rms of the unmodelled force on each axis of a vessel [N, N m].

    It is proportional to the weight of the vessel.

    Args:
        vessel: Vessel whose [diagnosis] table may override the rule.
        config: Settings of the rule.
    """
    force = config.disturbance * vessel.body.mass * GRAVITY
    arms = {
        "roll": config.roll_arm * vessel.draught,
        "pitch": config.pitch_arm * vessel.length,
        "yaw": config.yaw_arm * vessel.length,
    }
    by_rule = {axis: force * arms.get(axis, 1.0) for axis in vessel.dof}
    return by_rule | {str(axis): rms for axis, rms in vessel.diagnosis.ambient.items()}


def assumed_correlation_time(vessel: Vessel, config: LoadConfig = DEFAULT.load) -> float:
    """Return the assumed correlation time [s] of the unmodelled force on a vessel.

    It scales with the square root of the vessel's length (Froude's law).

    Args:
        vessel: Vessel whose length sets the scale.
        config: Settings of the rule.
    """
    return config.correlation_time * froude_time_scale(vessel)


def default_free_run_horizon(vessel: Vessel, config: LoadConfig = DEFAULT.load) -> float:
    """Return the usual duration [s] of a free run of a vessel, to three digits.

    A free run is a simulation from a recorded state with the recorded commands alone.

    Args:
        vessel: Vessel whose [diagnosis] table may override the rule.
        config: Settings of the rule.
    """
    return vessel.diagnosis.horizon or float(f"{config.horizon * froude_time_scale(vessel):.3g}")


def downsampling_rate(
    vessel: Vessel, duration: float = 0.0, config: LoadConfig = DEFAULT.load
) -> float:
    """Return the rate [Hz] to which recordings are downsampled before a diagnosis.

    An hour is informative by its many manoeuvres, a minute by its many rows; the cost of a
    diagnosis is proportional to the rows.

    Args:
        vessel: Vessel whose [diagnosis] table may override the rule.
        duration: Duration of all recordings together [s].
        config: Settings of the rule.
    """
    usual = config.row_rate / froude_time_scale(vessel)
    share = max(config.least_row_share, config.enough_rows / max(usual * duration, 1.0))
    return vessel.diagnosis.rate or usual * min(1.0, share)


def coefficient_uncertainty(vessel: Vessel, config: LoadConfig = DEFAULT.load) -> dict[str, float]:
    """Return the relative prior standard deviation of a vessel's coefficients.

    It is given by kind of coefficient: damping, thrust, restoring, wind, ...

    Args:
        vessel: Vessel whose [diagnosis] table, or else [estimated] table, may override the rule.
        config: Settings of the rule.
    """
    kinds = set()
    for effect in vessel.effects:
        for param in type(effect).params().values():
            if param.axis in ("", *vessel.dof):
                kinds.add(param.calibrates)
    by_rule = {kind: config.coefficient_uncertainty for kind in UNCERTAIN if kind in kinds}
    for group, sd in vessel.estimated.items():
        if group in kinds:
            by_rule[group] = sd
    specified: Mapping[str, float] = {
        str(kind): sd for kind, sd in vessel.diagnosis.coefficient_uncertainty.items()
    }
    return by_rule | dict(specified)


def estimate_sensor_noise(
    vessel: Vessel,
    recordings: Sequence[Recording],
    family: str,
    config: LoadConfig = DEFAULT.load,
) -> float:
    """Estimate the noise of a family of sensors from high-order differences of their signals.

    Differences of high order contain little of the motion; the order with the smallest result is
    used. The estimate is robust to outliers.

    Args:
        vessel: Vessel of the recordings.
        recordings: Recordings with the same instruments.
        family: Noise family, such as "position_sd_m".
        config: Orders of the differences, and the lower bound.

    Returns:
        Standard deviation in the unit of the signals; 0 if nothing was recorded.
    """
    sensors = [s for s in STATE if s.noise == family and s.axis in vessel.dof]
    longest = 2 * (max(config.noise_orders) + 1)
    signals = []
    for recording in recordings:
        for sensor in sensors:
            if sensor.column in recording.signals:
                y = recording.signals[sensor.column]
                y = y[np.isfinite(y)]
                if len(y) > longest:
                    signals.append(y)
    if not signals:
        return 0.0
    found = []
    for order in config.noise_orders:
        squares = [np.diff(y, order) ** 2 / comb(2 * order, order) for y in signals]
        found.append(float(np.sqrt(np.median(np.concatenate(squares)) / CHI_SQUARE_MEDIAN)))
    return max(min(found), config.finest_noise * noise_reference_scale(vessel, sensors[0].column))


def noise_reference_scale(vessel: Vessel, column: str) -> float:
    """Return the reference scale for the noise of a sensor column of a vessel.

    It is the vessel's length [m] for distances and one radian for angles; for rates it is divided
    by the time sqrt(length / g).

    Args:
        vessel: Vessel whose length sets the scale.
        column: Name of a column.
    """
    unit = 1.0 if "rad" in column else vessel.length
    if column.endswith("ps"):
        unit = float(np.sqrt(GRAVITY / vessel.length)) * unit
    return float(unit)
