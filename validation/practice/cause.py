"""What a cause may do to a boat; every cause of the set is made of these few hooks."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from validation.practice.motion import RUNS, Array, Boat, Flow, Motion, Whole

Rng = np.random.Generator
Given = Callable[
    [Array, int], Array
]  # goals (A, RUNS) and number of the step, from the first row on -> goals
Shown = Callable[[Array], Array]  # pose (6, B) -> as the recording shows it


@dataclass(frozen=True)
class Cause:
    """One thing that a real boat has and its vessel file has not."""

    name: str  # as the library calls it, or outside_library:what
    parameters: Mapping[str, float] = field(default_factory=dict)  # those the library's law has too
    boat: Callable[[Boat], Boat] | None = None
    # of the step [s]; the closure keeps what it remembers
    drive: Callable[[Boat, float], Given] | None = None
    force: Callable[[Boat, Motion], Array] | None = None
    water: Callable[[Array, Array, Whole], Flow] | None = None
    show: Shown | None = None
    late: float = 0.0  # [s] the pose in row t is that of t - late
    known: "Cause | None" = None  # what of it could be known beforehand; None: all of it
    not_compared: tuple[str, ...] = ()
    same: tuple[str, ...] = ()  # entries that count as the same
    same_by_hand: tuple[str, ...] = ()  # and those that do where no controller closes the loop

    @property
    def measured(self) -> bool:
        """Whether it changes what is recorded, not what the boat does."""
        return self.show is not None or self.late != 0.0


Maker = Callable[[Boat, Rng, float], Cause]  # of a strength from 0 to 1


def changed(boat: Boat, causes: Sequence[Cause]) -> Boat:
    """The boat with the numbers that its causes change."""
    for cause in causes:
        boat = cause.boat(boat) if cause.boat else boat
    return boat


def extra(boat: Boat, causes: Sequence[Cause]) -> Callable[[Motion], Array]:
    """Sum of the forces of the causes."""
    acting = [c.force for c in causes if c.force]

    def total(m: Motion) -> Array:
        return sum((f(boat, m) for f in acting), np.zeros_like(m.nu))

    return total


def water(causes: Sequence[Cause]) -> Callable[[Array, Array, Whole], Flow | None]:
    """The water's velocity where the hulls are; None for still water."""
    flows = [c.water for c in causes if c.water]

    def velocity(t: Array, q: Array, run: Whole) -> Flow | None:
        found = [f(t, q, run) for f in flows]
        still = np.zeros(())
        if found:
            return Flow(sum((f.north for f in found), still), sum((f.east for f in found), still))
        return None

    return velocity


def shown(causes: Sequence[Cause], q: Array) -> Array:
    """A pose (6, B) as the recording shows it, lateness aside."""
    for cause in causes:
        q = cause.show(q) if cause.show else q
    return q


def known(causes: Sequence[Cause]) -> tuple[Cause, ...]:
    """The causes less what nobody could know beforehand."""
    return tuple(c.known or c for c in causes)


# ---- what several causes need


def scaled(boat: Boat, **factors: float) -> Boat:
    """The boat with some coefficients times factors."""
    return replace(boat, c={k: v * factors.get(k, 1.0) for k, v in boat.c.items()})


def sign(rng: Rng) -> float:
    """Either."""
    return float(rng.choice([-1.0, 1.0]))


def wavy(rng: Rng, low: float, high: float, n: int = 10) -> Callable[[Array, Whole], Array]:
    """A random course of rms 1 for each run: n sines of circular frequencies from low to high [rad/s]."""
    w, phase = rng.uniform(low, high, (n, 1)), rng.uniform(0.0, 2 * np.pi, (RUNS, n, 1))

    def course(t: Array, run: Whole) -> Array:
        return np.asarray(np.sqrt(2.0 / n) * np.sin(w * t + phase[run, :, 0].T).sum(axis=0))

    return course


def resistance(boat: Boat, axis: int, speed: float) -> float:
    """What the nominal hull resists one rate with, per rate [N s/m, N m s]."""
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
