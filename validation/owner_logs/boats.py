"""Three boats sampled from a seed among plausible kinds, and the particulars their owners know."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from validation.owner_logs.plant import RHO, Hull, Plant, Propeller, Rudder, resistance, thrust

Rng = np.random.Generator


@dataclass(frozen=True)
class Boat:
    """A boat with its drives and the particulars that its owner specifies."""

    name: str
    plant: Plant
    helm_most: float  # [rad] largest angle of rudder or outboards; 0: steered by thrusters
    # revolutions are this power of the command: 0.5 where the controller is linear in thrust
    curve: float
    lag: float  # [s] of the drives
    helm_rate: float  # [rad/s]
    top_rpm: float
    options: tuple[str, ...]  # of `boatsim new`
    channels: tuple[str, ...]  # thrust commands as `boatsim new` calls them
    helms: tuple[str, ...]  # angle commands
    helm_sign: float  # sign of the vessel's angles for helm to starboard
    stated: tuple[float, ...]  # [N] full thrusts as the vessel has them

    @property
    def length(self) -> float:
        """[m]."""
        return self.plant.hull.length

    @property
    def scale(self) -> float:
        """Return Froude's time scale relative to a boat of 2 m."""
        return sqrt(self.length / 2.0)


def sample_near(rng: Rng, value: float, share: float) -> float:
    """Sample a value within a share of another."""
    return float(value * (1.0 + share * rng.uniform(-1.0, 1.0)))


def sample_hull(
    rng: Rng, length: float, beam: float, draught: float, mass: float, hulls: int = 1
) -> Hull:
    """Sample a hull of these sizes with hydrodynamic coefficients around usual values."""
    wide = 0.3 * beam if hulls == 2 else beam
    wetted = hulls * sample_near(rng, 1.7 * length * draught + 0.75 * length * wide, 0.1)
    sway = sample_near(rng, 0.45 * RHO * pi * draught**2 * length * hulls, 0.3)
    yaw = sample_near(rng, 0.07 * sway * length**2, 0.3)
    inertia = mass * sample_near(rng, 0.25, 0.1) ** 2 * length**2 + (
        mass * 0.12 * beam**2 if hulls == 2 else 0.0
    )
    return Hull(
        length,
        beam,
        draught,
        hulls,
        mass,
        inertia,
        (sample_near(rng, 0.09, 0.4) * mass, sway, yaw, sway * length * rng.uniform(-0.03, 0.05)),
        wetted,
        sample_near(rng, 0.35, 0.5),
        sample_near(rng, 0.006, 0.5),
        sample_near(rng, 0.9, 0.3),
        rng.uniform(-0.3, 0.2),
        sample_near(rng, 0.8, 0.3),
        rng.uniform(-0.4, -0.2),
        sample_near(rng, 0.12, 0.5) * (inertia + yaw) / sqrt(length / 2.0),
        (0.35 * beam * beam, 0.3 * beam * length, rng.uniform(-0.05, 0.1) * length),
    )


def top_speed(plant: Plant) -> float:
    """Return the speed [m/s] at full ahead, in still water and air."""
    low, high = 0.0, 20.0
    for _ in range(50):
        u = 0.5 * (low + high)
        left = sum(thrust(p, 1.0, u) for p in plant.propellers) - resistance(plant.hull, u)
        low, high = (u, high) if left > 0.0 else (low, u)
    return low


def owner_particulars(rng: Rng, plant: Plant, draught: bool) -> list[str]:
    """Return the sizes that the owner specifies."""
    h = plant.hull
    found = [
        "--length",
        f"{sample_near(rng, h.length, 0.01):.2f}",
        "--beam",
        f"{sample_near(rng, h.beam, 0.02):.2f}",
    ]
    found += ["--mass", f"{sample_near(rng, h.mass, 0.1):.3g}", "--hulls", str(h.hulls)]
    found += ["--draught", f"{sample_near(rng, h.draught, 0.08):.2g}"] if draught else []
    return [*found, "--speed", f"{sample_near(rng, top_speed(plant), 0.06):.2g}"]


def sample_mounts(rng: Rng, plant: Plant, option: str) -> tuple[list[str], list[float]]:
    """Return positions and thrusts of the drives, and the full thrusts [N] that are specified."""
    found, full = [], []
    factor = sample_near(rng, 1.0, 0.12)
    for p in plant.propellers:
        place = f"{sample_near(rng, p.x, 0.04):.2f},{p.y:.2f}"
        most = float(f"{p.full * factor:.2g}")
        full.append(most)
        found.append(f"{option}={place},{most:g},{p.astern * most:.2g}")
    return found, full


def drive_names_for_new(plant: Plant) -> tuple[str, ...]:
    """Return the drives under their names in `boatsim new`."""
    if len(plant.propellers) == 1:
        return ("motor",)
    return tuple("starboard" if p.y > 0 else "port" for p in plant.propellers)


