"""Hydrodynamic coefficients of a hull over frequency and heading.

All numbers are in SI units, in SNAME axes (x forward, y starboard, z down) about a reference point
on the waterline. An incident wave has the elevation a cos(w t - k (x cos beta + y sin beta)),
positive upward, and its excitation is Re(X exp(i w t)) a. On a hull under way, the phase w t takes
the frequency of encounter, which is negative in waves that the hull overtakes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.coefficients.memory_fit import MemoryModel
from boatsim.physics.signals import Array


@dataclass(frozen=True, eq=False)
class DriftPairs:
    """Slow drift of pairs of waves of one direction: quadratic transfer functions.

    Attributes:
        frequency: Angular frequencies (M,) [rad/s], increasing.
        heading: Directions to which the waves run (H,) [rad], from 0 to pi, clockwise from x.
        values: Complex force and moment (M, M, H, 6) per product of both amplitudes, for the time
            dependence exp(i (w_1 - w_2) t); the conjugate if the waves are exchanged [N/m^2, N/m].
    """

    frequency: Array
    heading: Array
    values: NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class WaveLoads:
    """Loads of waves on a hull over frequency and heading, about its reference point.

    Attributes:
        source: Program and file, in words.
        depth: Depth of the water [m]; 0 for deep water.
        frequency: Angular frequencies of the waves (N,) [rad/s], increasing.
        heading: Directions (H,) to which waves run [rad], from 0 to pi, clockwise from x. Waves of
            pi come from ahead.
        excitation: Complex excitation (N, H, 6) [N/m, N].
        drift: Mean drift force in surge and sway and moment in yaw (N, H, 3) per square of the
            amplitude [N/m^2, N/m]; None if it is not known.
        drift_pairs: Slow drift of pairs of waves; None if it is not known.
        speed: Forward speed [m/s] at which the excitation was computed; 0 at rest, and for loads of
            the motions of a vessel.
    """

    source: str
    depth: float
    frequency: Array
    heading: Array
    excitation: Array
    drift: Array | None = None
    drift_pairs: DriftPairs | None = None
    speed: float = 0.0


@dataclass(frozen=True, eq=False)
class Coefficients:
    """Hydrodynamic coefficients of a hull in waves, about its reference point.

    Attributes:
        source: Program and mesh, in words.
        density: Density of the water [kg/m^3].
        depth: Depth of the water [m]; 0 for deep water.
        draught: Draught of the hull [m].
        volume: Displaced volume [m^3].
        buoyancy: Centre of buoyancy (3,) [m].
        restoring: Hydrostatic stiffness (6, 6) of waterplane and buoyancy, without the moment of
            the weight [N/m, N, N m].
        frequency: Angular frequencies (N,) [rad/s], increasing.
        added_mass: Added mass (N, 6, 6) over `AXES` [kg, kg m, kg m^2].
        damping: Radiation damping (N, 6, 6) [N s/m, N s, N m s].
        infinite_added_mass: Added mass at infinite frequency (6, 6).
        heading: Directions (H,) to which waves run [rad], from 0 to pi, clockwise from x. Waves of
            pi come from ahead.
        excitation: Complex excitation (N, H, 6) [N/m, N].
        memory: State-space model of the memory of the radiation force; None without one.
        drift: Mean drift force in surge and sway and moment in yaw (N, H, 3) per square of the
            amplitude [N/m^2, N/m]; None if it is not known.
        drift_of: Hull that drifts, in words: its mass and gyradii.
        drift_pairs: Slow drift of pairs of waves; None if it is not known.
        speed: Forward speed [m/s] of the excitation; all other coefficients are those at rest.
    """

    source: str
    density: float
    depth: float
    draught: float
    volume: float
    buoyancy: Array
    restoring: Array
    frequency: Array
    added_mass: Array
    damping: Array
    infinite_added_mass: Array
    heading: Array
    excitation: Array
    memory: MemoryModel | None = None
    drift: Array | None = None
    drift_of: str = ""
    drift_pairs: DriftPairs | None = None
    speed: float = 0.0
