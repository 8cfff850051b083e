"""Causes in motors and steering: deviations of the actuators from their commands."""

from collections.abc import Callable

import numpy as np

from validation.practice.boats import stack_forces, thrust_force
from validation.practice.cause import Cause, GoalMap, Rng, random_sign
from validation.practice.motion import RUNS, Array, Boat, Motion


def usual_thrust(boat: Boat) -> float:
    """Return a usual thrust [N] of one drive."""
    return {"blueboat": 16.0, "catamaran": 6.0, "joystick_boat": 0.6}.get(boat.name, 1.0)


def apply_curve(rows: tuple[int, ...], by: Callable[[Array], Array]) -> GoalMap:
    """Apply a memoryless curve to some actuators."""
    at = list(rows)

    def apply(goal: Array, k: int) -> Array:
        goal = goal.copy()
        goal[at] = by(goal[at])
        return goal

    return apply


def apply_dynamics(rows: tuple[int, ...], follow: Callable[[Array, Array], Array]) -> GoalMap:
    """Let some actuators follow their goals with a state; the first goal initialises it."""
    at, memory = list(rows), dict[str, Array]()

    def apply(goal: Array, k: int) -> Array:
        goal, y = goal.copy(), memory.get("y", goal[at])
        memory["y"] = goal[at] = follow(y, goal[at])
        return goal

    return apply


def weak_reverse(boat: Boat, rng: Rng, s: float) -> Cause:
    """Reduce the thrust astern to k T with a smooth transition."""
    k, soft = 1.0 - 0.45 * s, 0.04 * usual_thrust(boat)

    def curve(T: Array) -> Array:
        return np.asarray(T * (1.0 - (1.0 - k) / (1.0 + np.exp(np.clip(T / soft, -50, 50)))))

    return Cause(
        "weak_reverse",
        {"astern_factor": k},
        drive=lambda b, dt: apply_curve(b.drive.thrusts, curve),
    )


