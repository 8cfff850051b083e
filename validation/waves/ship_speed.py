"""Strip theory at forward speed: a ship's table of coefficients, loads and motions.

The MSS toolbox contains a container ship of 175 m (ITTC's S-175), computed at five speeds by VERES
4.02, a program of N. Salvesen, E. O. Tuck and O. Faltinsen's strip theory. Added mass and damping
at speed are compared with those that the terms of forward speed make of the coefficients at zero
speed, and the motions in head waves with those that follow from the equations and VERES's loads.

VERES's coefficients have small end terms at the stern, which the terms here leave out.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from boatsim.hydrodynamics.mss import read_mss
from boatsim.physics.base import AXES, Array

TABLE = Path("HYDRO") / "vessels_shipx" / "s175" / "s175.mat"
GRAVITY = 9.81  # [m/s^2] of the table
SWAY, HEAVE, ROLL, PITCH, YAW = (AXES.index(name) for name in AXES[1:])
UPRIGHT, SIDEWAYS = (HEAVE, PITCH), (SWAY, ROLL, YAW)
METHODS = ("none", "body axes", "forward speed")
SHORTEST = 0.8  # wavelength over length; shorter waves hardly move the ship
RATIOS = (3.0, 2.5, 2.0, 1.5, 1.25, 1.0)  # wavelength over length that are printed


class Ship(NamedTuple):
    """Table of a ship at several speeds, in SNAME axes with the origin amidships.

    Attributes:
        path: Its file.
        length: Length [m].
        centre: Mass centre ahead of the origin [m], to which VERES's loads and motions refer.
        body: Mass matrix (6, 6) of the rigid body.
        frequency: Frequencies (N,) [rad/s].
        speed: Speeds (U,) [m/s].
        added_mass: Added mass (N, 6, 6, U).
        damping: Damping (N, 6, 6, U).
        stiffness: Stiffness (6, 6).
    """

    path: Path
    length: float
    centre: float
    body: Array
    frequency: Array
    speed: Array
    added_mass: Array
    damping: Array
    stiffness: Array


def read_ship(mss: Path) -> Ship:
    """Read the ship from the MSS toolbox.

    Args:
        mss: Folder of the toolbox.

    Raises:
        FileNotFoundError: The folder has no such table.
    """
    from scipy.io import loadmat

    path = mss / TABLE
    vessel: Any = loadmat(path, squeeze_me=True, struct_as_record=False)["vessel"]
    added, damping = (np.moveaxis(np.asarray(one, float), 2, 0) for one in (vessel.A, vessel.B))
    return Ship(
        path,
        float(vessel.main.Lpp),
        float(vessel.main.CG[0]),
        np.asarray(vessel.MRB, dtype=float),
        np.asarray(vessel.freqs, dtype=float),
        np.asarray(vessel.velocities, dtype=float),
        added,
        damping,
        np.asarray(vessel.C[:, :, 0, 0], dtype=float),
    )


def speed_terms(added_mass: Array, damping: Array, w: float, speed: float) -> tuple[Array, Array]:
    """Return added mass and damping (6, 6) at forward speed in axes that move with the ship.

    Salvesen, Tuck and Faltinsen, Ship motions and sea loads, Transactions of SNAME 78, 1970,
    without end terms. SNAME axes have the same signs as their axes with z up.

    Args:
        added_mass: Added mass (6, 6) at zero speed.
        damping: Damping (6, 6) at zero speed.
        w: Frequency of encounter [rad/s].
        speed: Forward speed [m/s].
    """
    a, b = added_mass.copy(), damping.copy()
    share = speed / w**2
    for turning, across, sign in ((PITCH, HEAVE, 1.0), (YAW, SWAY, -1.0)):
        others = [across]
        if across == SWAY:
            others.append(ROLL)
        for other in others:
            a[other, turning] -= sign * share * damping[other, across]
            a[turning, other] += sign * share * damping[across, other]
            b[other, turning] += sign * speed * added_mass[other, across]
            b[turning, other] -= sign * speed * added_mass[across, other]
        a[turning, turning] += speed * share * added_mass[across, across]
        b[turning, turning] += speed * share * damping[across, across]
    return a, b


def coefficient_errors(ship: Ship) -> list[tuple[float, float, float, float, float]]:
    """Return the largest errors of added mass and damping at each speed above zero.

    Each entry is divided by the square root of the largest values of its axes over all frequencies
    up to waves of `SHORTEST` lengths.

    Args:
        ship: The ship.

    Returns:
        For each speed: the speed [m/s], the errors with the terms in heave and pitch and in sway,
        roll and yaw, and the same without them [-].
    """
    rows = []
    chosen = [k for k, w in enumerate(ship.frequency) if wave_ratio(ship, w) > SHORTEST]
    for number, speed in enumerate(ship.speed.tolist()):
        if speed == 0.0:
            continue
        found = []
        for turned in (True, False):
            for axes in (UPRIGHT, SIDEWAYS):
                found.append(_largest_error(ship, number, chosen, axes, turned))
        rows.append((speed, *found))
    return rows


def _largest_error(
    ship: Ship, number: int, chosen: list[int], axes: tuple[int, ...], turned: bool
) -> float:
    """Largest error of added mass and damping of some axes, with the terms or without."""
    block, largest = np.ix_(axes, axes), 0.0
    tables = (ship.added_mass[..., number], ship.damping[..., number])
    sizes = []
    for table in tables:
        size = np.sqrt(np.abs(np.einsum("nii->ni", table[chosen])).max(axis=0))[list(axes)]
        sizes.append(size[:, None] * size)
    for k in chosen:
        zero = (ship.added_mass[k, ..., 0], ship.damping[k, ..., 0])
        if turned:
            zero = speed_terms(*zero, float(ship.frequency[k]), float(ship.speed[number]))
        for own, table, size in zip(zero, tables, sizes, strict=True):
            largest = max(largest, float((np.abs(own - table[k])[block] / size).max()))
    return largest


def wave_ratio(ship: Ship, w: float) -> float:
    """Return the wavelength in deep water over the length of the ship.

    Args:
        ship: The ship.
        w: Frequency of the wave [rad/s].
    """
    return 2.0 * np.pi * GRAVITY / w**2 / ship.length


class Motion(NamedTuple):
    """Motion of the ship in a head wave, over that of VERES."""

    speed: float  # [m/s]
    ratio: float  # wavelength over length
    table: tuple[float, float]  # VERES's heave over the amplitude, pitch over the slope of the wave
    found: tuple[tuple[float, float], ...]  # of each of `METHODS`, with VERES's loads at the speed
    zero_speed_loads: tuple[float, float]  # of the last one with VERES's loads at zero speed


def motions(ship: Ship) -> list[Motion]:
    """Return heave and pitch in head waves from equations of motion with the loads of VERES.

    Args:
        ship: The ship.
    """
    zero = (CubicSpline(ship.frequency, table[..., 0]) for table in (ship.added_mass, ship.damping))
    added, damping = zero
    at_rest = read_mss(ship.path, 0.0, 0.0, "load")
    rows = []
    for speed in ship.speed.tolist():
        table, loads = (read_mss(ship.path, 0.0, speed, kind) for kind in ("motion", "load"))
        head = int(np.argmin(np.abs(np.abs(table.heading) - np.pi)))
        for ratio in RATIOS:
            w = float(np.sqrt(2.0 * np.pi * GRAVITY / (ratio * ship.length)))
            k, place = w * w / GRAVITY, [HEAVE, PITCH]
            met = w + k * speed
            own = CubicSpline(table.frequency, table.values[:, head, place])(w)
            force = CubicSpline(loads.frequency, loads.values[:, head, place])(w)
            still = CubicSpline(at_rest.frequency, at_rest.values[:, head, place])(w)
            block = np.ix_(place, place)
            rigid = ship.stiffness[block] - met * met * ship.body[block]
            limit = added(ship.frequency[-1])[block]
            found = []
            for method in METHODS:
                waves = radiation(added(met)[block], damping(met)[block], limit, met, speed, method)
                found.append(_response(rigid + waves, force, ship.centre) / np.abs(own))
            last = _response(rigid + waves, still, ship.centre) / np.abs(own)
            values = (float(abs(own[0])), float(abs(own[1])) / k)
            pairs = [(float(heave), float(pitch)) for heave, pitch in (*found, last)]
            rows.append(Motion(speed, ratio, values, tuple(pairs[:-1]), pairs[-1]))
    return rows


def radiation(
    added: Array, damping: Array, limit: Array, w: float, speed: float, method: str
) -> Array:
    """Return the force (2, 2) of radiated waves in heave and pitch per motion, opposite sign.

    Args:
        added: Added mass (2, 2) at zero speed.
        damping: Damping (2, 2) at zero speed.
        limit: Added mass (2, 2) at infinite frequency.
        w: Frequency of encounter [rad/s].
        speed: Forward speed [m/s].
        method: One of `METHODS`.
    """
    impedance = damping + 1j * w * added
    velocity = 1j * w * np.eye(2)
    if method == "none":
        return np.asarray(impedance @ velocity)
    velocity[0, 1] += speed
    force = impedance @ velocity
    momentum = limit @ velocity
    if method == "forward speed":
        momentum = force / (1j * w)
    force[1] -= speed * momentum[0]
    return np.asarray(force)


def _response(dynamic: Array, force: Array, centre: float) -> Array:
    """Size (2,) of heave and pitch at the mass centre under a force there."""
    about_origin = np.array([force[0], force[1] - centre * force[0]])
    heave, pitch = np.linalg.solve(dynamic, about_origin)
    return np.asarray(np.abs(np.array([heave - centre * pitch, pitch])))
