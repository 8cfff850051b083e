"""Diffraction of waves at their frequency of encounter, by Capytaine.

A hull at forward speed scatters waves of the frequency of encounter. Strip theory takes the flow
at that frequency, driven by the velocity of the undisturbed wave at the hull (N. Salvesen, E. O.
Tuck and O. Faltinsen, Ship motions and sea loads, Transactions of SNAME 78, 1970).
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.hydrodynamics import capytaine_worker
from boatsim.hydrodynamics.axes import excitation_to_sname
from boatsim.hydrodynamics.computation import MOST_PANELS, HullMesh, check_installed
from boatsim.physics.particulars import GRAVITY


class Met(NamedTuple):
    """A wave that a moving hull meets."""

    frequency: float  # [rad/s]
    encounter: float  # [rad/s] frequency of encounter
    direction: float  # [rad] to which it runs, clockwise from the bow


def diffraction_forces(hull: HullMesh, waves: Sequence[Met]) -> NDArray[np.complex128]:
    """Return the forces of the scattered waves on a held hull, per amplitude.

    Args:
        hull: The hull.
        waves: The waves.

    Returns:
        Complex forces (W, 2, 6) [N/m, N] in SNAME axes about the hull's origin, for the time
        dependence exp(i w t): of waves scattered at the frequency of the wave, and at that of
        encounter.

    Raises:
        BadInput: Capytaine is not installed.
    """
    check_installed()
    import capytaine
    from capytaine.bem.problems_and_results import LinearPotentialFlowProblem

    request = {
        "mesh": str(hull.mesh),
        "draught": hull.draught,
        "origin": hull.origin,
        "scale": hull.scale,
        "panel": hull.panel,
        "most_panels": MOST_PANELS,
    }
    capytaine.set_logging("ERROR")
    body = capytaine_worker.floating_body(request)
    solver = capytaine.BEMSolver(method="direct")
    water: dict[str, Any] = {"water_depth": np.inf, "rho": hull.density, "g": GRAVITY}
    if hull.depth > 0.0:
        water["water_depth"] = hull.depth
    rows = []
    for wave in waves:
        # Capytaine's directions are counter-clockwise
        problem = capytaine.DiffractionProblem(
            body=body,
            omega=wave.frequency,
            wave_direction=-wave.direction,
            **capytaine_worker.water_of_waves(wave.frequency, water),
        )
        met = LinearPotentialFlowProblem(
            body=body,
            omega=abs(wave.encounter),
            boundary_condition=problem.boundary_condition,
            **capytaine_worker.water_of_waves(abs(wave.encounter), water),
        )
        pair = []
        for one in (problem, met):
            forces = solver.solve(one).forces
            pair.append([complex(forces[axis]) for axis in capytaine_worker.AXES])
        rows.append(pair)
    return np.asarray(excitation_to_sname(np.array(rows), conjugate=True))
