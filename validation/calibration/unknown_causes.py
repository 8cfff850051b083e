"""Further causes outside the library of candidate effects: plausible faults of real boats.

No candidate effect of boatsim has the form of any of these causes. Every maker takes a boat, a
random generator and a strength from 0 to 1, as those of `validation.practice` do.
"""

from collections.abc import Callable, Mapping

import numpy as np
from scipy.signal import lfilter

from validation.calibration.vessels import PLANS
from validation.practice.boats import stack_forces
from validation.practice.cause import Cause, GoalMap, Maker, Rng, random_sign, resistance
from validation.practice.drives import apply_dynamics, usual_thrust
from validation.practice.hulls import usual_rate
from validation.practice.motion import RUNS, Array, Boat, Motion

SAME_TIME = 1e-9  # [s] smaller differences are rounding


class LaggedSignal:
    """First-order lag of a signal of the motion, for forces with memory.

    A simulation evaluates a force at increasing times, and the lag keeps its state between these
    calls. It starts from a settled state when the time goes back. A whole course in one call (all
    runs at every time) is filtered at once.
    """

    def __init__(self, time_constant: float, signal: Callable[[Motion], Array]) -> None:
        """Set the lag.

        Args:
            time_constant: Time constant [s].
            signal: Returns the signal (B,) of a motion.
        """
        self.time_constant = time_constant
        self.signal = signal
        self.time: Array | None = None
        self.state = np.zeros(0)

    def __call__(self, m: Motion) -> Array:
        """Return the lagged signal (B,)."""
        if is_whole_course(m):
            return self.filtered(m)
        signal = self.signal(m)
        if self.time is None or self.time.shape != m.t.shape:
            self.state = signal
        elif np.any(m.t < self.time - SAME_TIME):
            self.state = signal
        else:
            elapsed = np.maximum(m.t - self.time, 0.0)
            self.state = signal + (self.state - signal) * np.exp(-elapsed / self.time_constant)
        self.time = m.t
        return self.state

    def filtered(self, m: Motion) -> Array:
        """Return the lagged signal (B,) of a whole course that starts from a settled state."""
        signal = self.signal(m).reshape(-1, RUNS)
        keep = np.exp(-(m.t[RUNS] - m.t[0]) / self.time_constant)
        settled = keep * signal[:1]
        found, _ = lfilter([1.0 - keep], [1.0, -keep], signal, axis=0, zi=settled)
        return np.asarray(found).ravel()


def is_whole_course(m: Motion) -> bool:
    """Whether a motion holds all runs of a trial at each of several times."""
    first = np.tile(np.arange(RUNS), 2)
    return m.t.size >= 2 * RUNS and np.array_equal(m.run[: 2 * RUNS], first)


def usual_speed(boat: Boat) -> float:
    """Return a surge speed of the boat's manoeuvres [m/s]."""
    if boat.cruise:
        return boat.cruise
    if boat.name == "blueboat":
        return 0.9
    return usual_rate(boat, 0)


def usual_output(boat: Boat) -> float:
    """Return a usual output of one propeller: thrust [N], for the Otter shaft rate [rad/s]."""
    if boat.name == "otter":
        return 60.0
    return usual_thrust(boat)


# ---- drives


def propeller_interaction(boat: Boat, rng: Rng, s: float) -> Cause:
    """Let one propeller lose output while the other runs, as in the other's wash or on one battery.

    The loss depends on the size of the other's output and not on its direction.
    """
    loss, usual = 0.6 * s, usual_output(boat)
    weak, other = rng.permutation(boat.drive.thrusts)

    def drive(b: Boat, dt: float) -> GoalMap:
        def apply(goal: Array, k: int) -> Array:
            goal = goal.copy()
            goal[weak] *= 1.0 - loss * np.tanh(np.abs(goal[other]) / usual)
            return goal

        return apply

    return Cause("outside_library:propeller_interaction", drive=drive)


def asymmetric_lag(boat: Boat, rng: Rng, s: float) -> Cause:
    """Let the propellers gain output quickly and lose it slowly, as with a freewheeling clutch."""
    slow = 2.0 * s * boat.scale
    quick = 0.1 * slow

    def drive(b: Boat, dt: float) -> GoalMap:
        def follow(y: Array, goal: Array) -> Array:
            time_constant = np.where(np.abs(goal) < np.abs(y), slow, quick)
            return np.asarray(goal + (y - goal) * np.exp(-dt / time_constant))

        return apply_dynamics(b.drive.thrusts, follow)

    return Cause("outside_library:asymmetric_lag", drive=drive)


def drive_hunting(boat: Boat, rng: Rng, s: float) -> Cause:
    """Let the steering hunt about its goal in a limit cycle: a triangular wave of fixed period.

    It hunts under load only: amidships it rests.
    """
    period, size, load = rng.uniform(2.0, 3.5) * boat.scale, 0.3 * s, 0.05
    begin = rng.uniform(0.0, 1.0, RUNS)

    def drive(b: Boat, dt: float) -> GoalMap:
        rows = list(b.drive.angles)

        def apply(goal: Array, k: int) -> Array:
            part = (k * dt / period + begin) % 1.0
            wave = 4.0 * np.abs(part - 0.5) - 1.0
            goal = goal.copy()
            angle = np.abs(goal[rows])
            goal[rows] += size * wave * angle / (angle + load)
            return goal

        return apply

    return Cause("outside_library:drive_hunting", drive=drive)


# ---- hulls in the plane


