"""A boat with three drives that turn, in a basin of known depth with a measured current."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.physics.vessel import Vessel
from validation.calibration.bodies.body import (
    LEVER,
    POSE,
    Array,
    Body,
    Rng,
    ambient,
    boat_rates,
    integrate,
    pilot_force,
    steps,
)

DRIVES = {"bow": (0.6, 0.0), "port": (-0.6, -0.25), "starboard": (-0.6, 0.25)}  # ahead, right [m]
AHEAD, ASTERN = 8.0, 5.0  # [N] full thrust of a drive; most propellers give less astern
TURN = 2.2  # [rad] to either side, so that with thrust astern every direction is in reach
WALLS = (-3.0, 3.0, -2.6, 2.6)  # [m] south, north, west, east
REACH = (2.2, 1.8, 2.0)  # [m, m, rad] about the middle, of the poses that the pilot asks for
STAY = 20.0  # [s] that he asks for each
HASTE = (3.0, 3.0, 4.0)  # [N/m, N/m, N m/rad] of the pilot's force
BRAKE = (6.0, 6.0, 4.0)  # [N s/m, N s/m, N m s] of it
OPPOSED = 3.0  # [N] of the drives against each other, which moves nothing
DEPTH = 0.2  # [m] twice the draught, where the coefficients of the vessel file were found
CURRENT = 0.1  # [m/s] largest, to north and to east
# Each drive has a lead battery of nominally 24 V. Neither its voltage nor the current drawn from it
# changes the thrust, because a controller keeps the revolutions.
NOMINAL = 24.0  # [V]
FULLEST, EMPTIEST = 25.5, 23.0  # [V] at rest
SAG = 0.15  # [V/N] under load, about 5 % at full thrust
VOLTMETER = 0.02  # [V] noise
FULL_LOAD = 20.0  # [A] nominal current, at full thrust
AMMETER = 0.1  # [A] noise


def turning_drives() -> Body:
    """A boat with three azimuth drives whose supplies are measured, in a basin with a current.

    The current is uniform and steady in a run, so that Newton's laws hold in axes that move with
    the water: M nu_r' + C(nu_r) nu_r + D nu_r = tau, and the place is that in the water plus the
    current times the time (Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section
    10.3).
    """
    mass, inertia, length = 20.0, 4.0, 1.4
    added = np.array([1.5, 15.0, 2.0])
    damping = np.array([12.0, 40.0, 6.0])
    times = np.arange(0.0, 100.0, 0.2)
    noise = {"position_sd_m": 0.005, "heading_sd_rad": 0.005}
    channels: dict[str, Mapping[str, object]] = {}
    measured: dict[str, object] = {"water_north_mps": {}, "water_east_mps": {}}
    for name in DRIVES:
        channels[f"{name}_N"] = {"low": -ASTERN, "high": AHEAD}
        channels[f"{name}_rad"] = {"low": -TURN, "high": TURN}
        measured[f"{name}_V"] = {"neutral": NOMINAL}
        measured[f"{name}_A"] = {"neutral": FULL_LOAD}
    vessel = Vessel.from_effects(
        name="trial_turning_drives",
        dof=("surge", "sway", "yaw"),
        length=length,
        beam=0.6,
        draught=0.1,
        body={"mass": mass, "roll_inertia": 0.7, "yaw_inertia": inertia},
        effects=[
            {"use": "added_mass", "surge": added[0], "sway": added[1], "yaw": added[2]},
            {"use": "linear_damping", **dict(zip(("surge", "sway", "yaw"), damping, strict=True))},
            {
                "use": "measured_current",
                "on": {"north": "water_north_mps", "east": "water_east_mps"},
            },
            *steered_thrusters(),
        ],
        channels=channels,
        measured=measured,
        diagnosis={
            "facts": {
                "indoors": True,
                "position_fix": "tracking",
                "water_depth_m": DEPTH,
                "walls_m": list(WALLS),
            }
        },
    )
    M = np.array([mass, mass, inertia]) + added

    def run(rng: Rng, factors: Array) -> dict[str, Array]:
        water = np.append(rng.uniform(-CURRENT, CURRENT, 2), np.zeros(4))
        forces = ambient(rng, times, mass, length, (1.0, 1.0, LEVER * length))
        asked = rng.uniform(-1.0, 1.0, (int(times[-1] / STAY) + 1, 3)) * REACH
        against = steps(rng, times, 5.0, -OPPOSED, OPPOSED, 3)
        states, orders = [np.zeros(6)], []
        for i in range(len(times)):
            force = pilot_force(asked[int(times[i] / STAY)], states[-1], HASTE, BRAKE)
            orders.append(drive_orders(force, against[i]))
            if i == len(times) - 1:
                break
            total = forces[i] + factors[3] * drive_force(*orders[-1])

            def rates(s: Array, _: int, total: Array = total) -> Array:
                return boat_rates(s, total, M, factors[:3] * damping) + water

            states.append(integrate(rates, states[-1], times[i : i + 2])[-1])
        pose = np.array(states)[:, :3]
        pose += rng.standard_normal(pose.shape) * [0.005, 0.005, 0.005]
        signals = dict(zip(POSE, pose.T, strict=True))
        signals["water_north_mps"] = np.full(len(times), water[0])
        signals["water_east_mps"] = np.full(len(times), water[1])
        for i, name in enumerate(DRIVES):
            thrust, angle = np.array([order[:, i] for order in orders]).T
            signals |= {f"{name}_N": thrust, f"{name}_rad": angle}
            rest = rng.uniform(EMPTIEST, FULLEST)
            voltage = rest - SAG * np.abs(thrust) + VOLTMETER * rng.standard_normal(len(times))
            signals[f"{name}_V"] = voltage
            drawn = FULL_LOAD * np.abs(thrust) / AHEAD
            signals[f"{name}_A"] = drawn + AMMETER * rng.standard_normal(len(times))
        return signals

    return Body(vessel, times, noise, run, 4)


def steered_thrusters() -> list[dict[str, object]]:
    """Return the tables of the drives."""
    found: list[dict[str, object]] = []
    for name, (x, y) in DRIVES.items():
        on = {"thrust": f"{name}_N", "angle": f"{name}_rad"}
        found.append({"use": "thruster", "name": name, "on": on, "x": x, "y": y})
    return found


def drive_effect() -> Array:
    """Return surge force, sway force and yaw moment (3, 6) per force ahead and to starboard.

    Columns are the force ahead of each drive, then the force to starboard of each.
    """
    x, y = np.array(list(DRIVES.values())).T
    ones, zeros = np.ones(len(x)), np.zeros(len(x))
    ahead, right = np.array([ones, zeros, -y]), np.array([zeros, ones, x])
    return np.column_stack([ahead, right])


def drive_orders(force: Array, against: Sequence[float]) -> Array:
    """Return the thrusts [N] and angles [rad] (2, 3) of the drives for a force.

    Args:
        force: Surge force, sway force [N] and yaw moment [N m].
        against: Forces (3,) [N] of the drives against each other, without a resultant.
    """
    effect = drive_effect()
    silent = np.linalg.svd(effect)[2][3:]  # rows that span the forces without a resultant
    ahead, right = (np.linalg.pinv(effect) @ force + against @ silent).reshape(2, -1)
    thrust, angle = np.hypot(ahead, right), np.arctan2(right, ahead)
    astern = np.abs(angle) > TURN
    angle = np.where(astern, angle - np.pi * np.sign(angle), angle)
    return np.array([np.clip(np.where(astern, -thrust, thrust), -ASTERN, AHEAD), angle])


def drive_force(thrust: Array, angle: Array) -> Array:
    """Return surge force, sway force and yaw moment (3,) of the drives."""
    return drive_effect() @ np.append(thrust * np.cos(angle), thrust * np.sin(angle))