def build_boat(
    rng: Rng,
    name: str,
    plant: Plant,
    option: str,
    helm_most: float,
    curve: float,
    lag: float,
    helm_rate: float,
    top_rpm: float,
    draught: bool = True,
) -> Boat:
    """Return the boat with the options its owner would give to `boatsim new`."""
    places, full = sample_mounts(rng, plant, option)
    options = [*owner_particulars(rng, plant, draught), *places]
    if plant.rudder:
        options.append(
            f"--rudder={plant.rudder.x:.2f},{sample_near(rng, plant.rudder.area, 0.1):.2g}"
        )
    names = drive_names_for_new(plant)
    steers: tuple[str, ...] = ()
    if plant.rudder:
        steers = ("rudder_rad",)
    elif helm_most:
        steers = tuple(f"steer_{n}_rad" for n in names)
    return Boat(
        name,
        plant,
        helm_most,
        curve,
        lag,
        helm_rate,
        top_rpm,
        tuple(options),
        tuple(f"thrust_{n}_N" for n in names),
        steers,
        1.0 if plant.rudder else -1.0,
        tuple(full),
    )


def workboat(rng: Rng) -> Boat:
    """Sample a boat of 4 to 5 m of aluminium with two steered outboards on one wheel."""
    L = rng.uniform(4.2, 5.2)
    mass = sample_near(rng, 620.0, 0.15) * (L / 4.6) ** 3
    full, y = sample_near(rng, 650.0, 0.15), sample_near(rng, 0.38, 0.1)
    motors = tuple(
        Propeller(
            -0.47 * L,
            side * y,
            full,
            sample_near(rng, 0.7, 0.1),
            sample_near(rng, 7.0, 0.1),
            0.05,
            0.045,
            True,
        )
        for side in (-1.0, 1.0)
    )
    plant = Plant(sample_hull(rng, L, 0.4 * L, sample_near(rng, 0.26, 0.1), mass), motors)
    return build_boat(rng, "workboat", plant, "--steered", 0.52, 0.5, 0.35, 0.6, 5200.0)


def survey_catamaran(rng: Rng) -> Boat:
    """Sample a boat of about 2 m with two fixed electric thrusters."""
    L = rng.uniform(1.6, 2.4)
    mass = sample_near(rng, 60.0, 0.15) * (L / 2.0) ** 3
    full, y, astern = (
        sample_near(rng, 95.0, 0.2),
        sample_near(rng, 0.36, 0.1),
        sample_near(rng, 0.75, 0.1),
    )
    motors = tuple(
        Propeller(-0.4 * L, side * y, full, astern, 4.2, 0.05, 0.012) for side in (-1.0, 1.0)
    )
    plant = Plant(sample_hull(rng, L, 0.52 * L, sample_near(rng, 0.14, 0.1), mass, 2), motors)
    return build_boat(rng, "survey_catamaran", plant, "--thruster", 0.0, 0.5, 0.15, 1.0, 1800.0)


def launch(rng: Rng) -> Boat:
    """Sample a boat of 6 to 8 m with one screw and a rudder."""
    L = rng.uniform(6.2, 7.8)
    mass = sample_near(rng, 3600.0, 0.15) * (L / 7.0) ** 3
    screw = Propeller(
        -0.40 * L, 0.0, sample_near(rng, 3600.0, 0.15), sample_near(rng, 0.6, 0.1), 5.6, 0.2, 0.28
    )
    plant = Plant(
        sample_hull(rng, L, 0.34 * L, sample_near(rng, 0.6, 0.1), mass),
        (screw,),
        Rudder(-0.46 * L, 0.21, 2.4),
    )
    return build_boat(rng, "launch", plant, "--thruster", 0.6, 1.0, 0.8, 0.25, 1500.0, draught=True)


def ship_model(rng: Rng) -> Boat:
    """Sample a 3 m model with a screw and a rudder."""
    L = rng.uniform(2.7, 3.4)
    mass = sample_near(rng, 150.0, 0.15) * (L / 3.0) ** 3
    screw = Propeller(
        -0.44 * L, 0.0, sample_near(rng, 32.0, 0.15), sample_near(rng, 0.65, 0.1), 2.4, 0.25, 0.012
    )
    plant = Plant(
        sample_hull(rng, L, 0.16 * L, sample_near(rng, 0.16, 0.08), mass),
        (screw,),
        Rudder(-0.48 * L, 0.011, 2.5),
    )
    return build_boat(rng, "ship_model", plant, "--thruster", 0.6, 0.5, 0.25, 0.35, 900.0)


def rib(rng: Rng) -> Boat:
    """Sample a boat of 5 to 6 m with one steered outboard, driven at displacement speeds."""
    L = rng.uniform(4.8, 6.0)
    mass = sample_near(rng, 850.0, 0.15) * (L / 5.4) ** 3
    motor = (
        Propeller(
            -0.46 * L,
            0.0,
            sample_near(rng, 1500.0, 0.15),
            sample_near(rng, 0.6, 0.1),
            8.5,
            0.05,
            0.06,
            True,
        ),
    )
    plant = Plant(sample_hull(rng, L, 0.42 * L, sample_near(rng, 0.3, 0.1), mass), motor)
    return build_boat(rng, "rib", plant, "--steered", 0.55, 0.5, 0.4, 0.7, 5000.0, draught=False)


KINDS: tuple[Callable[[Rng], Boat], ...] = (workboat, survey_catamaran, launch, ship_model, rib)


def sample_fleet(seed: int) -> list[Boat]:
    """Return three boats in random order: steered by outboards, fixed thrusters, and a rudder."""
    rng = np.random.default_rng([seed, 1])
    outboards, rudders = (workboat, rib), (launch, ship_model)
    chosen = [outboards[int(rng.integers(2))], survey_catamaran, rudders[int(rng.integers(2))]]
    return [kind(rng) for kind in chosen]
