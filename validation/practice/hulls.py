"""Causes in mass, damping and restoring forces, and in the instruments."""

from dataclasses import replace

import numpy as np

from validation.practice.boats import stack_forces
from validation.practice.cause import Cause, Rng, random_sign, random_signal, resistance, scaled
from validation.practice.motion import GRAVITY, RUNS, Array, Boat, Motion

UNITS = {0: "surge_Ns{p}pm{p}", 1: "sway_Ns{p}pm{p}", 3: "roll_Nms{p}", 5: "yaw_Nms{p}"}


def usual_rate(boat: Boat, axis: int) -> float:
    """Return a rate of the boat's manoeuvres [m/s, rad/s]."""
    return {0: 0.4 * boat.scale, 1: 0.15 * boat.scale, 3: 0.6 / boat.scale, 5: 0.35 / boat.scale}[
        axis
    ]


def point_mass_matrix(mass: float, x: float, y: float = 0.0) -> Array:
    """Return the mass matrix (6, 6) of a point mass at the height of the origin."""
    lever = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    return np.block([[mass * np.eye(3), -mass * lever], [mass * lever, -mass * lever @ lever]])


def extra_mass(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a battery forward or aft; a free-floating hull sinks and trims."""
    mass, x = 0.2 * s * boat.mass, float(rng.uniform(-0.25, 0.25)) * boat.length
    own = np.diag([0.0, 0.0, 0.0, *[mass * (0.04 * boat.length) ** 2] * 3])

    def weight(b: Boat, m: Motion) -> Array:
        Z = mass * GRAVITY * np.cos(m.q[3]) * np.cos(m.q[4])
        return stack_forces(Z.size, Z=Z, M=-x * Z)

    return Cause(
        "extra_mass",
        {"mass_kg": mass, "x_m": x},
        boat=lambda b: replace(b, hull=b.hull + point_mass_matrix(mass, x) + own),
        force=weight if boat.tilts else None,
        same=("payload",) if abs(x) < 0.06 * boat.length else (),
    )


def mass_centre_shift(boat: Boat, rng: Rng, s: float) -> Cause:
    """Move the stowed gear: half of the mass lies twice as far off."""
    shift = 0.09 * s * boat.length * random_sign(rng)
    moved = point_mass_matrix(boat.mass / 2, 2 * shift) - point_mass_matrix(boat.mass / 2, 0.0)
    return Cause(
        "mass_centre_shift", {"shift_m": shift}, boat=lambda b: replace(b, hull=b.hull + moved)
    )


def lateral_centre_shift(boat: Boat, rng: Rng, s: float) -> Cause:
    """Move part of the sway damping to the position of a skeg."""
    shift = 0.08 * s * boat.length * random_sign(rng)
    at = 0.4 * boat.length * np.sign(shift)
    share = shift / at

    def force(b: Boat, m: Motion) -> Array:
        d, v, r = share * b.c["sway"], m.through[1], m.through[5]
        return stack_forces(
            v.size, Y=d * v - d * (v + at * r), N=-d * at * (v + at * r) * (1.0 - 0.3 * abs(share))
        )

    return Cause("lateral_centre_shift", {"shift_m": shift}, force=force)


def power_damping(
    boat: Boat, s: float, name: str, power: float, like: int, axes: tuple[int, ...]
) -> Cause:
    """Add damping with a non-integer power to the boat's own damping.

    At a usual rate it is a given share of the boat's own.
    """
    gains = {
        a: 0.9 * s * resistance(boat, a, usual_rate(boat, a)) * usual_rate(boat, a) for a in axes
    }

    def force(b: Boat, m: Motion) -> Array:
        found = np.zeros_like(m.nu)
        for a, gain in gains.items():
            part = m.through[a] - (b.cruise if a == 0 else 0.0)
            found[a] = -gain * np.sign(part) * np.abs(part / usual_rate(b, a)) ** power
        return found

    stated = {
        UNITS[a].format(p=like): gain / usual_rate(boat, a) ** like for a, gain in gains.items()
    }
    return Cause(name, stated, force=force, not_compared=tuple(stated))


def quadratic_damping(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add damping in the manner of the library's quadratic damping."""
    axes = (3,) if boat.free == (3,) else (1, 5) if boat.cruise else (0, 1, 5)
    return replace(
        power_damping(boat, s, "quadratic_damping", 1.85, 2, axes), same=("damping_exponent",)
    )


def cubic_damping(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add damping in the manner of the library's cubic damping."""
    axes = (3,) if 3 in boat.free else (0, 5)
    return power_damping(boat, s, "cubic_damping", 2.9, 3, axes)


def damping_error(boat: Boat, rng: Rng, s: float) -> Cause:
    """Scale the linear damping in each axis, as by weed on the hull."""
    factors = {a: 1.0 + s * rng.uniform(0.3, 0.8) for a in ("surge", "sway", "yaw") if a in boat.c}
    stated = {f"{a}_factor": f for a, f in factors.items()}
    return Cause("damping_error", stated, boat=lambda b: scaled(b, **factors))


def added_mass_coriolis(boat: Boat, rng: Rng, s: float) -> Cause:
    """Reduce the Munk moment, as by separation, or raise it."""
    missing = 0.7 * s * random_sign(rng)
    return Cause(
        "added_mass_coriolis",
        {"fraction": missing},
        boat=lambda b: replace(b, coriolis=b.coriolis + missing),
    )


# ---- roll


def righting_arm_stiffening(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a righting arm curve: a saturating sine or the wall-sided formula."""
    bends = bool(rng.integers(2))
    n, wall = 3.0 * np.sqrt(s), 1 / 3 + 4.0 * s

    def force(b: Boat, m: Motion) -> Array:
        phi, k = m.q[3], b.c["righting"]
        lever = np.sin(n * phi) / n if bends else np.sin(phi) * (1.0 + wall / 2 * np.tan(phi) ** 2)
        return stack_forces(phi.size, K=-k * (lever - phi))

    cubic = float(-n * n / 6 if bends else wall / 2 - 1 / 6)
    return Cause(
        "righting_arm_stiffening",
        {"cubic_perrad2": cubic},
        force=force,
        not_compared=("cubic_perrad2",),
    )


def metacentric_height_error(boat: Boat, rng: Rng, s: float) -> Cause:
    """Place ballast higher or lower than specified."""
    factor = 1.0 + 0.3 * s * random_sign(rng)
    return Cause(
        "metacentric_height_error", {"factor": factor}, boat=lambda b: scaled(b, righting=factor)
    )


def steady_force(boat: Boat, rng: Rng, s: float) -> Cause:
    """Place ballast off the centre line: a moment that falls with the cosine of heel."""
    K = 0.05 * s * boat.c["righting"] * random_sign(rng)
    return Cause(
        "steady_force",
        {"roll_Nm": K},
        force=lambda b, m: stack_forces(m.t.size, K=K * np.cos(m.q[3])),
        # a hull whose righting moment is in proportion to the heel only moves its rest position
        same=("roll_offset",),
    )


# ---- instruments


def camera_scale(boat: Boat, rng: Rng, s: float) -> Cause:
    """Scale each axis of the camera differently."""
    x, y = 0.12 * s * random_sign(rng), 0.12 * s * random_sign(rng)
    stretch = np.array([[1 + x], [1 + y], [1.0], [1.0], [1.0], [1.0]])
    return Cause(
        "camera_scale", {"x_fraction": x, "y_fraction": y}, show=lambda q: np.asarray(q * stretch)
    )


def heading_deviation(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a compass deviation: semicircular and slightly quadrantal."""
    size, phase = 0.2 * s, rng.uniform(-np.pi, np.pi)
    cos, sin = float(size * np.cos(phase)), float(size * np.sin(phase))

    def show(q: Array) -> Array:
        off = cos * np.cos(q[5]) + sin * np.sin(q[5]) + 0.06 * size * np.sin(2 * q[5])
        return np.concatenate([q[:5], q[5:] + off])

    return Cause("heading_deviation", {"cos_rad": cos, "sin_rad": sin}, show=show)


def heading_offset(boat: Boat, rng: Rng, s: float) -> Cause:
    """Mount the compass askew."""
    off = 0.15 * s * random_sign(rng)
    stated = {"offset_rad": off}
    return Cause("heading_offset", stated, show=lambda q: np.concatenate([q[:5], q[5:] + off]))


def position_frame_error(boat: Boat, rng: Rng, s: float) -> Cause:
    """Move the antenna."""
    ahead, side = (
        0.18 * s * boat.length * random_sign(rng),
        0.05 * s * boat.length * random_sign(rng),
    )

    def show(q: Array) -> Array:
        c, n = np.cos(q[5]), np.sin(q[5])
        return np.concatenate([[q[0] + c * ahead - n * side, q[1] + n * ahead + c * side], q[2:]])

    return Cause("position_frame_error", {"forward_m": ahead, "starboard_m": side}, show=show)


def clock_offset(boat: Boat, rng: Rng, s: float) -> Cause:
    """Delay the poses relative to the commands."""
    late = 0.4 * s * boat.scale
    return Cause("clock_offset", {"pose_late_s": late}, late=late, same_by_hand=("command_delay",))


# ---- outside the library


def bilge_pump(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a jet to one side for a second, every few seconds."""
    every, push = rng.uniform(4.0, 7.0) * boat.scale, 40.0 * s * boat.push
    begin = rng.uniform(0.0, every, RUNS)

    def force(b: Boat, m: Motion) -> Array:
        on = 0.5 * (1 + np.tanh((np.cos(2 * np.pi * (m.t - begin[m.run]) / every) - 0.7) / 0.1))
        Y = push * on
        return stack_forces(
            Y.size, Y=Y, K=-b.draught * Y if 3 in b.free else 0.0, N=0.2 * b.length * Y
        )

    return Cause("outside_library:bilge_pump", force=force)


def eddies(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add forces that depend on position: a row of eddies a few lengths apart."""
    k, push = 2 * np.pi / (3.0 * boat.length), 25.0 * s * boat.push
    a, b = rng.uniform(0.0, 2 * np.pi, 2)

    def force(hull: Boat, m: Motion) -> Array:
        north, east = push * np.sin(k * m.q[1] + a), push * np.sin(k * m.q[0] + b)
        c, n = np.cos(m.q[5]), np.sin(m.q[5])
        return stack_forces(c.size, X=c * north + n * east, Y=c * east - n * north)

    return Cause("outside_library:eddies", force=force)


def lifting_hull(boat: Boat, rng: Rng, s: float) -> Cause:
    """Dent the bow: beyond a speed the hull lifts to one side."""
    push, side, from_ = 60.0 * s * boat.push, random_sign(rng), 0.3 * boat.scale

    def force(b: Boat, m: Motion) -> Array:
        Y = side * push * np.clip(m.through[0] / from_ - 1.0, 0.0, 1.5) ** 2
        return stack_forces(Y.size, Y=Y, N=0.3 * b.length * Y)

    return Cause("outside_library:lifting_hull", force=force)


def stiction(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add dry friction in roll, as of a rubbing stern gland or guide."""
    K = 0.004 * s * boat.c["righting"]
    return Cause(
        "outside_library:stiction",
        force=lambda b, m: stack_forces(m.t.size, K=-K * np.tanh(m.nu[3] / 0.02)),
    )


def shifting_cargo(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a weight that moves from side to side at intervals."""
    K, slow = (
        0.04 * s * boat.c["righting"],
        random_signal(rng, 0.3 / boat.scale, 1.2 / boat.scale, 4),
    )
    return Cause(
        "outside_library:shifting_cargo",
        force=lambda b, m: stack_forces(m.t.size, K=K * np.tanh(6 * slow(m.t, m.run))),
    )
