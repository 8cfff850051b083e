"""Excitation of waves on a hull under way, with the diffraction at the frequency of encounter.

The computation is that of `boatsim hydrodynamics --speed`, wave by wave.
"""

from typing import Any

import numpy as np

from boatsim.hydrodynamics.axes import excitation_to_sname
from boatsim.hydrodynamics.capytaine_worker import MetWave, floating_body, met_excitation
from boatsim.hydrodynamics.computation import MOST_PANELS, HullMesh, check_installed
from boatsim.physics.base import Array
from boatsim.physics.particulars import GRAVITY


class MovingHull:
    """A hull whose diffraction is computed at the frequency of encounter."""

    def __init__(self, hull: HullMesh) -> None:
        """Read the mesh.

        Args:
            hull: The hull.

        Raises:
            BadInput: Capytaine is not installed.
        """
        check_installed()
        import capytaine

        capytaine.set_logging("ERROR")
        self._hull = hull
        self._body: Any = floating_body(
            {
                "mesh": str(hull.mesh),
                "draught": hull.draught,
                "origin": hull.origin,
                "scale": hull.scale,
                "panel": hull.panel,
                "most_panels": MOST_PANELS,
            }
        )
        self._solver: Any = capytaine.BEMSolver(method="direct")

    def excitation(self, wave: MetWave) -> Array:
        """Return the complex excitation (6,) per amplitude of a wave, for exp(i w_e t) [N/m, N].

        Args:
            wave: The wave, with its direction clockwise from x, as in SNAME axes.
        """
        depth = np.inf
        if self._hull.depth > 0.0:
            depth = self._hull.depth
        water = {"rho": self._hull.density, "g": GRAVITY, "water_depth": depth}
        counter_clockwise = wave._replace(heading=-wave.heading)
        force = met_excitation(self._solver, self._body, counter_clockwise, water)
        return excitation_to_sname(force, conjugate=True)
