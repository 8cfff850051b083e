"""An owner's driving for a log: straight runs, zigzags, turns, stops and some way astern."""

from dataclasses import dataclass, field

import numpy as np

from validation.owner_logs.boats import Boat, Rng

LEG = {
    "straight": 18.0,
    "zigzag": 30.0,
    "turn": 20.0,
    "weave": 25.0,
    "stop": 12.0,
    "astern": 16.0,
    "drift": 8.0,
}
"""Seconds of each stretch on a boat of 2 m."""


@dataclass(frozen=True)
class Stretch:
    """One manoeuvre of the plan."""

    kind: str
    until: float  # [s]
    throttle: float  # -1 to 1
    helm: float  # -1 to 1
    swing: float  # [rad] at which a zigzag reverses


@dataclass
class Owner:
    """A pilot that follows a plan with a delay of a quarter of a second."""

    plan: list[Stretch]
    course: float | None = None
    side: float = 1.0
    stopped: bool = False
    at: int = field(default=0)

    def order(self, t: float, psi: float, u: float, r: float) -> tuple[float, float]:
        """Return the present throttle and helm."""
        while self.at < len(self.plan) - 1 and t >= self.plan[self.at].until:
            self.at, self.course, self.side, self.stopped = self.at + 1, None, 1.0, False
        now = self.plan[self.at]
        if self.course is None:
            self.course = psi
        off = psi - self.course
        if now.kind == "zigzag":
            if off * self.side > now.swing:
                self.side = -self.side
            return now.throttle, self.side * abs(now.helm)
        if now.kind == "straight":
            return now.throttle, float(np.round(np.clip(-1.2 * off - 1.5 * r, -0.4, 0.4), 2))
        if now.kind == "stop":
            self.stopped = self.stopped or u < 0.1
            return (0.0 if self.stopped else now.throttle), 0.0
        return now.throttle, now.helm


def plan(boat: Boat, rng: Rng, lasts: float, without: tuple[str, ...] = ()) -> list[Stretch]:
    """Return stretches in random order, each kind once before any repeats."""
    kinds = [k for k in LEG if k not in without]
    found, t, bag = list[Stretch](), 0.0, list[str]()
    while t < lasts:
        bag = bag or [str(k) for k in rng.permutation(kinds)]
        kind = bag.pop()
        t += LEG[kind] * boat.scale * rng.uniform(0.7, 1.3)
        throttle = round(float(rng.choice([0.3, 0.45, 0.6, 0.75])), 2)
        helm = round(float(rng.choice([-1.0, 1.0]) * rng.uniform(0.25, 0.8)), 2)
        throttle = {
            "stop": -0.6,
            "astern": -round(float(rng.uniform(0.35, 0.7)), 2),
            "drift": 0.0,
        }.get(kind, throttle)
        helm = 0.0 if kind in ("drift", "stop") else 0.4 * helm if kind == "astern" else helm
        if kind == "weave":
            helm *= 0.5
        found.append(Stretch(kind, t, throttle, helm, float(rng.uniform(0.2, 0.6))))
    return found


def pilot(boat: Boat, rng: Rng, lasts: float, without: tuple[str, ...] = ()) -> Owner:
    """Return a pilot with a random plan."""
    return Owner(plan(boat, rng, lasts, without))