def thrust_lag(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add two lags in series with the same total time as the library's single lag."""
    T = 0.6 * s * boat.scale

    def drive(b: Boat, dt: float) -> GoalMap:
        keep = np.exp(-dt / (T / 2))
        first = apply_dynamics(b.drive.thrusts, lambda y, goal: goal + (y - goal) * keep)
        second = apply_dynamics(b.drive.thrusts, lambda y, goal: goal + (y - goal) * keep)
        return lambda goal, k: second(first(goal, k), k)

    return Cause("thrust_lag", {"time_constant_s": T}, drive=drive)


def command_delay(boat: Boat, rng: Rng, s: float) -> Cause:
    """Delay the commands by a time that varies by a tenth from second to second."""
    late, factors = 0.5 * s * boat.scale, rng.uniform(0.9, 1.1, 4000)

    def drive(b: Boat, dt: float) -> GoalMap:
        past: list[Array] = []

        def apply(goal: Array, k: int) -> Array:
            past.append(goal)
            at = max(len(past) - 1 - late * factors[int(len(past) * dt / b.scale)] / dt, 0.0)
            first, part = int(at), at % 1.0
            return np.asarray((1 - part) * past[first] + part * past[min(first + 1, len(past) - 1)])

        return apply

    return Cause("command_delay", {"delay_s": late}, drive=drive, same_by_hand=("clock_offset",))


def thrust_deadband(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add friction of the shaft with a smooth transition."""
    w = 0.2 * s * usual_thrust(boat)
    return Cause(
        "thrust_deadband",
        {"width_N": w},
        drive=lambda b, dt: apply_curve(
            b.drive.thrusts, lambda T: np.asarray(T - w * np.tanh(T / w))
        ),
    )


def thrust_imbalance(boat: Boat, rng: Rng, s: float) -> Cause:
    """Strengthen one side, slightly more at high thrust."""
    f, usual = 0.2 * s * random_sign(rng), usual_thrust(boat)

    def curve(T: Array) -> Array:
        side = np.array([[1.0], [-1.0]]) * f
        return np.asarray(T * (1.0 + side * (0.9 + 0.2 * np.minimum(np.abs(T) / usual, 1.5))))

    return Cause(
        "thrust_imbalance", {"fraction": f}, drive=lambda b, dt: apply_curve(b.drive.thrusts, curve)
    )


def steering_offset(boat: Boat, rng: Rng, s: float) -> Cause:
    """Bend the mounts and reduce the steering angle slightly."""
    sides = ("middle",) if len(boat.drive.angles) == 1 else ("port", "starboard")
    off = np.array([[0.15 * s * random_sign(rng)] for _ in sides])
    stated = {f"{n}_rad": float(a[0]) for n, a in zip(sides, off, strict=True)}
    return Cause(
        "steering_offset",
        stated,
        drive=lambda b, dt: apply_curve(
            b.drive.angles, lambda x: np.asarray((1 - 0.15 * np.abs(off)) * x + off)
        ),
    )


def steering_backlash(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add play of the linkage; with friction the angle follows gradually."""
    width = 0.3 * s

    def drive(b: Boat, dt: float) -> GoalMap:
        def play(y: Array, goal: Array) -> Array:
            return np.clip(y, goal - width / 2, goal + width / 2)

        creep = 1.0 - np.exp(-dt / (0.05 * b.scale))
        loose = apply_dynamics(b.drive.angles, play)
        slow = apply_dynamics(b.drive.angles, lambda y, goal: np.asarray(y + creep * (goal - y)))
        return lambda goal, k: slow(loose(goal, k), k)

    return Cause("steering_backlash", {"width_rad": width}, drive=drive)


def steering_rate_limit(boat: Boat, rng: Rng, s: float) -> Cause:
    """Limit the rate of the steering gear, more so close to its goal."""
    rate = 0.12 / s / boat.scale

    near = 0.03  # [rad]

    def drive(b: Boat, dt: float) -> GoalMap:
        left = np.exp(-rate * dt / near)

        def turn(y: Array, goal: Array) -> Array:
            """The solution of y' = rate tanh((goal - y) / near); Euler's steps would chatter."""
            return goal - near * np.arcsinh(left * np.sinh((goal - y) / near))

        return apply_dynamics(b.drive.angles, turn)

    return Cause("steering_rate_limit", {"rate_radps": rate}, drive=drive)


def rudder_stall(boat: Boat, rng: Rng, s: float) -> Cause:
    """Let the force saturate near an angle and decrease slightly beyond it."""
    stall = 0.7 - 0.45 * s

    def curve(x: Array) -> Array:
        bent = x / (1.0 + np.abs(x / stall) ** 6) ** (1.0 / 6.0)
        return np.asarray(bent * (1.0 - 0.08 * np.clip(np.abs(x) / stall - 1.0, 0.0, 1.0)))

    return Cause(
        "rudder_stall",
        {"angle_rad": stall},
        drive=lambda b, dt: apply_curve(b.drive.angles, curve),
        not_compared=("angle_rad",),
    )


def prop_walk(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a side force of the propellers.

    It is an odd smooth curve that is three times as strong astern.
    """
    k = 0.15 * s * random_sign(rng)

    def force(b: Boat, m: Motion) -> Array:
        found = np.zeros_like(m.nu)
        for i, (x, _) in zip(b.drive.thrusts, b.drive.mounts, strict=True):
            T = m.act[i]
            Y = k * T * (2.0 / 3.0 - np.tanh(T / (0.1 * usual_thrust(b))) / 3.0)
            found += stack_forces(T.size, Y=Y, N=x * Y)
        return found

    return Cause("prop_walk", {"side_force_per_thrust": k}, force=force)


def thrust_loss_with_speed(boat: Boat, rng: Rng, s: float) -> Cause:
    """Reduce the thrust with the propeller's advance, as K_T falls with J.

    The decrease is slightly steeper at high speed.
    """
    loss = 0.4 * s / boat.scale

    def force(b: Boat, m: Motion) -> Array:
        found, u = np.zeros_like(m.nu), m.through[0]
        for i, a, (x, y) in zip(b.drive.thrusts, b.drive.angles, b.drive.mounts, strict=True):
            lost = loss * u * (0.9 + 0.2 * np.abs(u) / b.scale) * np.abs(m.act[i])
            found -= thrust_force(u.size, lost, m.act[a], x, y)
        return found

    return Cause("thrust_loss_with_speed", {"loss_spm": loss}, force=force)


def thrust_gain_error(boat: Boat, rng: Rng, s: float) -> Cause:
    """Scale the thrust; a nonlinear curve would be another effect."""
    factor = 1.0 + 0.5 * s * random_sign(rng)
    return Cause(
        "thrust_gain_error",
        {"factor": factor},
        drive=lambda b, dt: apply_curve(b.drive.thrusts, lambda T: np.asarray(T * factor)),
    )


# ---- outside the library


def seized_motor(boat: Boat, rng: Rng, s: float) -> Cause:
    """Foul the first propeller for some seconds of each run, so that it stutters."""
    begin, lasts = rng.uniform(6.0, 24.0, RUNS) * boat.scale, 9.0 * boat.scale
    quick = rng.uniform(1.2, 1.8) / boat.scale  # [1/s]
    at = boat.drive.thrusts[0]

    def drive(b: Boat, dt: float) -> GoalMap:
        def apply(goal: Array, k: int) -> Array:
            t = k * dt
            caught = (begin <= t) & (t < begin + lasts) & ((quick * t) % 1.0 < 0.3 + 0.6 * s)
            goal = goal.copy()
            goal[at] = np.where(caught, 0.15 * goal[at], goal[at])
            return goal

        return apply

    return Cause("outside_library:seized_motor", drive=drive)
