"""Noise of measured forces and moments, which moves the hull of the model but not the real one.

A force that was measured is an input with noise. Without a model of it the fit prefers a smaller
gain of the sensor, by which less of the noise acts (attenuation by errors in variables, L. Ljung,
System Identification, 2nd ed. 1999, section 13.4). Two parts are known to the filter: the noise
that the samples of a recording show, and a level that is fitted, for a force that is measured at
one end of a gear or of a soft coupling differs from the one at the other end.
"""

from collections.abc import Iterator, Sequence
from math import comb

import numpy as np
from numpy.typing import NDArray

from boatsim.diagnosis.config import LoadConfig
from boatsim.physics.base import AXES, Array, Force, make_motion
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording, TimedCommands


def input_noise_density(
    vessel: Vessel, recording: Recording, axes: Sequence[str], config: LoadConfig
) -> Array:
    """Return the spectral density of the noise of measured forces along each axis.

    Args:
        vessel: Vessel of the recording.
        recording: Recording with the measured channels.
        axes: Degrees of freedom in the order of the filter's state.
        config: Settings of the estimate.

    Returns:
        (axes,) density [N^2 s, N^2 m^2 s]; 0 without a measured force.
    """
    density = np.zeros(len(axes))
    for channel, per_unit in _measured_inputs(vessel, axes):
        density += per_unit**2 * _channel_density(recording, channel, config)
    return density


def measured_input_indices(vessel: Vessel) -> list[int]:
    """Return the places of channels with measured forces among the inputs of a vessel."""
    channels = {channel for channel, _ in _measured_inputs(vessel, AXES)}
    return [i for i, name in enumerate(vessel.inputs) if name in channels]


def interpolate_measured_inputs(inputs: Array, places: Sequence[int]) -> Array:
    """Return inputs that are held until the next row, measured ones at their mean in between.

    A command is in force from its row to the next. A measured force is a sample of a continuous
    course, which the straight line to the next sample follows; its mean is held, so that it does
    not act half an interval late.

    Args:
        inputs: (N, inputs) values in each row.
        places: Columns of measured forces.
    """
    if not places:
        return inputs
    found = inputs.copy()
    for place in places:
        found[:-1, place] = 0.5 * (inputs[:-1, place] + inputs[1:, place])
    return found


def measured_force_mask(vessel: Vessel, axes: Sequence[str]) -> NDArray[np.bool_]:
    """Return a boolean mask (axes,): along which axes a measured force acts.

    Args:
        vessel: The vessel.
        axes: Degrees of freedom in the order of the filter's state.
    """
    found = np.zeros(len(axes), dtype=np.bool_)
    for _, per_unit in _measured_inputs(vessel, axes):
        found |= per_unit != 0.0
    return found


def _measured_inputs(vessel: Vessel, axes: Sequence[str]) -> Iterator[tuple[str, Array]]:
    """Each channel with a measured force, and its generalized force (axes,) per unit."""
    places = [AXES.index(axis) for axis in axes]
    for effect in vessel.effects:
        if not isinstance(effect, Force) or not type(effect).measures_input:
            continue
        for role, channel in vessel.bindings(effect).items():
            if isinstance(channel, str):
                yield channel, _wrench_per_unit(effect, role)[places]


def _wrench_per_unit(effect: Force, role: str) -> Array:
    """Wrench (6,) per unit of one signal of an effect, for a hull at rest."""
    at_one = effect.wrench(make_motion(), type(effect).signals(**{role: 1.0}))
    at_zero = effect.wrench(make_motion(), type(effect).signals())
    return np.asarray(np.subtract(at_one, at_zero), dtype=float)


def _channel_density(recording: Recording, channel: str, config: LoadConfig) -> float:
    """Spectral density of the noise of a channel, from differences of its own samples."""
    source = recording.orders
    if source is None:
        source = TimedCommands(recording.t, recording.signals)
    t, order = source.t, config.input_noise_order
    if channel not in source.signals or len(t) <= 2 * order:
        return 0.0
    squares = np.diff(source.signals[channel], order) ** 2 / comb(2 * order, order)
    noise = squares[squares <= np.percentile(squares, config.input_noise_percentile)]
    return float(np.mean(noise) * np.median(np.diff(t)))
