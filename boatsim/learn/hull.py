"""Sizes of a boat that scale a task: length, waterplane rectangle, and speed under full thrust."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel


class Motion(NamedTuple):
    """Position [m], heading [rad] and velocity over ground in body axes [m/s, rad/s] of n boats.

    Symbols are those of SNAME; each array has shape (n,).
    """

    x: Array
    y: Array
    psi: Array
    u: Array
    v: Array
    r: Array


class Hulls(NamedTuple):
    """Waterplane rectangles of n boats; each array has shape (n,) and unit m."""

    ahead: Array  # half length
    aside: Array  # half beam
    middle: Array  # distance of mid-length ahead of the origin of motion

    @classmethod
    def from_vessels(cls, vessels: list[Vessel]) -> "Hulls":
        """Return the waterplane rectangles of vessels, from their lengths and beams.

        Args:
            vessels: The vessels.
        """
        lengths = []
        beams = []
        to_transom = []
        for vessel in vessels:
            lengths.append(vessel.length)
            beams.append(vessel.beam)
            to_transom.append(vessel.geometry.get("cg_from_transom", 0.5 * vessel.length))
        half_lengths = 0.5 * np.array(lengths)
        return cls(half_lengths, 0.5 * np.array(beams), half_lengths - np.array(to_transom))

    def select(self, index: Array) -> "Hulls":
        """Return the waterplane rectangles of n boats, each that of the vessel it is assigned to.

        Args:
            index: Numbers (n,) of the vessels of the boats.
        """
        return Hulls(self.ahead[index], self.aside[index], self.middle[index])


@dataclass(frozen=True)
class Scale:
    """Length, beam and speed of a vessel, the units of tolerances and bounds of a learning task."""

    length: float  # [m]
    beam: float  # [m]
    speed: float  # [m/s] one length after the start from rest under full thrust
