"""Assumed levels of sensor noise and of the latent (unmodelled) force before a fit."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import NoiseLevels, dof_in_state_order
from boatsim.diagnosis.input_noise import measured_force_mask
from boatsim.errors import BadInput
from boatsim.physics.signals import NOISE
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import HUGE, Recording


def shared_noise(
    vessel: Vessel, recordings: Sequence[Recording], config: DiagnosisConfig = DEFAULT
) -> dict[str, float]:
    """Return the sensor noise that all recordings share, as standard deviations by noise family.

    The notes of the first recording take precedence, then the vessel file, then an estimate from
    the data.

    Args:
        vessel: Vessel of the recordings.
        recordings: Recordings that are fitted.
        config: Settings of the diagnosis.

    Raises:
        BadInput: The notes specify a noise level out of range.
    """
    noise = dict(NOISE)
    for family in NOISE:
        sensed = priors.estimate_sensor_noise(vessel, recordings, family, config.load)
        if sensed:
            noise[family] = sensed
    noise |= {str(family): sd for family, sd in vessel.diagnosis.noise.items()}
    return noise | specified_noise(recordings[0])


def relative_noise(
    vessel: Vessel,
    recordings: Sequence[Recording],
    recording: Recording,
    config: DiagnosisConfig = DEFAULT,
) -> dict[str, float]:
    """Return the ratio of one recording's sensor noise to that of all recordings, by noise family.

    Only families are included in which it differs a lot. An exact log and one made by a camera must
    not be given the same noise, because a free run starts at the state that its recording shows.

    Args:
        vessel: Vessel of the recordings.
        recordings: Recordings that are fitted.
        recording: Recording that is compared with them.
        config: Settings of the diagnosis.
    """
    ratios = {}
    limit = config.load.noise_ratio
    for family in NOISE:
        if family in recording.notes.noise or family in vessel.diagnosis.noise:
            continue
        own = priors.estimate_sensor_noise(vessel, [recording], family, config.load)
        common = priors.estimate_sensor_noise(vessel, recordings, family, config.load)
        if own and common and not 1.0 / limit < own / common < limit:
            ratios[family] = own / common
    return ratios


def specified_noise(recording: Recording) -> dict[str, float]:
    """Return the sensor noise that a recording's notes specify, as standard deviations by family.

    Raises:
        BadInput: A level is out of range.
    """
    noise = recording.notes.noise
    for family, sd in noise.items():
        if not 0 < sd < HUGE:
            raise BadInput(
                f"{recording.origin}: noise {family} = {sd:g}; allowed is more than 0, at most "
                f"{HUGE:g}"
            )
    return noise


def prior_noise_levels(
    vessel: Vessel, recordings: Sequence[Recording], config: DiagnosisConfig = DEFAULT
) -> NoiseLevels:
    """Return the assumed levels of sensor noise and of the latent (unmodelled) force before a fit.

    The notes of the first recording take precedence over the rules of the configuration.

    Args:
        vessel: Vessel of the recordings.
        recordings: Recordings that are fitted.
        config: Settings of the diagnosis.

    Raises:
        BadInput: The notes specify a level out of range.
    """
    axes, recording = dof_in_state_order(vessel), recordings[0]
    where, notes = recording.origin, recording.notes.ambient
    specified = notes.get("force_rms", {})
    if not isinstance(specified, Mapping):
        named = notes.get("axes", axes)
        if len(named) != len(specified):
            raise BadInput(
                f"{where}: ambient.force_rms = {specified}; allowed are {len(named)} numbers, of "
                f"{', '.join(named)} in turn"
            )
        specified = dict(zip(named, specified, strict=True))
    by_rule = priors.assumed_disturbance(vessel, config.load)
    force = np.array([float(specified.get(axis, by_rule[axis])) for axis in axes])
    for axis, rms in zip(axes, force.tolist(), strict=True):
        if not 0 < rms < HUGE:
            raise BadInput(
                f"{where} on {vessel.name}: ambient force in {axis} = {rms:g}, what is tolerated; "
                f"allowed is more than 0, at most {HUGE:g}"
            )
    usual = priors.assumed_correlation_time(vessel, config.load)
    time_constant = float(notes.get("time_constant_s", usual))
    if not 0 < time_constant < HUGE:
        raise BadInput(
            f"{where}: ambient time_constant_s = {time_constant:g}; allowed is more than 0, "
            f"at most {HUGE:g}"
        )
    noise = shared_noise(vessel, recordings, config)
    white = np.zeros(0)
    if measured_force_mask(vessel, axes).any():
        share = config.load.input_noise_time * time_constant
        white = np.where(measured_force_mask(vessel, axes), share * force**2, 0.0)
    return NoiseLevels(force, time_constant, noise, config.filter.initial_force * force, white)
