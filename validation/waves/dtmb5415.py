"""The hull of the surface combatant DTMB 5415 against published numbers.

Its righting arms are compared with those of another program, the coefficients of its model DTMB
5512 with a table of another boundary element method, and the heave and pitch of the model in head
waves with model tests. The mesh of the hull comes from the repository of NavalToolbox.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from boatsim.hydrodynamics.capytaine_worker import MetWave
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.base import Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.hull.floating import LoadedHull, metacentric_heights, righting_arms
from boatsim.physics.hull.mesh import ClosedMesh, read_closed_mesh
from boatsim.physics.hull.submerged import submerged_part, wetted_triangles
from boatsim.physics.particulars import GRAVITY
from validation.waves.ship_speed import METHODS
from validation.waves.slow_table import HEAVE, PITCH, SlowTable, Wave
from validation.waves.speed_diffraction import MovingHull

# Mesh of the ship in github.com/NavalToolbox/navaltoolbox-lib, commit 6133809 of January 2026:
# x ahead of the aft perpendicular, z above the keel
MESH = Path("rust") / "tests" / "data" / "dtmb5415.stl"
DOME = 3.02317  # [m] depth of its lowest point, of the sonar dome, below the keel
# Length between perpendiculars, draught, and volume without appendages (SIMMAN 2008)
LENGTH, DRAUGHT, VOLUME = 142.0, 6.15, 8424.4  # [m], [m], [m^3]

# A. K. Ariffin, PhD thesis, 2017, figure 3.15, righting arms by the program GHS, as quoted in
# rust/tests/integration_tests.rs of the same repository: heel [deg], GZ [m], trim [deg] without a
# stated direction
DISPLACEMENT, DENSITY = 8.635e6, 1025.0  # [kg], [kg/m^3]
HEIGHT = 7.555  # [m] of the mass centre above the keel
CENTRE = 71.670  # [m] of the mass centre, aft of the forward perpendicular: only there is trim zero
ARMS = (
    (0.0, 0.0, 0.0),
    (5.0, 0.171, 0.01),
    (10.0, 0.339, 0.02),
    (15.0, 0.505, 0.05),
    (20.0, 0.674, 0.09),
    (25.0, 0.848, 0.14),
    (30.0, 0.993, 0.18),
    (35.0, 1.069, 0.19),
    (40.0, 1.077, 0.19),
    (45.0, 1.025, 0.16),
    (50.0, 0.924, 0.12),
    (55.0, 0.789, 0.07),
    (60.0, 0.625, 0.01),
)

# The model, of which FRyDoM's test states length, depth of the tank, height of the mass centre
# above the waterline, and mass and moment of inertia in pitch, here as a radius of gyration
# (github.com/baptistelabat/frydom, tests/demos/bench_DTMB5512.cpp)
MODEL_LENGTH, TANK_DEPTH, ABOVE = 3.048, 3.048, 0.03  # [m]
SCALE = MODEL_LENGTH / LENGTH
GYRADIUS = float(np.sqrt(53.88 / 86.0))  # [m] 0.26 lengths
FRESH = 1000.0  # [kg/m^3] density of the water of the tank
# The same repository, tests/data/bench/DTMB5512/DTMB5512.hdb5 at commit 1b7b8cfc of February 2019,
# boundary elements of another program, at the density 1025 kg/m^3 and the depth of the tank:
# w [rad/s], A33 [kg], B33 [kg/s], A55 [kg m^2], B55 [kg m^2/s], |X3| [N/m] and |X5| [N] in waves
# from ahead, which are its angle 0. A and B are taken linearly between its frequencies
TABLE_DENSITY = 1025.0
TABLE_STIFFNESS = (9680.0, 1250.0, 5420.0)  # C33 [N/m], C35 [N], C55 [N m]
TABLE = (
    (1.9031, 301.9, 229.3, 114.65, 11.3, 7931.7, 2252.0),
    (3.2929, 219.7, 596.4, 124.61, 125.6, 4609.3, 3244.6),
    (4.6827, 131.4, 702.4, 89.91, 316.6, 826.7, 2182.4),
    (5.3776, 114.6, 677.4, 70.11, 343.4, 719.4, 928.1),
    (6.0724, 104.2, 656.4, 59.53, 334.3, 750.3, 505.2),
    (6.7673, 96.8, 625.8, 53.87, 329.3, 347.1, 639.9),
)
COLUMNS = ("A33", "B33", "A55", "B55", "|X3|", "|X5|")

# M. Irvine, J. Longo, F. Stern, Pitch and heave tests and uncertainty assessment for a surface
# combatant in regular head waves, J. Ship Research 52(2), 2008. The values are read from figures
# of FRyDoM's theory manual: heave, and pitch at rest, from DTMB5512_HeaveAmplitude.png and
# DTMB5512_PitchAmplitude.png of the repository above, to 0.005 Hz and 0.003; pitch at speed, and
# the last wave at rest, from Bench_DTMB_RAO_Pitch.png and Bench_DTMB_RAO_Heave.png in
# github.com/srmainwaring/frydom of August 2022, to 0.005. (The earlier figure of pitch at speed
# repeats the values of heave.)
# Froude number -> frequency of encounter [Hz], heave over the amplitude, pitch over the slope
MEASURED = {
    0.0: (
        (0.399, 0.887, 1.041),
        (0.581, 0.602, 0.780),
        (0.653, 0.488, 0.711),
        (0.717, 0.289, 0.415),
        (0.853, 0.204, 0.126),
        (0.944, 0.166, 0.061),
        (1.016, 0.376, 0.067),
    ),
    0.19: (
        (0.599, 0.977, 0.896),
        (0.699, 0.882, 1.028),
        (0.807, 0.787, 0.948),
        (0.898, 0.754, 0.824),
        (1.061, 0.607, 0.620),
        (1.189, 0.417, 0.343),
        (1.288, 0.266, 0.175),
        (1.397, 0.194, 0.073),
        (1.497, 0.166, 0.028),
        (1.697, 0.085, 0.036),
    ),
    0.28: (
        (0.608, 0.996, 1.019),
        (0.807, 0.953, 1.058),
        (0.916, 0.967, 1.051),
        (1.016, 0.977, 0.956),
        (1.116, 0.934, 0.813),
        (1.216, 0.726, 0.568),
        (1.370, 0.356, 0.284),
        (1.560, 0.142, 0.094),
        (1.760, 0.109, 0.023),
        (2.023, 0.062, 0.023),
    ),
    0.34: (
        (0.608, 1.015, 1.003),
        (0.798, 1.034, 1.101),
        (0.989, 1.119, 1.109),
        (1.098, 1.152, 0.978),
        (1.189, 1.020, 0.765),
        (1.325, 0.664, 0.477),
        (1.388, 0.498, 0.371),
    ),
    0.41: (
        (0.798, 1.072, 1.090),
        (1.080, 1.366, 1.141),
        (1.143, 1.380, 1.023),
        (1.306, 1.001, 0.633),
        (1.461, 0.522, 0.354),
        (1.742, 0.123, 0.109),
        (1.996, 0.047, 0.024),
    ),
}
# Lowest and highest frequency of the table of coefficients [rad/s], and their number
LOWEST, HIGHEST, NUMBER = 1.8, 13.0, 23
HEAD = np.pi  # [rad] direction of the waves
# Waves from which the motions are large, and up to which they are near resonance, in lengths. The
# limits lie between measured waves: a frequency read to 0.005 Hz gives a length to 1 %
LONG, RESONANT = 0.97, 2.15
CLOSE = 0.1  # relative error that the aim allows


def read_hull(folder: Path, scale: float = 1.0) -> ClosedMesh:
    """Return the hull, with the forward end of the axes at its bow and the keel at z = 0.

    Args:
        folder: Folder of the repository of NavalToolbox.
        scale: Length of the hull over that of the ship.

    Raises:
        BadInput: The mesh cannot be read.
    """
    return read_closed_mesh(folder / MESH, scale).moved(0.0, 0.0, DOME * scale)


class Arm(NamedTuple):
    """Righting arm and trim of the ship at one heel, published and computed."""

    heel: float  # [deg]
    arm: tuple[float, float]  # [m]
    trim: tuple[float, float]  # [deg], the computed one by the bow


def loaded_hull(folder: Path) -> LoadedHull:
    """Return the ship with its mass centre.

    Args:
        folder: Folder of the repository of NavalToolbox.

    Raises:
        BadInput: The mesh cannot be read.
    """
    centre = np.array([LENGTH - CENTRE, 0.0, -HEIGHT])
    return LoadedHull(read_hull(folder), DISPLACEMENT / DENSITY, centre)


def arms(hull: LoadedHull) -> list[Arm]:
    """Return published and computed righting arms.

    Args:
        hull: The ship.
    """
    curve = righting_arms(hull, np.radians([heel for heel, _, _ in ARMS]))
    rows = []
    for (heel, arm, trim), one in zip(ARMS, curve, strict=True):
        rows.append(Arm(heel, (arm, one.arm), (trim, -float(np.degrees(one.trim)))))
    return rows


def upright(hull: LoadedHull) -> tuple[float, float]:
    """Return the volume at the draught of `DRAUGHT` [m^3], and the metacentric height GM [m].

    Args:
        hull: The ship.
    """
    at_rest = righting_arms(hull, [0.0])[0].submerged
    volume = submerged_part(hull.mesh, DRAUGHT).volume
    return volume, metacentric_heights(hull, at_rest)[0]


def model_mesh(folder: Path) -> HullMesh:
    """Return the hull of the model in the water of its tank.

    Args:
        folder: Folder of the repository of NavalToolbox.
    """
    return HullMesh(
        folder / MESH,
        (DRAUGHT + DOME) * SCALE,
        origin=(LENGTH - CENTRE) * SCALE,
        scale=SCALE,
        density=FRESH,
        depth=TANK_DEPTH,
    )


def compute(folder: Path) -> Coefficients:
    """Return the coefficients of the model in head waves, about a point above its mass centre.

    Args:
        folder: Folder of the repository of NavalToolbox.

    Raises:
        BadInput: Capytaine is not installed, or the mesh cannot be read.
    """
    mesh = model_mesh(folder)
    frequencies = [float(w) for w in np.linspace(LOWEST, HIGHEST, NUMBER)]
    rows = run_capytaine(mesh, frequencies, [HEAD], lambda stage, share: None)
    return coefficients_of_rows(rows, mesh, [HEAD])


class UndisturbedWave:
    """Upward force of the pressure of an undisturbed head wave on the model."""

    def __init__(self, wet: Array) -> None:
        """Prepare the integral over the wetted surface.

        Args:
            wet: Its triangles (N, 3, 3) [m], z down from the surface, seen from the water.
        """
        a, b, c = np.moveaxis(wet, 1, 0)
        self._down = 0.5 * np.cross(b - a, c - a)[:, 2]  # area times the downward normal
        self._middles = 0.5 * np.stack([a + b, b + c, c + a], axis=1)

    def __call__(self, number: float) -> complex:
        """Return the complex force per amplitude [N/m] for the time dependence exp(i w t).

        Args:
            number: Wave number [rad/m].
        """
        x, z = self._middles[..., 0], self._middles[..., 2]
        decay = np.cosh(number * (TANK_DEPTH - z)) / np.cosh(number * TANK_DEPTH)
        pressure = FRESH * GRAVITY * decay * np.exp(1j * number * x)
        return complex(self._down @ pressure.mean(axis=1))


def undisturbed_wave(folder: Path) -> UndisturbedWave:
    """Return the force of undisturbed waves on the model.

    Args:
        folder: Folder of the repository of NavalToolbox.

    Raises:
        BadInput: The mesh cannot be read.
    """
    aft, down = (CENTRE - LENGTH) * SCALE, DRAUGHT * SCALE
    mesh = read_hull(folder, SCALE).moved(aft, 0.0, down)
    return UndisturbedWave(wetted_triangles(mesh.corners))


def table_of_model(folder: Path, found: Coefficients, gyradius: float = GYRADIUS) -> SlowTable:
    """Return the model with its mass, in heave and pitch.

    Args:
        folder: Folder of the repository of NavalToolbox.
        found: Its coefficients.
        gyradius: Radius of gyration in pitch [m].

    Raises:
        BadInput: The mesh cannot be read.
    """
    return SlowTable(found, -ABOVE, gyradius, undisturbed_wave(folder))


class Row(NamedTuple):
    """Coefficients at one frequency for the density of the tank, in the order of `COLUMNS`."""

    frequency: float  # [rad/s]
    published: Array  # (6,)
    found: Array  # (6,)


def coefficient_rows(table: SlowTable) -> list[Row]:
    """Return added mass, damping and excitation of the published table and those computed.

    Args:
        table: The model.
    """
    rows = []
    for w, *published in TABLE:
        added, damping = table.coefficients(w)
        wave = Wave(w, 0.0, 0.0)
        force, moment = np.abs(table.excitation(wave))
        found = (added[0, 0], damping[0, 0], added[1, 1], damping[1, 1], force, moment)
        rows.append(Row(w, np.array(published) * FRESH / TABLE_DENSITY, np.array(found)))
    return rows


def stiffness_pairs(table: SlowTable) -> list[tuple[float, float]]:
    """Return published and computed stiffness C33 [N/m], C35 [N] and C55 [N m].

    Args:
        table: The model.
    """
    own = (table.stiffness[0, 0], table.stiffness[0, 1], table.stiffness[1, 1])
    pairs = []
    for published, found in zip(TABLE_STIFFNESS, own, strict=True):
        pairs.append((published * FRESH / TABLE_DENSITY, float(found)))
    return pairs


def met_wave(encounter: float, speed: float) -> Wave:
    """Return the head wave in the tank that is met at a frequency.

    Args:
        encounter: Frequency of encounter [rad/s].
        speed: Forward speed [m/s].
    """

    def excess(k: float) -> float:
        return float(np.sqrt(GRAVITY * k * np.tanh(k * TANK_DEPTH))) + k * speed - encounter

    shortest = 0.01 * MODEL_LENGTH  # [m] beyond all waves of a tank
    k = float(brentq(excess, 1e-6, 2.0 * np.pi / shortest, xtol=1e-12))
    return Wave(encounter - k * speed, k, speed)


class Motion(NamedTuple):
    """Heave over the amplitude and pitch over the slope of a head wave."""

    froude: float
    encounter: float  # [Hz]
    ratio: float  # wavelength over the length
    measured: tuple[float, float]
    found: tuple[tuple[float, float], ...]  # by each of `NAMES`


# Further methods, all with the terms of forward speed: with the moment of the diffraction at speed
# too, with the damping of pitch at zero speed, as measured on Wigley hulls (`wigley_speed`), and
# with the excitation of `speed_diffraction`
NAMES = (*METHODS, "diffraction", "damping", "encounter")


def met_excitation(folder: Path) -> dict[tuple[float, float], Array]:
    """Return the excitation with the diffraction at the frequency of encounter.

    Args:
        folder: Folder of the repository of NavalToolbox.

    Returns:
        For the Froude number and the frequency of encounter [Hz] of each test at speed, the complex
        excitation (2,) in heave and pitch per amplitude [N/m, N].

    Raises:
        BadInput: Capytaine is not installed, or the mesh cannot be read.
    """
    hull, found = MovingHull(model_mesh(folder)), {}
    for froude, points in MEASURED.items():
        speed = froude * float(np.sqrt(GRAVITY * MODEL_LENGTH))
        for hertz, _, _ in points:
            if speed == 0.0:
                continue
            wave = met_wave(2.0 * np.pi * hertz, speed)
            met = MetWave(wave.frequency, wave.encounter, HEAD, speed)
            found[froude, hertz] = hull.excitation(met)[[HEAVE, PITCH]]
    return found


def motions(table: SlowTable, met: dict[tuple[float, float], Array]) -> list[Motion]:
    """Return measured and computed motions.

    Args:
        table: The model.
        met: Excitation of the tests at speed, by `met_excitation`.
    """
    rows = []
    for froude, points in MEASURED.items():
        speed = froude * float(np.sqrt(GRAVITY * MODEL_LENGTH))
        for hertz, *measured in points:
            wave = met_wave(2.0 * np.pi * hertz, speed)
            found = []
            for method in METHODS:
                found.append(_over_slope(table.heave_and_pitch(wave, method), wave))
            found.append(_over_slope(table.heave_and_pitch(wave, METHODS[-1], True), wave))
            found.append(_over_slope(_with_damping_at_rest(table, wave), wave))
            force = met.get((froude, hertz), table.excitation(wave))
            found.append(_over_slope(table.motion_under(wave, METHODS[-1], force), wave))
            ratio = 2.0 * np.pi / wave.number / MODEL_LENGTH
            pair = (measured[0], measured[1])
            rows.append(Motion(froude, hertz, ratio, pair, tuple(found)))
    return rows


def _with_damping_at_rest(table: SlowTable, wave: Wave) -> Array:
    """Return the motion (2,) with the terms of forward speed but for the damping of pitch."""
    w = wave.encounter
    radiated = table.radiation(w, wave.speed, METHODS[-1])
    at_rest = table.radiation(w, 0.0, METHODS[-1])[1, 1]
    radiated[1, 1] = complex(radiated[1, 1].real, at_rest.imag)
    dynamic = table.stiffness - w * w * table.body + radiated
    return np.asarray(np.linalg.solve(dynamic, table.excitation(wave)))


def _over_slope(motion: Array, wave: Wave) -> tuple[float, float]:
    """Return the size of heave and of pitch over the slope of the wave."""
    heave, pitch = np.abs(motion)
    return float(heave), float(pitch / wave.number)


class Errors(NamedTuple):
    """Errors of heave or pitch in waves of some lengths."""

    within: int  # number of waves with at most `CLOSE`
    waves: int
    largest: float  # relative error of the largest size
    mean: float  # mean of the relative errors without their sign


def errors(
    rows: list[Motion], place: int, method: int, longest: float, moving: bool = True
) -> Errors:
    """Return the errors of a motion in waves from `LONG` lengths on.

    Args:
        rows: Measured and computed motions.
        place: 0 for heave, 1 for pitch.
        method: Place among `NAMES`.
        longest: Longest wave over the length.
        moving: Whether the tests at speed are meant, or those at rest.
    """
    found = []
    for row in rows:
        if LONG <= row.ratio <= longest and (row.froude > 0.0) == moving:
            found.append(row.found[method][place] / row.measured[place] - 1.0)
    sizes = np.abs(found)
    largest = found[int(np.argmax(sizes))]
    return Errors(int(np.sum(sizes <= CLOSE)), len(found), float(largest), float(sizes.mean()))
