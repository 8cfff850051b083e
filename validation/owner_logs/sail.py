"""Simulation of one voyage at 50 Hz: the pilot's orders, the drives and the motion."""

from collections import deque
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from validation.owner_logs.boats import Boat, Rng
from validation.owner_logs.plant import State, runge_kutta_step

Array = NDArray[np.float64]
DT = 0.02  # [s]
AMBIENT = 2.0e-4  # rms of the ambient force, share of the weight


class Pilot(Protocol):
    """Interface of a pilot."""

    def order(self, t: float, psi: float, u: float, r: float) -> tuple[float, float]:
        """Return throttle and helm, each -1 to 1, helm to starboard positive."""


@dataclass(frozen=True)
class Linkage:
    """Transmission from the orders to the drives."""

    gains: tuple[float, ...] = (1.0, 1.0)  # of each drive's thrust
    astern: float = 1.0  # further factor of the thrust astern
    lag: float = 0.0  # [s] added to the usual lag
    delay: float = 0.0  # [s]
    dead: float = 0.0  # share of full throttle below which the propeller stands still
    helm_offset: float = 0.0  # [rad]
    helm_rate: float = np.inf  # [rad/s] at most
    limit: float = 1.0  # of the throttle


@dataclass
class Drives:
    """Drives that follow the orders."""

    boat: Boat
    link: Linkage
    push: list[float] = field(init=False)  # share of full thrust at rest, signed
    helm: float = field(init=False)

    def __post_init__(self) -> None:
        self.push, self.helm = [0.0] * len(self.boat.plant.propellers), self.link.helm_offset
        self.queue = deque([((0.0,) * len(self.push), 0.0)] * (1 + round(self.link.delay / DT)))

    def follow(self, throttles: tuple[float, ...], helm: float) -> tuple[tuple[float, ...], float]:
        """Return revolutions (shares of full) and angle [rad] after a step."""
        self.queue.append((throttles, helm))
        given, wheel = self.queue.popleft()
        keep = np.exp(-DT / (self.boat.lag + self.link.lag))
        for i, order in enumerate(given):
            live = max(abs(order) - self.link.dead, 0.0) / (1.0 - self.link.dead)
            goal = np.copysign(live ** (2.0 * self.boat.curve), order) * self.link.gains[i]
            goal *= self.link.astern if goal < 0.0 else 1.0
            self.push[i] = goal + (self.push[i] - goal) * keep
        target = wheel * self.boat.helm_most + self.link.helm_offset
        most = min(self.boat.helm_rate, self.link.helm_rate) * DT
        self.helm += float(np.clip(target - self.helm, -most, most))
        return tuple(float(np.copysign(abs(p) ** 0.5, p)) for p in self.push), self.helm


@dataclass(frozen=True)
class Voyage:
    """True states and orders on the fine grid."""

    t: Array  # (N,) s
    states: Array  # (N, 6)
    throttles: Array  # (N, drives) -1 to 1
    helm: Array  # (N,) -1 to 1


def drive_orders(boat: Boat, throttle: float, helm: float) -> tuple[float, ...]:
    """Return the order of each drive; fixed thrusters steer by their difference."""
    if boat.helm_most:
        return (throttle,) * len(boat.plant.propellers)
    return tuple(
        float(np.clip(throttle - np.sign(p.y) * 0.5 * helm, -1.0, 1.0))
        for p in boat.plant.propellers
    )


def simulate_voyage(boat: Boat, link: Linkage, pilot: Pilot, lasts: float, rng: Rng) -> Voyage:
    """Simulate a voyage from rest with a random heading."""
    count = round(lasts / DT)
    plant, drives = boat.plant, Drives(boat, link)
    mass, L = plant.hull.mass, boat.length
    rms = AMBIENT * mass * 9.81 * np.array([1.0, 1.0, 0.2 * L])
    keep = np.exp(-DT / boat.scale)
    kicks = rng.standard_normal((count, 3)) * rms * np.sqrt(1.0 - keep * keep)
    push = np.zeros(3)
    s: State = (0.0, 0.0, float(rng.uniform(0.0, 2.0 * np.pi)), 0.0, 0.0, 0.0)
    states = np.empty((count, 6))
    throttles = np.empty((count, len(plant.propellers)))
    helms = np.empty(count)
    for k in range(count):
        if k % 5 == 0:
            throttle, helm = pilot.order(k * DT, s[2], s[3], s[5])
            throttle = float(np.clip(throttle, -link.limit, link.limit))
            given = drive_orders(boat, throttle, helm)
        states[k], throttles[k], helms[k] = s, given, helm if boat.helm_most else 0.0
        revs, angle = drives.follow(given, helm)
        push = push * keep + kicks[k]
        s = runge_kutta_step(
            plant, s, revs, angle, DT, (float(push[0]), float(push[1]), float(push[2]))
        )
    return Voyage(np.arange(count) * DT, states, throttles, helms)
