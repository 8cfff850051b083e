"""Ships with published meshes and results of WAMIT: added mass, damping and motions at rest.

The MSS toolbox contains a tanker and an FPSO of T. I. Fossen with their panels and the output of
WAMIT. The same panels, each quadrilateral as two triangles, are given to boatsim's own computation,
so that the differences are those of the two programs.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import to_sname
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit_operators, read_wamit_radiation
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves.hulls import write_obj

SHIPS = Path("HYDRO") / "vessels_wamit"
DENSITY = 1025.0  # [kg/m^3] of the mass matrix in tanker.frc
HEAD, BEAM = np.pi, 0.5 * np.pi  # [rad] directions to which the waves run
# Periods of the tables [s], waves of 0.6 to 2.2 lengths, in which the ships are heaving, pitching
# and rolling most
PERIODS = (9.49, 10.44, 11.48, 12.64, 13.91, 16.88)
CLOSE = 0.03  # relative error up to which numbers are counted
SWAY, HEAVE, ROLL, PITCH = (AXES.index(name) for name in ("sway", "heave", "roll", "pitch"))
# Direction of the waves, axis, and its name
MOTIONS = (
    (HEAD, HEAVE, "head waves, heave"),
    (HEAD, PITCH, "head waves, pitch"),
    (BEAM, HEAVE, "beam waves, heave"),
    (BEAM, ROLL, "beam waves, roll"),
)
DIAGONAL = ((SWAY, "22"), (HEAVE, "33"), (ROLL, "44"), (PITCH, "55"))


class Ship(NamedTuple):
    """A ship of the toolbox.

    Attributes:
        name: Name of its folder and its files.
        mesh: File of its panels.
        length: Length between perpendiculars [m].
        draught: Draught [m].
    """

    name: str
    mesh: str
    length: float
    draught: float


TANKER = Ship("tanker", "tanker.gdf", 246.0, 10.0)
FPSO = Ship("fpso", "fpso_low.gdf", 200.0, 12.0)


def read_gdf(path: Path) -> Array:
    """Return the triangles (N, 3, 3) [m] of the panels of WAMIT, on both sides.

    A panel has four corners, counter-clockwise seen from the water. It becomes two triangles.

    Args:
        path: NAME.gdf with flat panels.

    Raises:
        BadInput: The file has another form.
    """
    try:
        lines = path.read_text(encoding="latin-1").splitlines()
        length = float(lines[1].split()[0])
        across, along = (int(word) for word in lines[2].split()[:2])
        count = int(lines[3].split()[0])
        words = " ".join(line for line in lines[4:]).split()
        corners = np.array(words[: 12 * count], dtype=float).reshape(count, 4, 3) * length
    except (OSError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: the panels cannot be read: {error}") from None
    found = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    for mirrored, signs in ((across, (-1.0, 1.0, 1.0)), (along, (1.0, -1.0, 1.0))):
        if mirrored:
            found = np.concatenate([found, (found * np.array(signs))[:, ::-1]])
    return found


class Mass(NamedTuple):
    """Mass of a ship and its further damping, in SNAME axes.

    Attributes:
        body: Mass matrix (6, 6) about the origin [kg, kg m, kg m^2].
        damping: Damping (6, 6) in addition to that of the radiated waves [N s/m, N s, N m s].
        depth: Depth of the mass centre below the waterline [m].
    """

    body: Array
    damping: Array
    depth: float

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return float(self.body[HEAVE, HEAVE])


def read_mass(path: Path, found: Coefficients) -> Mass:
    """Return the mass of a file NAME.frc of WAMIT, of one of its two forms.

    The first form has the height of the mass centre and the radii of gyration, of a ship that
    weighs what it displaces, and the second one has the matrices of mass and damping.

    Args:
        path: NAME.frc.
        found: Coefficients of the hull.

    Raises:
        BadInput: The file has another form.
    """
    try:
        lines = path.read_text(encoding="latin-1").splitlines()[2:]
        rows = [[float(word) for word in line.split()] for line in lines]
        if len(rows[1]) == 3 and len(rows[2]) == 3:
            mass, depth = found.density * found.volume, -rows[0][0]
            radii = np.array([rows[1 + k][k] for k in range(3)])
            body = rigid_body(mass, (float(found.buoyancy[0]), depth), np.zeros(3))
            body[3:, 3:] = np.diag(mass * radii**2)
            return Mass(body, np.zeros((6, 6)), depth)
        depth = -rows[1][2]
        body, damping = (to_sname(np.array(rows[k : k + 6])) for k in (3, 10))
        if body.shape != (6, 6) or damping.shape != (6, 6):
            raise ValueError("matrices of mass and damping have other sizes")
    except (OSError, ValueError, IndexError) as error:
        raise BadInput(f"{path}: the mass cannot be read: {error}") from None
    return Mass(body, damping, depth)


class Pair(NamedTuple):
    """A number by WAMIT and the one found."""

    published: float
    found: float

    @property
    def error(self) -> float:
        """Relative error [-]."""
        return self.found / self.published - 1.0


class Comparison(NamedTuple):
    """A ship by both programs, each list in the order of `PERIODS`.

    Attributes:
        panels: Name of the mesh and number of panels.
        stiffness: Stiffness in heave [N/m], roll and pitch [N m] of NAME.hst, and of boatsim. Empty
            without that file.
        added_mass: Added mass of each axis of `DIAGONAL` [kg, kg m^2].
        damping: Damping of each axis [N s/m, N m s].
        motions: Each of `MOTIONS`, heave over the amplitude of the wave and angles over its slope.
    """

    panels: str
    stiffness: tuple[tuple[float, float], ...]
    added_mass: tuple[list[Pair], ...]
    damping: tuple[list[Pair], ...]
    motions: tuple[list[Pair], ...]


def compute(folder: Path, ship: Ship, work: Path, periods: tuple[float, ...]) -> Coefficients:
    """Return the coefficients of a ship by boatsim, in head and beam waves.

    Args:
        folder: Folder of the MSS toolbox.
        ship: The ship.
        work: Working folder.
        periods: Periods of the waves [s].

    Raises:
        BadInput: Capytaine is not installed, or the panels cannot be read.
    """
    work.mkdir(parents=True, exist_ok=True)
    path = work / f"{ship.name}.obj"
    triangles = read_gdf(folder / SHIPS / ship.name / ship.mesh)
    write_obj(path, triangles, f"panels of {ship.mesh}, z = 0 at the waterline")
    mesh = HullMesh(path, ship.draught, density=DENSITY)
    frequencies = [2.0 * np.pi / period for period in periods]
    headings = [BEAM, HEAD]
    rows = run_capytaine(mesh, frequencies, headings, lambda stage, share: None)
    return coefficients_of_rows(rows, mesh, headings)


def motion(found: Coefficients, mass: Mass, row: int, heading: float) -> Array:
    """Return the complex motion (6,) per amplitude of a wave [m/m, rad/m].

    Args:
        found: Coefficients of the hull.
        mass: Mass of the ship.
        row: Number of the frequency.
        heading: `HEAD` or `BEAM`.
    """
    w = found.frequency[row]
    stiffness = linear_stiffness(found, mass.mass, mass.depth)
    damping = found.damping[row] + mass.damping
    dynamic = stiffness + 1j * w * damping - w * w * (mass.body + found.added_mass[row])
    place = int(np.argmin(np.abs(found.heading - heading)))
    return np.asarray(np.linalg.solve(dynamic, found.excitation[row, place]))


def comparison(folder: Path, ship: Ship, work: Path) -> Comparison:
    """Return coefficients and motions of a ship by WAMIT and by boatsim.

    Args:
        folder: Folder of the MSS toolbox.
        ship: The ship.
        work: Working folder.

    Raises:
        BadInput: Capytaine is not installed, or a file cannot be read.
    """
    found = compute(folder, ship, work, PERIODS)
    path = folder / SHIPS / ship.name / ship.name
    scale = OutputScale(1.0, DENSITY, 0.0, ship.draught)
    mass = read_mass(path.with_suffix(".frc"), found)
    frequency, added, damping, _ = read_wamit_radiation(path.with_suffix(".1"), scale)
    table = read_wamit_operators(path.with_suffix(".4"), scale, 0.0)
    rows = [len(PERIODS) - 1 - k for k in range(len(PERIODS))]  # of `found`, in their order
    own = [int(np.argmin(np.abs(frequency - found.frequency[row]))) for row in rows]
    theirs = [int(np.argmin(np.abs(table.frequency - found.frequency[row]))) for row in rows]
    moved = {
        heading: [motion(found, mass, row, heading) for row in rows] for heading in (HEAD, BEAM)
    }
    motions = []
    for heading, axis, _ in MOTIONS:
        place = int(np.argmin(np.abs(table.heading - heading)))
        slope = np.ones(len(rows))
        if axis in (ROLL, PITCH):
            slope = found.frequency[rows] ** 2 / GRAVITY
        published = np.abs(table.values[theirs, place, axis]) / slope
        motions.append(_pairs(published, np.abs(np.array(moved[heading])[:, axis]) / slope))
    coefficients = []
    for published, here in ((added, found.added_mass), (damping, found.damping)):
        pairs = [_pairs(published[own, k, k], here[rows, k, k]) for k, _ in DIAGONAL]
        coefficients.append(tuple(pairs))
    panels = f"{ship.mesh}: {found.source}"
    return Comparison(
        panels, _stiffness(path.with_suffix(".hst"), found, mass), *coefficients, tuple(motions)
    )


def _pairs(published: Array, found: Array) -> list[Pair]:
    """Return numbers of one kind at all frequencies."""
    return [Pair(float(a), float(b)) for a, b in zip(published, found, strict=True)]


def _stiffness(path: Path, found: Coefficients, mass: Mass) -> tuple[tuple[float, float], ...]:
    """Return stiffness in heave, roll and pitch of a file NAME.hst and of boatsim."""
    if not path.is_file():
        return ()
    published = np.zeros((6, 6))
    for i, j, value in np.loadtxt(path).tolist():
        published[int(i) - 1, int(j) - 1] = value * found.density * GRAVITY
    own = linear_stiffness(found, mass.mass, mass.depth)
    return tuple((float(published[k, k]), float(own[k, k])) for k in (HEAVE, ROLL, PITCH))


def within(pairs: list[Pair]) -> int:
    """Return how many numbers have an error of at most `CLOSE`.

    Args:
        pairs: The numbers.
    """
    return sum(abs(pair.error) <= CLOSE for pair in pairs)
