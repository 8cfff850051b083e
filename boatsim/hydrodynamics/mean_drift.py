"""Mean drift force of regular waves by the far-field method.

The mean force in surge and sway and the mean moment in yaw follow from the conservation of momentum
and energy in the waves far from the hull, which its Kochin function H describes: the amplitude of
the waves that it scatters and radiates into each direction. Sources: H. Maruo, J. Ship Research
4(3), 1960; J. N. Newman, J. Ship Research 11(1), 1967.
"""

from typing import Any, NamedTuple

import numpy as np

from boatsim.hydrodynamics.axes import SIGNS
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array
from boatsim.physics.waves.dispersion import wave_number

DRIFT_AXES = [0, 1, 5]  # places of surge, sway and yaw among the axes


class FarField(NamedTuple):
    """Factors of the momentum of waves of one frequency far from the hull."""

    number: float  # [rad/m] wave number
    incident: float  # [kg/(m^3 s)] of the product of the incident and an outgoing wave
    outgoing: float  # [kg/m^5] of the square of the outgoing waves


def far_field(frequency: float, depth: float, density: float) -> FarField:
    """Return the factors of the momentum of waves of one frequency.

    Args:
        frequency: Angular frequency [rad/s].
        depth: Depth of the water [m]; 0 for deep water.
        density: Density of the water [kg/m^3].
    """
    k = float(wave_number(frequency, depth))
    deep = frequency * frequency / GRAVITY
    area = deep
    if depth > 0.0:
        area += depth * (k * k - deep * deep)
    incident = 2.0 * np.pi * density * frequency * k / deep
    return FarField(k, incident, 2.0 * np.pi * density * k**3 / area)


def drift_of_kochin(kochin: Array, heading: Array, waves: FarField, absorbed: Array) -> Array:
    """Return the mean drift of waves of unit amplitude and one frequency.

    Surge and sway are, with the outgoing waves H of all directions theta and the incident wave to
    beta, F = c int |H|^2 (e(beta) - e(theta)) dtheta + W k / w e(beta), where e is the unit vector
    of a direction and W the power that is not radiated. Maruo's formula with the conservation of
    energy instead of H(beta) loses no digits in long waves. The moment is that of Newman.

    Args:
        kochin: Kochin functions (H, T) at T equally spaced directions from 0 on, counter-clockwise.
        heading: Directions (H,) to which the incident waves run [rad], counter-clockwise.
        waves: Factors of the momentum.
        absorbed: Momentum of the waves whose power is not radiated (H,) [N/m^2].

    Returns:
        Force along x and y and moment about z, upward (H, 3) [N/m^2, N/m].
    """
    count = kochin.shape[1]
    theta = 2.0 * np.pi / count * np.arange(count)
    share = waves.outgoing * np.abs(kochin) ** 2 * (2.0 * np.pi / count)
    lost = share.sum(axis=1) + absorbed
    found = np.zeros((len(heading), 3))
    found[:, 0] = lost * np.cos(heading) - share @ np.cos(theta)
    found[:, 1] = lost * np.sin(heading) - share @ np.sin(theta)
    order = np.fft.fftfreq(count, 1.0 / count)
    series = np.fft.fft(kochin, axis=1) / count
    series[:, count // 2] = 0.0  # has no derivative; the functions are smooth
    along = np.exp(1j * order * heading[:, None])
    slope = np.sum(1j * order * series * along, axis=1)
    spin = 2.0 * np.pi * np.sum(order * np.abs(series) ** 2, axis=1)
    found[:, 2] = -(waves.incident * slope.imag + waves.outgoing * spin) / waves.number
    return found


def energy_error(kochin: Array, heading: Array, waves: FarField) -> Array:
    """Return by how much energy is not conserved in waves that a hull without damping scatters.

    Args:
        kochin: Kochin functions (H, T), as in `drift_of_kochin`.
        heading: Directions (H,) to which the incident waves run [rad], counter-clockwise.
        waves: Factors of the momentum.

    Returns:
        Energy taken from the incident wave less the scattered energy, over the latter (H,).
    """
    count = kochin.shape[1]
    order = np.fft.fftfreq(count, 1.0 / count)
    series = np.fft.fft(kochin, axis=1) / count
    ahead = np.sum(series * np.exp(1j * order * heading[:, None]), axis=1)
    scattered = waves.outgoing * 2.0 * np.pi * np.sum(np.abs(series) ** 2, axis=1)
    return np.asarray(-waves.incident * ahead.real / scattered - 1.0)


def kochin_of_row(row: dict[str, Any], response: Array) -> Array:
    """Return the Kochin functions (H, T) of a moving hull at one frequency.

    Args:
        row: Result of Capytaine for one frequency.
        response: Motion (H, 6) in SNAME axes, with the time factor exp(i w t).
    """
    pairs = np.array(row["diffraction_kochin"])
    diffraction = pairs[..., 0] + 1j * pairs[..., 1]
    pairs = np.array(row["radiation_kochin"])
    radiation = pairs[..., 0] + 1j * pairs[..., 1]
    return np.asarray(diffraction + np.conj(response * SIGNS) @ radiation)


def mean_drift(
    rows: list[dict[str, Any]], found: Coefficients, response: Array, extra: Array
) -> Array:
    """Return the mean drift of a hull in waves of unit amplitude.

    Args:
        rows: Results of `run_capytaine`.
        found: Coefficients of the hull from these results.
        response: Motion (N, H, 6) in waves of unit amplitude, in SNAME axes and with the time
            factor exp(i w t); zero for a hull that is held.
        extra: Damping in addition to that of the radiated waves (6, 6).

    Returns:
        Force in surge and sway and moment in yaw in SNAME axes (N, H, 3) [N/m^2, N/m].
    """
    by_frequency = {row["frequency"]: row for row in rows}
    drift = []
    for i, w in enumerate(found.frequency):
        waves = far_field(float(w), found.depth, found.density)
        kochin = kochin_of_row(by_frequency[float(w)], response[i])
        power = np.einsum("hi,ij,hj->h", np.conj(response[i]), extra, response[i]).real
        absorbed = 0.5 * w * waves.number * power
        drift.append(drift_of_kochin(kochin, -found.heading, waves, absorbed))
    return np.asarray(np.array(drift) * SIGNS[DRIFT_AXES])
