"""Causes around the hull: wind, current, waves, a line; shapes differ from the library's laws."""

import numpy as np

from validation.practice.boats import stack_forces
from validation.practice.cause import Cause, Rng, random_signal
from validation.practice.motion import Array, Boat, Flow, Motion, Whole


def wind(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add gusty wind with coefficient curves of its angle.

    The force is proportional to the square of the relative wind speed. Curves after R. M.
    Isherwood, RINA 1973, rounded; end-on about half of beam-on.
    """
    beam, toward, speed = 20.0 * s * boat.push, float(rng.uniform(-np.pi, np.pi)), 4.0 * boat.scale
    gusts = random_signal(rng, 0.4 / boat.scale, 2.5 / boat.scale)

    def blowing(gusty: float) -> Cause:
        def force(b: Boat, m: Motion) -> Array:
            air = speed * (1.0 + gusty * gusts(m.t, m.run))
            psi = m.q[5]
            along = air * np.cos(toward - psi) - m.nu[0]
            across = air * np.sin(toward - psi) - m.nu[1]
            pressure, angle = beam * (along**2 + across**2) / speed**2, np.arctan2(across, along)
            Y = pressure * np.sin(angle) * (1.0 - 0.08 * np.cos(2 * angle))
            X = pressure * 0.5 * np.cos(angle) * (1.0 + 0.1 * np.cos(2 * angle))
            return stack_forces(psi.size, X=X, Y=Y, N=0.02 * b.length * np.cos(angle) * Y)

        return Cause("wind", {"force_N": beam, "toward_rad": toward}, force=force)

    mean = blowing(0.0)
    return Cause("wind", mean.parameters, force=blowing(0.06).force, known=mean)


def current(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a current that varies in time and across."""
    speed, toward = 0.08 * s * boat.scale, rng.uniform(-np.pi, np.pi)
    north, east = float(speed * np.cos(toward)), float(speed * np.sin(toward))
    slow, shear = 2 * np.pi / (30.0 * boat.scale), 0.01 / boat.length

    def flow(t: Array, q: Array, run: Whole) -> Flow:
        rises = (
            1.0
            + 0.1 * np.sin(slow * t + 2.0 * run)
            + shear * np.clip(q[1], -10 * boat.length, 10 * boat.length)
        )
        return Flow(north * rises, east * rises)

    return Cause("current", {"north_mps": north, "east_mps": east}, water=flow)


def wave_forcing(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add narrow-band irregular waves in the plane, and in roll if the boat rolls."""
    w = float(rng.uniform(2.6, 4.0)) / boat.scale
    sizes = np.array([4.0, 5.0, 0.0, 25.0 * boat.draught, 0.0, 0.6 * boat.length]) * s * boat.push
    courses = []
    for axis in range(6):
        courses.append(
            random_signal(rng, 0.85 * w, 1.15 * w, 12)
            if axis in boat.free and sizes[axis]
            else None
        )

    def force(b: Boat, m: Motion) -> Array:
        return np.array(
            [
                np.zeros_like(m.t) if c is None else a * c(m.t, m.run)
                for a, c in zip(sizes, courses, strict=True)
            ]
        )

    nothing = Cause("wave_forcing")
    return Cause("wave_forcing", {"frequency_radps": w}, force=force, known=nothing)


def tether(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a line from the stern to a fixed point.

    It is slack, then stiffens as it straightens, and has drag.
    """
    L, bearing = boat.length, rng.uniform(-np.pi, np.pi)
    north, east = float(3.0 * L * np.cos(bearing)), float(3.0 * L * np.sin(bearing))
    pull, reach = 6.0 * s * boat.push, 5.0 * L

    def force(b: Boat, m: Motion) -> Array:
        x, y, psi = m.q[0], m.q[1], m.q[5]
        c, n = np.cos(psi), np.sin(psi)
        to_north, to_east = north - x + L / 2 * c, east - y + L / 2 * n
        distance = np.sqrt(to_north**2 + to_east**2 + (0.05 * L) ** 2)
        tension = (
            pull
            * (1.0 + (distance / reach) ** 3 / (1.0 + 0.1 * (distance / reach) ** 3))
            / distance
        )
        drag = 0.4 * pull / (0.5 * b.scale)
        X = tension * (c * to_north + n * to_east) - drag * m.nu[0]
        Y = tension * (c * to_east - n * to_north) - drag * (m.nu[1] - L / 2 * m.nu[5])
        return stack_forces(x.size, X=X, Y=Y, N=-L / 2 * Y)

    where = {"north_m": north, "east_m": east}
    return Cause("tether", where, force=force, not_compared=tuple(where))
