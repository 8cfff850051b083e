"""Vessels of the calibration campaign: those of the practice set and two further ones.

The laws of the further vessels are written from their published formulas, without boatsim. Sources:
linear damping and fixed thrusters: T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed.
2021; polynomial hull forces: M. A. Abkowitz, Lectures on Ship Hydrodynamics, Hy-5, Lyngby 1964,
with the derivatives of M. S. Chislett, J. Stroem-Tejsen, Hy-5, Lyngby 1965.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import prod
from typing import Any

import numpy as np

from validation.practice import drives, hulls, outside
from validation.practice import plans as practice_plans
from validation.practice.boats import (
    AT_ONCE,
    VesselFile,
    added_mass_matrix,
    rigid_body_mass,
    stack_forces,
    thrust_force,
)
from validation.practice.boats import BOATS as PRACTICE_BOATS
from validation.practice.cause import Cause, Rng
from validation.practice.motion import Array, Boat, Drive, Motion
from validation.practice.plans import Plan

# share of the approach speed below which the speed of the Mariner's derivatives is held
SLOWEST = 0.3
# [s] lag of a drive that only has a rate limit; zero would switch the limit off
NO_LAG = 1e-6


def blueboat() -> Boat:
    """Return the BlueBoat: linear damping and two fixed thrusters without lag."""
    file = VesselFile("blueboat")
    damping = file.effect("linear_damping")
    c = {"surge": damping["surge"], "sway": damping["sway"], "yaw": damping["yaw"], "gain": 1.0}
    thrusters = (file.effect("port"), file.effect("starboard"))
    mounts = tuple((thruster["x"], thruster["y"]) for thruster in thrusters)

    def law(c: Mapping[str, float], m: Motion) -> Array:
        u, v, _, _, _, r = m.through
        found = stack_forces(u.size, X=-c["surge"] * u, Y=-c["sway"] * v, N=-c["yaw"] * r)
        straight = np.zeros(u.size)
        for thrust, (x, y) in zip(m.act, mounts, strict=True):
            found += thrust_force(u.size, c["gain"] * thrust, straight, x, y)
        return found

    drive = Drive(lambda u: u, np.zeros(2), np.full(2, AT_ONCE), (0, 1), (), mounts)
    mass = rigid_body_mass(file.table["body"]), added_mass_matrix({})
    return file.boat(mass, law, drive, c, damping=("surge", "sway", "yaw"), thrust=("gain",))


def mariner() -> Boat:
    """Return the Mariner class ship: a polynomial of third order and one rudder.

    The derivatives contain all inertia, that of the water too. The law returns the force that
    gives the rigid body of the vessel file the acceleration of the published model.
    """
    file = VesselFile("mariner")
    hull, length, body = file.effect("abkowitz_hull"), file.table["length"], file.table["body"]
    inertia = np.array([[hull["m22"], hull["m23"]], [hull["m32"], hull["m33"]]])
    speed = hull["speed"]

    def law(c: Mapping[str, float], m: Motion) -> Array:
        u, v, r = m.through[0], m.through[1], m.through[5]
        U = np.maximum(np.hypot(u, v), SLOWEST * speed)
        # positive rudder angles of the published model turn to port
        state = {"u": (u - speed) / U, "v": v / U, "r": r * length / U, "d": -m.act[0], "0": 1.0}
        X, Y, N = (polynomial(hull, axis, state, c["gain"]) for axis in "XYN")
        sway, yaw = np.linalg.solve(inertia, np.array([Y, N])) * U * U / length
        surge = X / hull["m11"] * U * U / length
        mass = body["mass"]
        return stack_forces(
            u.size,
            X=mass * (surge - v * r),
            Y=mass * (sway + u * r),
            N=body["yaw_inertia"] * yaw / length,
        )

    rate = np.array([file.effect("steering_rate_limit")["rate"]])
    drive = Drive(lambda u: u, np.array([NO_LAG]), rate, (), (0,))
    mass = rigid_body_mass(body), added_mass_matrix({})
    return file.boat(mass, law, drive, {"gain": 1.0}, cruise=speed, thrust=("gain",))


def polynomial(hull: Mapping[str, Any], axis: str, state: Mapping[str, Any], gain: float) -> Array:
    """Return the nondimensional force of one axis of an Abkowitz polynomial.

    Args:
        hull: Derivatives by name, for example `Y_vvr` for the coefficient of v v r.
        axis: Letter of the force.
        state: Variables (B,) by their letter.
        gain: Factor of all terms that contain the rudder angle d.
    """
    total: Array = np.zeros_like(state["u"])
    for name, coefficient in hull.items():
        force, _, letters = name.partition("_")
        if force == axis and letters:
            term = coefficient * prod(state[letter] for letter in letters)
            total += gain * term if "d" in letters else term
    return total


def backlash_before_rate_limit(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add play of the linkage before the rate limit of the steering gear.

    The library has a candidate on either side of the limit; recordings hardly separate them.
    """
    cause = drives.steering_backlash(boat, rng, s)
    return replace(cause, same=("reordered_steering_backlash",))


BLUEBOAT = Plan(
    1.2,
    0.04,
    4,
    {"position": 0.02, "heading": 0.01},
    (
        outside.wind,
        outside.current,
        outside.tether,
        drives.command_delay,
        drives.thrust_deadband,
        drives.thrust_lag,
        drives.thrust_imbalance,
        drives.weak_reverse,
        drives.prop_walk,
        hulls.extra_mass,
        hulls.mass_centre_shift,
        hulls.lateral_centre_shift,
        hulls.quadratic_damping,
        hulls.heading_deviation,
        hulls.heading_offset,
        hulls.position_frame_error,
        hulls.clock_offset,
    ),
    (hulls.bilge_pump, hulls.eddies, hulls.lifting_hull, drives.seized_motor),
)
MARINER = Plan(
    160.93,
    0.5,
    2,
    {"position": 1.0, "heading": 2e-3},
    (
        outside.wind,
        outside.current,
        outside.wave_forcing,
        drives.command_delay,
        drives.steering_offset,
        backlash_before_rate_limit,
        hulls.extra_mass,
        hulls.mass_centre_shift,
        hulls.quadratic_damping,
        hulls.heading_deviation,
        hulls.heading_offset,
        hulls.position_frame_error,
        hulls.clock_offset,
    ),
    (hulls.eddies, hulls.lifting_hull),
)
BOATS: Mapping[str, Callable[[], Boat]] = PRACTICE_BOATS | {
    "blueboat": blueboat,
    "mariner": mariner,
}
PLANS: Mapping[str, Plan] = practice_plans.PLANS | {"blueboat": BLUEBOAT, "mariner": MARINER}