def bank_suction(boat: Boat, rng: Rng, s: float) -> Cause:
    """Draw the hull to a straight shore and turn its bow away from it.

    The suction grows with the square of the speed and decays with the distance. It stays constant
    closer than half a length, where the boat would touch the shore.
    """
    bearing, away, push = rng.uniform(-np.pi, np.pi), 4.0 * boat.length, 150.0 * s * boat.push

    def force(b: Boat, m: Motion) -> Array:
        distance = away - m.q[0] * np.cos(bearing) - m.q[1] * np.sin(bearing)
        near = np.maximum(distance, 0.5 * b.length) / b.length
        suction = push * (m.through[0] / usual_speed(b)) ** 2 / (1.0 + near**2)
        X = suction * np.cos(bearing - m.q[5])
        Y = suction * np.sin(bearing - m.q[5])
        return stack_forces(X.size, X=X, Y=Y, N=-0.15 * b.length * Y)

    return Cause("outside_library:bank_suction", force=force)


def spray_rail(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a side force in a window of surge speed, as of a vibrating keel or one spray rail."""
    push, side = 80.0 * s * boat.push, random_sign(rng)
    middle, width = 0.85 * usual_speed(boat), 0.2 * usual_speed(boat)
    if boat.cruise:  # a ship's speed varies less than a small boat's
        width = 0.05 * boat.cruise

    def force(b: Boat, m: Motion) -> Array:
        Y = side * push * np.exp(-(((m.through[0] - middle) / width) ** 2))
        return stack_forces(Y.size, Y=Y, N=0.2 * b.length * Y)

    return Cause("outside_library:spray_rail", force=force)


def weed_bunch(boat: Boat, rng: Rng, s: float) -> Cause:
    """Let a bunch of weed drag at one side of the hull and come off in the middle of each run."""
    drag, y = 60.0 * s * boat.push, 0.2 * random_sign(rng) * boat.length
    comes_off = rng.uniform(14.0, 26.0, RUNS) * boat.scale

    def force(b: Boat, m: Motion) -> Array:
        speed = m.through[0] / usual_speed(b)
        X = np.where(m.t < comes_off[m.run], -drag * speed * np.abs(speed), 0.0)
        return stack_forces(X.size, X=X, N=-y * X)

    return Cause("outside_library:weed_bunch", force=force)


def drift_moment(boat: Boat, rng: Rng, s: float) -> Cause:
    """Turn the boat to one side whenever it drifts, to either side: a moment of u |v|.

    A bent centreboard or a twisted skeg acts so.
    """
    usual = usual_speed(boat) * usual_rate(boat, 1)
    size = 120.0 * s * boat.push * 0.25 * boat.length * random_sign(rng) / usual

    def force(b: Boat, m: Motion) -> Array:
        return stack_forces(m.t.size, N=size * m.through[0] * np.abs(m.through[1]))

    return Cause("outside_library:drift_moment", force=force)


def flooded_tank(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add the yaw moment of a free-flooding tank: its water follows the hull's rotation slowly."""
    size = 6.0 * s * resistance(boat, 5, usual_rate(boat, 5))
    water_rate = LaggedSignal(rng.uniform(2.0, 4.0) * boat.scale, lambda m: m.nu[5])

    def force(b: Boat, m: Motion) -> Array:
        return stack_forces(m.t.size, N=size * (water_rate(m) - m.nu[5]))

    return Cause("outside_library:flooded_tank", force=force)


# ---- hulls that roll


def roll_tank(boat: Boat, rng: Rng, s: float) -> Cause:
    """Add a roll moment with memory: water in a tank runs after the heel of the hull."""
    size = 0.15 * s * boat.c["righting"]
    surface = LaggedSignal(rng.uniform(0.5, 1.0) * boat.scale, lambda m: m.q[3])

    def force(b: Boat, m: Motion) -> Array:
        return stack_forces(m.t.size, K=size * surface(m))

    return Cause("outside_library:roll_tank", force=force)


def one_sided_rub(boat: Boat, rng: Rng, s: float) -> Cause:
    """Damp the roll on one side of upright only, as a fender that touches the water there."""
    size, side = 3.0 * s * resistance(boat, 3, usual_rate(boat, 3)), random_sign(rng)
    soft = 0.005  # [rad] over which the fender dips in

    def force(b: Boat, m: Motion) -> Array:
        wet = 0.5 + 0.5 * np.tanh(side * m.q[3] / soft)
        return stack_forces(m.t.size, K=-size * wet * m.nu[3])

    return Cause("outside_library:one_sided_rub", force=force)


IN_THE_PLANE = (drift_moment, flooded_tank)
OF_FREE_SPEED = (weed_bunch, spray_rail)
OF_PROPELLERS = (asymmetric_lag, bank_suction)
OF_ROLL = (roll_tank, one_sided_rub)  # the Otter rolls too little to show them
FURTHER: Mapping[str, tuple[Maker, ...]] = {
    "blueboat": (*IN_THE_PLANE, *OF_FREE_SPEED, *OF_PROPELLERS, propeller_interaction),
    "catamaran": (*IN_THE_PLANE, *OF_FREE_SPEED, *OF_PROPELLERS, drive_hunting),
    "eastward_ho": (*IN_THE_PLANE, *OF_ROLL, drive_hunting),
    "joystick_boat": (
        *IN_THE_PLANE,
        *OF_FREE_SPEED,
        *OF_PROPELLERS,
        propeller_interaction,
        drive_hunting,
    ),
    "mariner": (*IN_THE_PLANE, *OF_FREE_SPEED, drive_hunting),
    "martin_tank_model": OF_ROLL,
    "otter": (*IN_THE_PLANE, *OF_FREE_SPEED, *OF_PROPELLERS, propeller_interaction),
}
UNKNOWN: Mapping[str, tuple[Maker, ...]] = {
    vessel: (*plan.strange, *FURTHER[vessel]) for vessel, plan in PLANS.items()
}
