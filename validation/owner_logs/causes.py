"""Physical effects that a boat has but its particulars lack, and the accepted names of each."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from validation.owner_logs.boats import Boat, Rng
from validation.owner_logs.plant import Surroundings
from validation.owner_logs.sail import Linkage


@dataclass(frozen=True)
class Cause:
    """One cause: its change of surroundings and linkage, and the effects that name it."""

    make: Callable[[Boat, Rng], tuple[Surroundings, Linkage, str]]
    named: tuple[str, ...]
    fits: Callable[[Boat], bool] = lambda boat: True


def _change_surroundings(**made: object) -> tuple[Surroundings, Linkage]:
    return replace(Surroundings(), **made), Linkage()  # type: ignore[arg-type]


def _default_linkage(boat: Boat, **made: object) -> tuple[Surroundings, Linkage]:
    usual = Linkage(gains=(1.0,) * len(boat.plant.propellers))
    return Surroundings(), replace(usual, **made)  # type: ignore[arg-type]


def _random_vector(rng: Rng, size: float) -> tuple[float, float]:
    way = rng.uniform(0.0, 2.0 * np.pi)
    return size * cos(way), size * sin(way)


def wind(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Add a fresh breeze."""
    speed = rng.uniform(6.0, 9.0)
    return *_change_surroundings(wind=_random_vector(rng, speed)), f"{speed:.1f} m/s"


def current(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Add a current."""
    speed = rng.uniform(0.2, 0.5)
    return *_change_surroundings(current=_random_vector(rng, speed)), f"{speed:.2f} m/s"


def weak_reverse(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Reduce the thrust astern far below the specified value."""
    factor = rng.uniform(0.3, 0.5)
    return *_default_linkage(boat, astern=factor), f"times {factor:.2f}"


def weak_motor(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Weaken one of two drives."""
    factor = rng.uniform(0.55, 0.75)
    gains = (factor, 1.0) if rng.integers(2) else (1.0, factor)
    return *_default_linkage(boat, gains=gains), f"times {factor:.2f}"


def lag(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Let the drives follow slowly."""
    time = rng.uniform(1.0, 2.0) * boat.scale
    return *_default_linkage(boat, lag=time), f"{time:.1f} s"


def delay(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Delay the orders."""
    time = rng.uniform(0.6, 1.2) * boat.scale
    return *_default_linkage(boat, delay=time), f"{time:.1f} s"


def dead_band(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Add a dead band of the throttle."""
    share = rng.uniform(0.15, 0.28)
    return *_default_linkage(boat, dead=share), f"{share:.2f} of full"


def steering_offset(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Offset the neutral helm angle."""
    angle = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.07, 0.14))
    return *_default_linkage(boat, helm_offset=angle), f"{np.degrees(angle):.1f} deg"


def slow_helm(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Slow down the steering gear."""
    rate = boat.helm_most / (rng.uniform(3.0, 5.0) * boat.scale)
    return *_default_linkage(boat, helm_rate=rate), f"{np.degrees(rate):.1f} deg/s"


def load(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Add cargo ahead or astern."""
    mass = rng.uniform(0.25, 0.4) * boat.plant.hull.mass
    at = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 0.32) * boat.length)
    return *_change_surroundings(load=mass, load_at=at), f"{mass:.0f} kg {at:+.1f} m ahead"


def fouling(boat: Boat, rng: Rng) -> tuple[Surroundings, Linkage, str]:
    """Add weed on the hull, or a towed object."""
    factor = rng.uniform(2.5, 4.0)
    return *_change_surroundings(drag=factor), f"times {factor:.1f}"


def _has_two_drives(boat: Boat) -> bool:
    return len(boat.plant.propellers) == 2


def _steers(boat: Boat) -> bool:
    return boat.helm_most > 0.0


CAUSES: dict[str, Cause] = {
    "wind": Cause(wind, ("wind", "fan_wind", "gust", "gust_off_centre")),
    "current": Cause(current, ("current",)),
    "weak reverse": Cause(weak_reverse, ("weak_reverse", "drive_map", "dragged_propeller")),
    "one motor weaker": Cause(weak_motor, ("thrust_imbalance",), _has_two_drives),
    "lag": Cause(lag, ("thrust_lag", "command_delay")),
    "delay": Cause(delay, ("command_delay", "thrust_lag")),
    "dead band": Cause(
        dead_band,
        (
            "command_deadband",
            "thrust_deadband",
            "drive_map",
            "shaft_deadband",
            "pulse_thrust",
            "pwm_thrust",
        ),
    ),
    "steering offset": Cause(steering_offset, ("steering_offset",), _steers),
    "slow helm": Cause(slow_helm, ("rate_limit", "steering_rate_limit", "servo"), _steers),
    "load off centre": Cause(load, ("extra_mass", "mass_centre_shift", "payload")),
    "drag": Cause(
        fouling,
        ("surge_drag", "quadratic_damping", "cubic_damping", "damping_error", "damping_exponent"),
    ),
}
"""Every cause; the entries of the library that name it, ties among them."""
