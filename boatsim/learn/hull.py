"""What tasks measure a boat by: its length, its rectangle on the water, and how fast its drives can make it."""

from dataclasses import dataclass
from math import sqrt
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.compiled_engine import Twin

GRAVITY = 9.81  # [m/s^2]
ROW = 0.1  # Froude times sqrt(L/g) between two looks
LONGEST = 4000  # looks until a boat is taken for one that does not get ahead


class Motion(NamedTuple):
    """(n,) each: place [m], heading [rad], velocity in body axes over ground [m/s, rad/s], SNAME."""

    x: Array
    y: Array
    psi: Array
    u: Array
    v: Array
    r: Array


class Hulls(NamedTuple):
    """(n,) each [m]: half length, half beam, and how far mid-length is ahead of the origin of motion."""

    ahead: Array
    aside: Array
    middle: Array

    @classmethod
    def of(cls, vessels: list[Vessel]) -> "Hulls":
        """The rectangles of vessels."""
        lengths = np.array([v.length for v in vessels])
        to_transom = np.array([v.geometry.get("cg_from_transom", 0.5 * v.length) for v in vessels])
        return cls(
            0.5 * lengths, 0.5 * np.array([v.beam for v in vessels]), 0.5 * lengths - to_transom
        )

    def at(self, index: Array) -> "Hulls":
        """Those of these numbers."""
        return Hulls(self.ahead[index], self.aside[index], self.middle[index])


@dataclass(frozen=True)
class Scale:
    """What a task states its tolerances and bounds in: sizes of the boat as its file has it."""

    length: float  # [m]
    beam: float  # [m]
    speed: float  # [m/s] one length from rest under full thrust


def scale_of(vessel: Vessel, full_ahead: Array) -> Scale:
    """Scale of a vessel; `full_ahead` (C,) are its commands. Raises BadInput for one that does not get ahead."""
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        raise BadInput(f"{vessel.name} is not free in surge, sway and yaw, as a task must have it")
    row = ROW * sqrt(vessel.length / GRAVITY)
    place = columns(vessel)
    rows = Twin(vessel, row / 10.0).rollout(
        [0.0] * (2 * len(vessel.dof)), np.tile(full_ahead, (LONGEST, 1)), row
    )[:, place]
    gone = np.flatnonzero(np.hypot(rows[:, 0], rows[:, 1]) >= vessel.length)
    if not len(gone):
        raise BadInput(f"{vessel.name} does not get a length ahead under full thrust")
    return Scale(vessel.length, vessel.beam, float(np.hypot(rows[gone[0], 3], rows[gone[0], 4])))


def columns(vessel: Vessel) -> list[int]:
    """Where x, y, psi, u, v, r lie in a state of the vessel."""
    free = [axis for axis in AXES if axis in vessel.dof]
    plane = [free.index(axis) for axis in ("surge", "sway", "yaw")]
    return [*plane, *(len(free) + i for i in plane)]
