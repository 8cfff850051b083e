"""Excitation of waves on a hull under way, with the diffraction at the frequency of encounter.

In the theory of N. Salvesen, E. O. Tuck and O. Faltinsen (Transactions of SNAME 78, 1970) the
scattered waves oscillate at the frequency of encounter, while the wave that they scatter keeps its
length. The excitation of zero speed, at the frequency of the wave, is another one. With the surface
condition of zero speed at the frequency of encounter, in which the theory takes the radiation too,
the force of the diffraction is F_D, and at a speed U the moments -U / (i w_e) times its heave force
in pitch and U / (i w_e) times its sway force in yaw are added.
"""

from typing import Any, NamedTuple

import numpy as np

from boatsim.hydrodynamics.axes import excitation_to_sname
from boatsim.hydrodynamics.capytaine_worker import AXES as CAPYTAINE_AXES
from boatsim.hydrodynamics.capytaine_worker import DEEP, floating_body
from boatsim.hydrodynamics.computation import MOST_PANELS, HullMesh, check_installed
from boatsim.physics.base import AXES, Array
from boatsim.physics.particulars import GRAVITY

SWAY, HEAVE, PITCH, YAW = (AXES.index(name) for name in ("sway", "heave", "pitch", "yaw"))


class MetWave(NamedTuple):
    """A wave that a hull under way meets.

    Attributes:
        frequency: Frequency of the wave [rad/s].
        encounter: Frequency at which the hull meets it [rad/s].
        heading: Direction to which it runs, relative to the hull [rad].
        speed: Forward speed [m/s].
    """

    frequency: float
    encounter: float
    heading: float
    speed: float


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
            wave: The wave.
        """
        import capytaine
        from capytaine.bem.airy_waves import froude_krylov_force
        from capytaine.bem.problems_and_results import LinearPotentialFlowProblem

        hull = self._hull
        depth = hull.depth if hull.depth > 0.0 else np.inf
        water = {"rho": hull.density, "g": GRAVITY, "water_depth": depth}
        still = capytaine.DiffractionProblem(
            body=self._body, wave_direction=-wave.heading, omega=wave.frequency, **water
        )
        if wave.encounter**2 / GRAVITY * depth > DEEP:
            water["water_depth"] = np.inf  # as for coefficients at rest
        met = LinearPotentialFlowProblem(
            body=self._body,
            omega=wave.encounter,
            boundary_condition=still.boundary_condition,
            **water,
        )
        pressure, result = froude_krylov_force(still), self._solver.solve(met)
        undisturbed, scattered = (
            excitation_to_sname(np.array([force[axis] for axis in CAPYTAINE_AXES]), conjugate=True)
            for force in (pressure, result.forces)
        )
        factor = wave.speed / (1j * wave.encounter)
        scattered[PITCH] -= factor * scattered[HEAVE]
        scattered[YAW] += factor * scattered[SWAY]
        return np.asarray(undisturbed + scattered)
