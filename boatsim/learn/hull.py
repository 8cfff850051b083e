"""Sizes of a boat that scale a task: length, waterplane rectangle, and speed under full thrust."""

from dataclasses import dataclass
from math import sqrt
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.signals import AXES, Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch

GRAVITY = 9.81  # [m/s^2]
ROW = 0.1  # time between two rows in sqrt(L/g)
LONGEST = 4000  # rows after which a boat counts as one that does not move ahead


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
        """Return the rectangles of vessels.

        Args:
            vessels: The vessels.
        """
        lengths = np.array([v.length for v in vessels])
        to_transom = np.array([v.geometry.get("cg_from_transom", 0.5 * v.length) for v in vessels])
        return cls(
            0.5 * lengths, 0.5 * np.array([v.beam for v in vessels]), 0.5 * lengths - to_transom
        )

    def at(self, index: Array) -> "Hulls":
        """Return the rectangles of boats.

        Args:
            index: Numbers of the vessels of the boats.
        """
        return Hulls(self.ahead[index], self.aside[index], self.middle[index])


@dataclass(frozen=True)
class Scale:
    """Units of the tolerances and bounds of a task, from the vessel file."""

    length: float  # [m]
    beam: float  # [m]
    speed: float  # [m/s] one length from rest under full thrust


def scale_of(vessel: Vessel, full_ahead: Array) -> Scale:
    """Return the scale of a vessel.

    Args:
        vessel: The vessel.
        full_ahead: Commands (C,) of full thrust ahead.

    Raises:
        BadInput: The vessel lacks a degree of freedom or does not move ahead.
    """
    if not {"surge", "sway", "yaw"} <= set(vessel.dof):
        raise BadInput(f"{vessel.name} is not free in surge, sway and yaw, as a task must have it")
    row = ROW * sqrt(vessel.length / GRAVITY)
    place = columns(vessel)
    rows = Batch(vessel, step=row / 10.0).rollout(
        [0.0] * (2 * len(vessel.dof)), np.tile(full_ahead, (LONGEST, 1)), row
    )[:, place]
    gone = np.flatnonzero(np.hypot(rows[:, 0], rows[:, 1]) >= vessel.length)
    if not len(gone):
        raise BadInput(f"{vessel.name} does not get a length ahead under full thrust")
    return Scale(vessel.length, vessel.beam, float(np.hypot(rows[gone[0], 3], rows[gone[0], 4])))


def columns(vessel: Vessel) -> list[int]:
    """Return the indices of x, y, psi, u, v, r in a state of a vessel.

    Args:
        vessel: The vessel.
    """
    free = [axis for axis in AXES if axis in vessel.dof]
    plane = [free.index(axis) for axis in ("surge", "sway", "yaw")]
    return [*plane, *(len(free) + i for i in plane)]
