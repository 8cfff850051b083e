"""Motions of the KRISO container ship (KCS) in waves at forward speed against model tests.

Its offsets are read from a folder of the user's, as they come without a licence: `kcs.fix` of the
KRISO, in full scale. The tests are cases 2.10 and 2.11 of the workshop Tokyo 2015.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.capytaine_worker import MetWave
from boatsim.hydrodynamics.computation import HullMesh, coefficients_of_rows, run_capytaine
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves.hull_at_speed import Complex, HullAtSpeed, Loading, Wave
from validation.waves.hulls import write_obj
from validation.waves.loft import Hydrostatics, Panels, Station, hydrostatics, loft, section_area
from validation.waves.ship_speed import METHODS
from validation.waves.speed_diffraction import MovingHull

# Table of offsets, in github.com/lohith-g-45/Hydrohackathon at commit 0a99ce5b, folder
# data/external_benchmarks/kcs; it was published by the KRISO and by the workshop of 2015
OFFSETS = "kcs.fix"
MOST_NUMBERS = 1_000_000  # of a table of offsets; that of the ship has some 11,500

# Particulars in full scale, of the workshop and of SIMMAN 2008
LENGTH, BEAM, DRAUGHT = 230.0, 32.2, 10.8  # [m]
VOLUME, MIDSHIP = 52030.0, 0.985  # [m^3], [-] area of the midship section over beam and draught
CENTRE = -0.0148  # [-] of buoyancy ahead of midships, over the length
KEEL_TO_CENTRE, HEIGHT = 0.168 / 2.7 * LENGTH, 0.6  # [m] KG of the model of case 2.11, and GM
DENSITY = 1000.0  # [kg/m^3] of fresh water; the results have no unit and do not depend on it
# Radii of gyration, of which the workshop gives none: those of SIMMAN, which are an assumption here
ROLL_GYRADIUS, PITCH_GYRADIUS = 0.40 * BEAM, 0.25 * LENGTH  # [m]
GYRADIUS_STEP = 0.01 * LENGTH  # [m] by which the radius in pitch is changed
ROLL_STEP = 0.05  # [-] damping of roll by viscosity, over the critical, that is compared with none
RESOLUTIONS = (Panels(24, 6, 2), Panels(36, 8, 3), Panels(54, 12, 4))  # of the mesh
# Waves from which motions are large, and up to which they are near resonance, in lengths, as for
# the combatant DTMB 5415
LONG, RESONANT = 0.97, 2.15
CLOSE = 0.1  # relative error that the aim allows
UPRIGHT, FOUR = ("heave", "pitch"), ("surge", "heave", "roll", "pitch")

# First harmonics of the measured time histories, EFD_*.dat of the workshop as stored in
# github.com/Ryu0523/rowbot_sim, commit c55e5bd0, data/external/kcs_t2015
# Case 2.10, waves from ahead, model of 6.0702 m towed at 2.017 m/s, free in heave and pitch:
# wavelength [m], heave over the amplitude, pitch over the slope of the wave, and the phases of
# heave (up) and pitch (bow up) before the crest at the forward perpendicular [deg]
HEAD_LENGTH, HEAD_SPEED = 6.0702, 2.017  # [m], [m/s]
HEAD_MEASURED = (
    (3.949, 0.1286, 0.0163, 88.3, 48.7),
    (5.164, 0.2413, 0.1456, 80.7, 101.8),
    (6.979, 0.8993, 0.7483, 174.6, -150.7),
    (8.321, 0.8743, 0.9646, -145.5, -105.7),
    (11.840, 0.9312, 1.1185, -98.6, -33.3),
)
# Case 2.11, waves as long as the model of 2.7 m at 1.34 m/s, of which surge, heave, roll and pitch
# are published; that sway and yaw were held is an assumption. Angle of the waves [deg], 0 from
# ahead, heave over the amplitude, roll and pitch over the slope
OBLIQUE_LENGTH, OBLIQUE_SPEED = 2.7, 1.34  # [m], [m/s]
OBLIQUE_MEASURED = (
    (0.0, 0.54, np.nan, 0.43),
    (45.0, 0.96, 0.61, 0.56),
    (90.0, 0.89, 0.17, 0.04),
    (135.0, 0.41, 2.72, 0.44),
    (180.0, 0.07, np.nan, 0.17),
)


def read_offsets(path: Path) -> list[Station]:
    """Return the stations of a table of offsets.

    The file has a line with the name of the ship and the number of stations; then for each station
    its place, the number of its points, all half-breadths and all heights.

    Args:
        path: The file.

    Raises:
        BadInput: The file does not exist, or its content is no such table.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    words = path.read_text(encoding="latin-1").partition("\n")[2].split()
    if not 0 < len(words) <= MOST_NUMBERS:
        raise BadInput(f"{path}: {len(words)} numbers; allowed are 1 to {MOST_NUMBERS}")
    try:
        numbers = np.array(words, dtype=float)
    except ValueError as error:
        raise BadInput(f"{path}: {error}") from None
    if not np.isfinite(numbers).all():
        raise BadInput(f"{path}: it has numbers that are not finite")
    count, at = int(numbers[0]), 1
    stations: list[Station] = []
    for number in range(1, count + 1):
        if at + 2 > len(numbers):
            raise BadInput(f"{path}: {number - 1} stations; its second line states {count}")
        x, points = float(numbers[at]), int(numbers[at + 1])
        own = numbers[at + 2 : at + 2 + 2 * points]
        if points < 2 or len(own) < 2 * points:
            raise BadInput(
                f"{path}: station {number} has {len(own)} numbers; its {points} points need "
                f"{2 * points}, and allowed are 2 points and more"
            )
        station = Station(x, own[:points], own[points:])
        _check_station(station, stations, f"{path}: station {number}")
        stations.append(station)
        at += 2 + 2 * points
    if at != len(numbers):
        raise BadInput(f"{path}: {len(numbers) - at} numbers follow the last station")
    return stations


