"""Hooks through which a cause changes a boat; every cause of the set uses a few of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from validation.practice.motion import RUNS, Array, Boat, Flow, Motion, Whole

Rng = np.random.Generator
GoalMap = Callable[
    [Array, int], Array
]  # goals (A, RUNS) and number of the step, from the first row on -> goals
PoseMap = Callable[[Array], Array]  # pose (6, B) -> as the recording shows it


@dataclass(frozen=True)
class Cause:
    """One property that a real boat has and its vessel file lacks."""

    name: str  # name of the effect in the library, or outside_library:NAME
    # parameters shared with the library's law
    parameters: Mapping[str, float] = field(default_factory=dict)
    boat: Callable[[Boat], Boat] | None = None
    # of the step [s]; the closure holds the state
    drive: Callable[[Boat, float], GoalMap] | None = None
    force: Callable[[Boat, Motion], Array] | None = None
    water: Callable[[Array, Array, Whole], Flow] | None = None
    show: PoseMap | None = None
    late: float = 0.0  # [s] latency: the pose in row t is that of t - late
    known: "Cause | None" = None  # the part that is predictable; None: all of it
    not_compared: tuple[str, ...] = ()
    same: tuple[str, ...] = ()  # equivalent effects
    same_by_hand: tuple[str, ...] = ()  # further ones in open-loop trials

    @property
    def measured(self) -> bool:
        """Whether it changes the recording and not the motion."""
        return self.show is not None or self.late != 0.0


Maker = Callable[[Boat, Rng, float], Cause]  # the last argument is a strength from 0 to 1


def apply_number_changes(boat: Boat, causes: Sequence[Cause]) -> Boat:
    """Return the boat with the numbers that its causes change."""
    for cause in causes:
        boat = cause.boat(boat) if cause.boat else boat
    return boat


def sum_of_forces(boat: Boat, causes: Sequence[Cause]) -> Callable[[Motion], Array]:
    """Return the sum of the forces of the causes."""
    acting = [c.force for c in causes if c.force]

    def total(m: Motion) -> Array:
        return sum((f(boat, m) for f in acting), np.zeros_like(m.nu))

    return total


def water_velocity(causes: Sequence[Cause]) -> Callable[[Array, Array, Whole], Flow | None]:
    """Return the velocity of the water at the hulls; None for still water."""
    flows = [c.water for c in causes if c.water]

    def velocity(t: Array, q: Array, run: Whole) -> Flow | None:
        found = [f(t, q, run) for f in flows]
        still = np.zeros(())
        if found:
            return Flow(sum((f.north for f in found), still), sum((f.east for f in found), still))
        return None

    return velocity


def instrument_pose(causes: Sequence[Cause], q: Array) -> Array:
    """Return a pose (6, B) as the instruments show it, without latency."""
    for cause in causes:
        q = cause.show(q) if cause.show else q
    return q


def predictable_parts(causes: Sequence[Cause]) -> tuple[Cause, ...]:
    """Return the predictable parts of the causes."""
    return tuple(c.known or c for c in causes)


# ---- helpers of several causes


def scaled(boat: Boat, **factors: float) -> Boat:
    """Return the boat with some coefficients multiplied by factors."""
    return replace(boat, c={k: v * factors.get(k, 1.0) for k, v in boat.c.items()})


def random_sign(rng: Rng) -> float:
    """Sample a sign."""
    return float(rng.choice([-1.0, 1.0]))


def random_signal(
    rng: Rng, low: float, high: float, n: int = 10
) -> Callable[[Array, Whole], Array]:
    """Return a random signal of rms 1 for each run.

    It is a sum of n sines with circular frequencies from low to high [rad/s].
    """
    w, phase = rng.uniform(low, high, (n, 1)), rng.uniform(0.0, 2 * np.pi, (RUNS, n, 1))

    def course(t: Array, run: Whole) -> Array:
        return np.asarray(np.sqrt(2.0 / n) * np.sin(w * t + phase[run, :, 0].T).sum(axis=0))

    return course


def resistance(boat: Boat, axis: int, speed: float) -> float:
    """Return the nominal hull's resistance to one rate, per rate [N s/m, N m s]."""
    nu = np.zeros((6, 2))
    nu[0] = boat.cruise
    nu[axis, 0] += speed
    none = np.zeros(2)
    still = Motion(
        none,
        np.zeros(2, dtype=np.int64),
        np.zeros((6, 2)),
        nu,
        nu,
        np.zeros((len(boat.drive.lag), 2)),
    )
    force = boat.law(boat.c, still)
    return float((force[axis, 1] - force[axis, 0]) / speed)
