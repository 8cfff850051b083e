"""The container ship S-175 by panels at zero speed and terms of forward speed, against VERES.

The MSS toolbox contains the offsets of the ship and the motions that VERES 4.02 computes for them:
strip theory of N. Salvesen, E. O. Tuck and O. Faltinsen, with two passive tanks and viscous damping
in roll. The hull is lofted through the offsets, its coefficients at zero speed are computed by
boatsim, and its motions in head and beam waves follow with the terms of forward speed of
`radiation_memory`. Tanks and viscous damping, which boatsim has no model of, are those of VERES.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from boatsim.hydrodynamics.capytaine_worker import MetWave
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.hydrodynamics.rao_table import RaoTable
from boatsim.hydrodynamics.response import linear_stiffness, rigid_body
from boatsim.hydrodynamics.veres import read_veres
from boatsim.physics.base import Array
from boatsim.physics.hull.submerged import wetted_triangles
from boatsim.physics.particulars import GRAVITY
from validation.waves.hulls import write_obj
from validation.waves.offsets import extract, lofted, mgf_in_archive, parse_mgf
from validation.waves.ship_speed import HEAVE, PITCH, ROLL, SWAY, YAW, speed_terms
from validation.waves.speed_diffraction import MovingHull
from validation.waves.veres_coefficients import VeresCoefficients, read_veres_coefficients

# A ship of ShipX in github.com/cybergalactic/MSS, commit 736a3d12 of July 2026
SHIP = Path("HYDRO") / "vessels_shipx" / "s175" / "S175.shipx_ship"
GYRADII = (8.331, 42.0, 42.0)  # [m] in roll, pitch and yaw, of input.veres in the archive
HEAD, BEAM = np.pi, 0.5 * np.pi  # [rad] directions to which the waves run
# Meshes: largest distance of sections [m] and number of panels from keel to waterline. The change
# of the motions from the coarse to the fine one is printed
FINE, COARSE = (4.4, 16), (8.8, 8)
# Lowest and highest frequency of the table of coefficients [rad/s], and their number: waves of 9
# lengths, and waves of 0.7 lengths met at 20 knots
LOWEST, HIGHEST, NUMBER = 0.2, 1.25, 22
# Waves in which motions are compared, in lengths: shorter ones hardly move the ship. Near
# resonance: those of `dtmb5415` in heave and pitch; in roll, frequencies up to about a factor of
# 1.5 from the natural one, which the tanks lower to 0.305 rad/s, waves of 3.8 lengths
SHORTEST, LONGEST = 0.8, 3.6
RESONANT = {HEAVE: (0.97, 2.15), PITCH: (0.97, 2.15), ROLL: (1.7, 8.1)}
COEFFICIENTS_AT = (3.57, 2.0, 1.5, 1.29, 1.08)  # wavelengths over length that are printed, roughly
CLOSE = 0.1  # relative error that the aim allows
UPRIGHT, SIDEWAYS = (HEAVE, PITCH), (SWAY, ROLL, YAW)
NAMES = {HEAVE: "heave", ROLL: "roll", PITCH: "pitch"}
# Excitation at speed: that of zero speed, as `panel_wave_loads` takes it; with the moments of the
# diffraction at speed in addition; and that of `speed_diffraction`, whose scattered waves have the
# frequency of encounter too
METHODS = ("at rest", "moments", "encounter")


class Veres(NamedTuple):
    """Results of VERES in the archive, about the mass centre's place in the waterline.

    Attributes:
        coefficients: Mass, added mass, damping and stiffness.
        motions: Motions for each speed.
        loads: Excitation for each speed.
    """

    coefficients: VeresCoefficients
    motions: tuple[RaoTable, ...]
    loads: tuple[RaoTable, ...]


def read_results(mss: Path, work: Path) -> Veres:
    """Return the results of VERES.

    Args:
        mss: Folder of the MSS toolbox.
        work: Working folder, to which the files of the archive are written.

    Raises:
        BadInput: A file cannot be read.
    """
    own, loads, motions = (extract(mss / SHIP, ending, work) for ending in (".re7", ".re8", ".re1"))
    found = read_veres_coefficients(own)
    tables = []
    for path in (motions, loads):
        tables.append(tuple(read_veres(path, 0.0, speed) for speed in found.speed.tolist()))
    return Veres(found, *tables)


class Ship:
    """The lofted ship, its coefficients at zero speed and its mass.

    Attributes:
        coefficients: Coefficients, about the mass centre's place in the waterline.
        stiffness: Stiffness (6, 6).
        body: Mass matrix (6, 6).
        height: Height GM of the metacentre above the mass centre [m].
        mass: Displaced mass [kg].
    """

    def __init__(
        self, mss: Path, work: Path, mesh: tuple[float, int], theirs: VeresCoefficients
    ) -> None:
        """Loft the hull and compute its coefficients.

        Args:
            mss: Folder of the MSS toolbox.
            work: Working folder.
            mesh: `FINE` or `COARSE`.
            theirs: Coefficients of VERES, of which draught, density and mass centre are taken.

        Raises:
            BadInput: Capytaine is not installed, or the offsets cannot be read.
        """
        draught, (ahead, above) = theirs.draught, theirs.centre
        offsets = parse_mgf(mgf_in_archive(mss / SHIP), SHIP.name)
        triangles = lofted(offsets, draught, *mesh)
        work.mkdir(parents=True, exist_ok=True)
        path = work / f"s175_{mesh[1]}.obj"
        write_obj(path, triangles, "S-175 up to the waterline, z = 0")
        hull = HullMesh(path, draught, origin=ahead, density=theirs.density)
        frequencies = [float(w) for w in np.linspace(LOWEST, HIGHEST, NUMBER)]
        rows = run_capytaine(hull, frequencies, [BEAM, HEAD], lambda stage, share: None)
        found = coefficients_of_rows(rows, hull, [BEAM, HEAD])
        depth = draught - above
        self.coefficients, self.mass = found, found.density * found.volume
        self.stiffness = linear_stiffness(found, self.mass, depth)
        inertia = self.mass * np.array(GYRADII) ** 2
        self.body = rigid_body(self.mass, (float(found.buoyancy[0]), depth), inertia)
        self.height = float(self.stiffness[ROLL, ROLL]) / (self.mass * GRAVITY)
        w = found.frequency
        self._added, self._damping, self._excitation = (
            CubicSpline(w, values) for values in (found.added_mass, found.damping, found.excitation)
        )
        in_sname = (triangles - np.array([ahead, 0.0, 0.0])) * np.array([1.0, -1.0, -1.0])
        self._wave = UndisturbedWave(wetted_triangles(in_sname), found.density)
        self._moving = MovingHull(hull)
        self._met: dict[MetWave, Array] = {}

    def slow(self, w: float) -> tuple[Array, Array]:
        """Return added mass and damping (6, 6) at zero speed.

        Args:
            w: Frequency [rad/s].
        """
        return np.array(self._added(w)), np.array(self._damping(w))

    def excitation(self, w: float, heading: float, speed: float, method: str) -> Array:
        """Return the complex excitation (6,) per amplitude of a wave.

        Args:
            w: Frequency of the wave [rad/s].
            heading: `BEAM` or `HEAD`.
            speed: Forward speed [m/s].
            method: One of `METHODS`.
        """
        met = encounter(w, heading, speed)
        if method == "encounter" and met != w:
            wave = MetWave(w, met, heading, speed)
            if wave not in self._met:  # a solution takes seconds
                self._met[wave] = self._moving.excitation(wave)
            return self._met[wave]
        place = int(np.argmin(np.abs(self.coefficients.heading - heading)))
        found = np.array(self._excitation(w)[place])
        if method != "at rest":
            scattered = found[:3] - self._wave(w, heading)
            factor = speed / (1j * met)
            found[PITCH] -= factor * scattered[HEAVE]
            found[YAW] += factor * scattered[SWAY]
        return found


class UndisturbedWave:
    """Force of the pressure of an undisturbed wave in deep water on a hull."""

    def __init__(self, wet: Array, density: float) -> None:
        """Prepare the integral over the wetted surface.

        Args:
            wet: Its triangles (N, 3, 3) [m], z down from the surface, seen from the water.
            density: Density of the water [kg/m^3].
        """
        a, b, c = np.moveaxis(wet, 1, 0)
        self._inward = -0.5 * np.cross(b - a, c - a) * density * GRAVITY
        self._middles = 0.5 * np.stack([a + b, b + c, c + a], axis=1)

    def __call__(self, w: float, heading: float) -> Array:
        """Return the complex force (3,) per amplitude [N/m] for the time dependence exp(i w t).

        Args:
            w: Frequency of the wave [rad/s].
            heading: Direction to which it runs [rad].
        """
        x, y, z = np.moveaxis(self._middles, -1, 0)
        k = w * w / GRAVITY
        pressure = np.exp(-k * z - 1j * k * (x * np.cos(heading) + y * np.sin(heading)))
        return np.asarray(pressure.mean(axis=1) @ self._inward)


def encounter(w: float, heading: float, speed: float) -> float:
    """Return the frequency of encounter in deep water [rad/s].

    Args:
        w: Frequency of the wave [rad/s].
        heading: Direction to which it runs, relative to the ship [rad].
        speed: Forward speed [m/s].
    """
    if heading == BEAM:  # whose cosine is not rounded to 0
        return w
    return w - w * w / GRAVITY * speed * float(np.cos(heading))


class Motion(NamedTuple):
    """A motion in one wave.

    Attributes:
        speed: Forward speed [m/s].
        heading: `HEAD` or `BEAM`.
        ratio: Wavelength over length.
        axis: `HEAVE`, `ROLL` or `PITCH`.
        published: By VERES, over the amplitude of the wave or over its slope.
        found: By each of `METHODS`.
    """

    speed: float
    heading: float
    ratio: float
    axis: int
    published: float
    found: tuple[float, ...]

    @property
    def resonant(self) -> bool:
        """Whether the wave is near the resonance of the motion."""
        low, high = RESONANT[self.axis]
        return low <= self.ratio <= high


def motions(ship: Ship, veres: Veres, methods: tuple[str, ...] = METHODS) -> list[Motion]:
    """Return published and computed motions at rest and at the highest speed.

    Heave and pitch, and sway, roll and yaw, are coupled; surge is left out, as by VERES.

    Args:
        ship: The ship.
        veres: Results of VERES.
        methods: Some of `METHODS`.
    """
    theirs, rows = veres.coefficients, []
    for number in (0, len(theirs.speed) - 1):
        speed = float(theirs.speed[number])
        for heading, axes in ((HEAD, UPRIGHT), (BEAM, (HEAVE, ROLL))):
            for place, w in enumerate(theirs.frequency.tolist()):
                ratio = 2.0 * np.pi * GRAVITY / w**2 / theirs.length
                if not SHORTEST <= ratio <= RESONANT[ROLL][1]:
                    continue
                published = np.abs(_of_table(veres.motions[number], w, heading))
                found = []
                for method in methods:
                    found.append(np.abs(_motion(ship, veres, (number, place), heading, method)))
                for axis in axes:
                    if axis != ROLL and ratio > LONGEST:
                        continue
                    unit = 1.0 if axis == HEAVE else w * w / GRAVITY
                    own = tuple(float(one[axis]) / unit for one in found)
                    row = Motion(speed, heading, ratio, axis, float(published[axis]) / unit, own)
                    rows.append(row)
    return sorted(rows, key=lambda row: (row.speed, -row.heading, row.axis, -row.ratio))


def _of_table(table: RaoTable, w: float, heading: float) -> Array:
    """Return the complex values (6,) of a table at one of its waves."""
    row = int(np.argmin(np.abs(table.frequency - w)))
    return np.asarray(table.values[row, int(np.argmin(np.abs(table.heading - heading)))])


def _motion(ship: Ship, veres: Veres, wave: tuple[int, int], heading: float, method: str) -> Array:
    """Return the motion (6,) per amplitude in a wave, of the numbers of its speed and frequency."""
    theirs = veres.coefficients
    number, place = wave
    speed, w = float(theirs.speed[number]), float(theirs.frequency[place])
    met = encounter(w, heading, speed)
    own = (number, int(np.argmin(np.abs(theirs.heading - heading))), place)
    added, damping = speed_terms(*ship.slow(met), met, speed)
    extra = theirs.more_damping[own].copy()
    extra[ROLL, ROLL] += theirs.viscous[own]
    inertia = ship.body + added + theirs.more_added_mass[own]
    dynamic = ship.stiffness + 1j * met * (damping + extra) - met * met * inertia
    force = ship.excitation(w, heading, speed, method)
    found = np.zeros(6, dtype=complex)
    for axes in (UPRIGHT, SIDEWAYS):
        free = list(axes)
        found[free] = np.linalg.solve(dynamic[np.ix_(free, free)], force[free])
    return found


class CoefficientRow(NamedTuple):
    """Added mass and damping at rest in one wave.

    Attributes:
        ratio: Wavelength over length.
        published: A33, B33, A55 and B55 by VERES [kg, N s/m, kg m^2, N m s].
        found: The same by boatsim.
    """

    ratio: float
    published: tuple[float, ...]
    found: tuple[float, ...]


def coefficient_rows(ship: Ship, veres: Veres) -> list[CoefficientRow]:
    """Return added mass and damping at zero speed, by strips and by panels.

    Args:
        ship: The ship.
        veres: Results of VERES.
    """
    theirs, rows = veres.coefficients, []
    ratios = 2.0 * np.pi * GRAVITY / theirs.frequency**2 / theirs.length
    for wanted in COEFFICIENTS_AT:
        place = int(np.argmin(np.abs(ratios - wanted)))
        added, damping = ship.slow(float(theirs.frequency[place]))
        published, found = [], []
        for axis in UPRIGHT:
            for here, there in ((added, theirs.added_mass), (damping, theirs.damping)):
                published.append(float(there[0, 0, place, axis, axis]))
                found.append(float(here[axis, axis]))
        rows.append(CoefficientRow(float(ratios[place]), tuple(published), tuple(found)))
    return rows


class LoadRow(NamedTuple):
    """Heave force and pitching moment of a head wave at one speed.

    Attributes:
        speed: Forward speed [m/s].
        ratio: Wavelength over length.
        published: Over C33 a and over k C55 a, by VERES.
        found: The same by each of `METHODS`.
    """

    speed: float
    ratio: float
    published: tuple[float, float]
    found: tuple[tuple[float, float], ...]


def load_rows(ship: Ship, veres: Veres) -> list[LoadRow]:
    """Return loads of head waves near resonance at rest and at the highest speed.

    Args:
        ship: The ship.
        veres: Results of VERES.
    """
    theirs, rows = veres.coefficients, []
    for number in (0, len(theirs.speed) - 1):
        speed = float(theirs.speed[number])
        for w in theirs.frequency.tolist():
            ratio = 2.0 * np.pi * GRAVITY / w**2 / theirs.length
            if not RESONANT[PITCH][0] <= ratio <= RESONANT[PITCH][1]:
                continue
            unit = np.diag(ship.stiffness)[list(UPRIGHT)] * np.array([1.0, w * w / GRAVITY])
            forces = [_of_table(veres.loads[number], w, HEAD)]
            forces += [ship.excitation(w, HEAD, speed, method) for method in METHODS]
            pairs = []
            for force in forces:
                heave, pitch = np.abs(force[list(UPRIGHT)]) / unit
                pairs.append((float(heave), float(pitch)))
            rows.append(LoadRow(speed, ratio, pairs[0], tuple(pairs[1:])))
    return rows


class Errors(NamedTuple):
    """Errors of a motion in the waves near its resonance."""

    within: int  # number of waves with at most `CLOSE`
    waves: int
    largest: float  # relative error of the largest size
    mean: float  # mean of the relative errors without their sign


def errors(rows: list[Motion], speed: float, heading: float, axis: int, method: int) -> Errors:
    """Return the errors of a motion near its resonance.

    Args:
        rows: Published and computed motions.
        speed: Forward speed [m/s].
        heading: `HEAD` or `BEAM`.
        axis: The motion.
        method: Place among `METHODS`.
    """
    found = []
    for row in rows:
        if (row.speed, row.heading, row.axis) == (speed, heading, axis) and row.resonant:
            found.append(row.found[method] / row.published - 1.0)
    sizes = np.abs(found)
    largest = found[int(np.argmax(sizes))]
    return Errors(int(np.sum(sizes <= CLOSE)), len(found), float(largest), float(sizes.mean()))


def largest_change(coarse: list[Motion], fine: list[Motion], axis: int) -> float:
    """Return the largest relative change of a motion near its resonance by a finer mesh.

    Args:
        coarse: Motions with the coarse mesh.
        fine: The same with the fine one.
        axis: The motion.
    """
    changes = []
    for before, after in zip(coarse, fine, strict=True):
        if after.axis == axis and after.resonant:
            changes.append(abs(after.found[0] / before.found[0] - 1.0))
    return max(changes)