def _check_station(station: Station, before: list[Station], label: str) -> None:
    """Raise BadInput if a station is not ahead of the one before, or no section."""
    if before and station.x <= before[-1].x:
        raise BadInput(f"{label} at {station.x:g} m; allowed is above {before[-1].x:g} m")
    if station.half_breadth.min() < 0.0:
        raise BadInput(f"{label} has a half-breadth of {station.half_breadth.min():g} m")
    if np.diff(station.height).min() < 0.0:
        raise BadInput(f"{label} has heights that decrease; allowed are heights from the keel up")


class Hull(NamedTuple):
    """Hull of the ship."""

    stations: list[Station]
    mesh: Array  # triangles (N, 3, 3) [m] of its wetted surface
    rest: Hydrostatics


def lofted(stations: list[Station], panels: Panels) -> Hull:
    """Return the hull with a mesh.

    Args:
        stations: Its stations.
        panels: Numbers of panels.

    Raises:
        BadInput: It has no volume below the waterline.
    """
    mesh = loft(stations, DRAUGHT, panels)
    return Hull(stations, mesh, hydrostatics(mesh))


class Particular(NamedTuple):
    """A published number of the ship and that of its mesh."""

    name: str
    unit: str
    published: float
    found: float


def particulars(hull: Hull) -> list[Particular]:
    """Return published hydrostatics of the ship and those of its mesh.

    The coefficient of the midship section is that of the offsets.

    Args:
        hull: The hull.
    """
    middle = min(hull.stations, key=lambda station: abs(station.x - 0.5 * LENGTH))
    area = section_area(middle, DRAUGHT)
    keel = DRAUGHT + float(hull.rest.centre[2]) + hull.rest.metacentre
    return [
        Particular("volume", "m^3", VOLUME, hull.rest.volume),
        Particular("LCB", "% L", 100 * CENTRE, 100 * (hull.rest.centre[0] / LENGTH - 0.5)),
        Particular("CM", "", MIDSHIP, area / (BEAM * DRAUGHT)),
        Particular("KM", "m", KEEL_TO_CENTRE + HEIGHT, keel),
        Particular("GM", "m", HEIGHT, keel - KEEL_TO_CENTRE),
    ]


def head_waves() -> list[Wave]:
    """Return the waves of case 2.10 in full scale."""
    scale = LENGTH / HEAD_LENGTH
    speed = HEAD_SPEED * float(np.sqrt(scale))
    return [Wave(length * scale, np.pi, speed) for length, *_ in HEAD_MEASURED]


