"""Recording plan of each vessel: rows, instruments and plausible causes."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from validation.practice import drives, hulls, outside
from validation.practice.cause import Maker
from validation.practice.sail import LEAD, Grid

INSTRUMENTS = (
    hulls.camera_scale,
    hulls.heading_deviation,
    hulls.heading_offset,
    hulls.position_frame_error,
    hulls.clock_offset,
)
SURROUNDINGS = (
    outside.wind,
    outside.current,
    outside.wave_forcing,
    outside.tether,
    drives.command_delay,
    hulls.extra_mass,
)
LINEAR_HULL = (hulls.lateral_centre_shift, hulls.quadratic_damping, hulls.damping_error)
AROUND = (*SURROUNDINGS, *LINEAR_HULL, *INSTRUMENTS)  # causes of any boat in the plane
STEERED = (drives.steering_offset, drives.steering_backlash, drives.steering_rate_limit)
OUTSIDE = (hulls.bilge_pump, hulls.eddies, hulls.lifting_hull, drives.seized_motor)
PUSHED = (drives.thrust_deadband, drives.thrust_gain_error, drives.thrust_loss_with_speed)


@dataclass(frozen=True)
class Plan:
    """Recording plan of one vessel."""

    length: float  # [m]
    dt: float  # [s] fine step
    every: int  # fine steps per row
    noise: Mapping[
        str, float
    ]  # usual sd by instrument family [m, rad]; a trial has 0.7 to 1.3 of it
    single: tuple[Maker, ...]
    strange: tuple[Maker, ...]  # causes outside the library
    kept: bool = True  # whether a track keeper may conceal effects

    def grid(self) -> Grid:
        """Return the grid of 40 s, Froude-scaled from 1.2 m."""
        scale = sqrt(self.length / 1.2)
        rows = max(round(40.0 * scale / (self.dt * self.every)) + 1, 241)
        return Grid(self.dt, self.every, rows, round(1.0 + LEAD * scale / self.dt))


CAMERA = {"position": 0.0035, "heading": 0.012}

PLANS = {
    "catamaran": Plan(
        1.0,
        0.0375,
        4,
        CAMERA,
        (
            *AROUND,
            *STEERED,
            *PUSHED,
            drives.thrust_lag,
            hulls.mass_centre_shift,
            hulls.added_mass_coriolis,
        ),
        OUTSIDE,
    ),
    "eastward_ho": Plan(
        30.5,
        0.25,
        2,
        {"position": 0.4, "heading": 2e-3, "roll": 2e-3},
        (
            drives.rudder_stall,
            drives.steering_rate_limit,
            drives.steering_offset,
            drives.steering_backlash,
            hulls.quadratic_damping,
            hulls.righting_arm_stiffening,
            hulls.metacentric_height_error,
            outside.current,
            outside.wave_forcing,
            hulls.heading_offset,
            drives.command_delay,
            hulls.clock_offset,
        ),
        (hulls.bilge_pump, hulls.shifting_cargo),
    ),
    "joystick_boat": Plan(
        1.2,
        0.04,
        4,
        CAMERA,
        (
            *SURROUNDINGS,
            *INSTRUMENTS,
            *STEERED,
            *PUSHED,
            drives.weak_reverse,
            drives.thrust_imbalance,
            drives.prop_walk,
            hulls.mass_centre_shift,
            hulls.added_mass_coriolis,
        ),
        OUTSIDE,
    ),
    "martin_tank_model": Plan(
        1.805,
        0.025,
        2,
        {"roll": 2e-3},
        (
            hulls.quadratic_damping,
            hulls.cubic_damping,
            hulls.righting_arm_stiffening,
            hulls.metacentric_height_error,
            hulls.steady_force,
            outside.wave_forcing,
        ),
        (hulls.stiction, hulls.shifting_cargo),
        kept=False,
    ),
    "otter": Plan(
        2.0,
        0.0375,
        4,
        {"position": 0.015, "heading": 0.005, "heave": 0.01, "roll": 3e-3, "pitch": 3e-3},
        (*AROUND, hulls.added_mass_coriolis),
        OUTSIDE,
    ),
}