def oblique_waves() -> list[Wave]:
    """Return the waves of case 2.11 in full scale."""
    speed = OBLIQUE_SPEED * float(np.sqrt(LENGTH / OBLIQUE_LENGTH))
    waves = []
    for angle, *_ in OBLIQUE_MEASURED:
        waves.append(Wave(LENGTH, float(np.pi - np.radians(angle)), speed))
    return waves


def hull_mesh(folder: Path, hull: Hull) -> HullMesh:
    """Write the mesh of the hull and return it for the boundary element method.

    Args:
        folder: Working folder.
        hull: The hull.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"kcs_{len(hull.mesh)}.obj"
    write_obj(path, hull.mesh, "KCS below its waterline, z = 0 there")
    return HullMesh(path, DRAUGHT, origin=float(hull.rest.centre[0]), density=DENSITY)


def met_excitation(folder: Path, hull: Hull) -> list[Array]:
    """Return the excitation (6,) of each wave with the diffraction at the frequency of encounter.

    Args:
        folder: Working folder.
        hull: The hull.

    Returns:
        Complex excitation about the waterline, of the waves of both cases [N/m, N].

    Raises:
        BadInput: Capytaine is not installed.
    """
    moving = MovingHull(hull_mesh(folder, hull))
    found = []
    for wave in head_waves() + oblique_waves():
        met = MetWave(wave.frequency, wave.encounter, wave.direction, wave.speed)
        found.append(moving.excitation(met))
    return found


def compute(folder: Path, hull: Hull, waves: list[Wave]) -> Coefficients:
    """Return the coefficients of the hull at the frequencies of waves and of encounter.

    Args:
        folder: Working folder.
        hull: The hull.
        waves: The waves.

    Raises:
        BadInput: Capytaine is not installed or fails.
    """
    mesh = hull_mesh(folder, hull)
    frequencies = sorted({w for wave in waves for w in (wave.frequency, wave.encounter)})
    headings = sorted({wave.direction for wave in waves})
    rows = run_capytaine(mesh, frequencies, headings, lambda stage, share: None)
    return coefficients_of_rows(rows, mesh, headings)


def usual_loading() -> Loading:
    """Return the distribution of the mass that is assumed, without viscous damping of roll."""
    gyradii = (ROLL_GYRADIUS, PITCH_GYRADIUS, PITCH_GYRADIUS)
    return Loading(DRAUGHT - KEEL_TO_CENTRE, HEIGHT, gyradii)


def hull_at_speed(hull: Hull, found: Coefficients, loading: Loading) -> HullAtSpeed:
    """Return the hull with its coefficients and its mass.

    Args:
        hull: The hull.
        found: Its coefficients.
        loading: Distribution of its mass.
    """
    return HullAtSpeed(found, loading, hull.mesh, float(hull.rest.centre[0]))


COEFFICIENTS = ("A33", "B33", "A55", "B55", "A44", "B44")


def coefficients_without_units(moving: HullAtSpeed, w: float) -> Array:
    """Return added mass over the mass and damping sqrt(L / g) over it (6,).

    They are in the order of `COEFFICIENTS`. Those of pitch are divided by the square of the length,
    those of roll by that of the beam.

    Args:
        moving: The hull.
        w: Frequency [rad/s], one of those of the coefficients.
    """
    added, damping = moving.coefficients(w)
    mass, values = float(moving.body[0, 0]), []
    for axis, lever in (("heave", 1.0), ("pitch", LENGTH), ("roll", BEAM)):
        place = AXES.index(axis)
        unit = mass * lever**2
        values.append(float(added[place, place]) / unit)
        values.append(float(damping[place, place]) * float(np.sqrt(LENGTH / GRAVITY)) / unit)
    return np.array(values)


# The three methods of `ship_speed`; the last one with the moment of the diffraction at speed; and
# this with the diffraction at the frequency of encounter
NAMES = (*METHODS, "diffraction", "encounter")


class Motion(NamedTuple):
    """Motion in one wave, over the amplitude of the wave and over its slope."""

    case: str
    angle: float  # [deg] of the waves, 0 from ahead
    ratio: float  # wavelength over the length
    axis: str
    measured: float
    found: tuple[float, ...]  # by each of `NAMES`
    measured_phase: float  # [deg]; nan if it is not compared
    phase: tuple[float, ...]  # [deg] by each of `NAMES`, before the crest at the forward end


def motions(moving: HullAtSpeed, met: list[Array], oblique: tuple[str, ...] = FOUR) -> list[Motion]:
    """Return measured and computed motions of both cases.

    Args:
        moving: The hull.
        met: Excitation (6,) of each wave, of `met_excitation`.
        oblique: Degrees of freedom that are not held in case 2.11.
    """
    rows, number = [], 0
    for wave, (_, heave, pitch, *phases) in zip(head_waves(), HEAD_MEASURED, strict=True):
        measured = {"heave": (heave, phases[0]), "pitch": (pitch, phases[1])}
        every = _every_method(moving, wave, UPRIGHT, met[number])
        rows += _rows("2.10", wave, every, measured)
        number += 1
    for wave, (_, heave, roll, pitch) in zip(oblique_waves(), OBLIQUE_MEASURED, strict=True):
        measured = {"heave": (heave, np.nan), "roll": (roll, np.nan), "pitch": (pitch, np.nan)}
        if np.isnan(roll):
            del measured["roll"]
        every = _every_method(moving, wave, oblique, met[number])
        rows += _rows("2.11", wave, every, measured)
        number += 1
    return rows


def _every_method(
    moving: HullAtSpeed, wave: Wave, free: tuple[str, ...], met: Array
) -> list[Complex]:
    """Return the motions (6,) by each of `NAMES`, after the crest at the forward perpendicular."""
    ahead = LENGTH - moving.place
    crest = np.exp(1j * wave.number * ahead * np.cos(wave.direction))
    every = [moving.motion(wave, free, method) for method in METHODS]
    every.append(moving.motion(wave, free, METHODS[-1], True))
    every.append(moving.motion(wave, free, METHODS[-1], True, met))
    return [one * crest for one in every]


def _rows(
    case: str, wave: Wave, every: list[Complex], measured: dict[str, tuple[float, float]]
) -> list[Motion]:
    """Return the motions of the measured axes in one wave."""
    rows = []
    for axis, (value, phase) in measured.items():
        # heave is measured upwards; pitch and roll by their slope
        unit = -1.0 if axis == "heave" else 1.0 / wave.number
        own = [complex(one[AXES.index(axis)]) * unit for one in every]
        rows.append(
            Motion(
                case,
                180.0 - float(np.degrees(wave.direction)),
                wave.length / LENGTH,
                axis,
                value,
                tuple(abs(one) for one in own),
                phase,
                tuple(float(np.degrees(np.angle(one))) for one in own),
            )
        )
    return rows


class Computed(NamedTuple):
    """The ship with its coefficients and its excitation of `met_excitation`."""

    hull: Hull
    found: Coefficients
    met: list[Array]

    def motions(self, loading: Loading, oblique: tuple[str, ...] = FOUR) -> list[Motion]:
        """Return measured and computed motions of both cases.

        Args:
            loading: Distribution of the mass.
            oblique: Degrees of freedom that are not held in case 2.11.
        """
        return motions(hull_at_speed(self.hull, self.found, loading), self.met, oblique)


def chosen(rows: list[Motion], case: str, axis: str, resonant: bool = True) -> list[Motion]:
    """Return the motions of one case and axis.

    Args:
        rows: Motions.
        case: The case.
        axis: The axis.
        resonant: Whether only waves of `LONG` to `RESONANT` lengths count.
    """
    found = []
    for row in rows:
        near = LONG <= row.ratio <= RESONANT
        if row.case == case and row.axis == axis and (near or not resonant):
            found.append(row)
    return found


def errors(rows: list[Motion], method: int) -> tuple[int, float, float]:
    """Return the number of errors up to `CLOSE`, their mean without sign, and the largest.

    Args:
        rows: Motions.
        method: Place among `NAMES`.
    """
    found = np.array([row.found[method] / row.measured - 1.0 for row in rows])
    sizes = np.abs(found)
    return int(np.sum(sizes <= CLOSE)), float(sizes.mean()), float(found[np.argmax(sizes)])
