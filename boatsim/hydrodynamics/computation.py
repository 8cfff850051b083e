"""Coefficients by Capytaine, in a process of its own, with a cache of computed frequencies."""

import hashlib
import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.axes import (
    excitation_to_sname,
    restoring_matrix,
    to_sname,
    with_memory,
)
from boatsim.hydrodynamics.mean_drift import DRIFT_AXES, mean_drift
from boatsim.hydrodynamics.response import Ballast, floating_response
from boatsim.physics.cache_folder import cache_folder
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import AXES, Array

WORKER = Path(__file__).with_name("capytaine_worker.py")
NEEDED = 'boatsim hydrodynamics needs capytaine and trimesh: pip install "boatsim[bem]"'
MESHES = (".stl", ".obj", ".ply")
# Default waves, in lengths of the hull. In longer ones a boat follows the surface, in shorter ones
# the excitation is small; the panels must be short against the shortest
LONGEST, SHORTEST = 20.0, 0.5
PANELS_PER_WAVE = 8.0  # of the shortest wave; with half as many the errors reach 10 %
FEWEST_PANELS = 4.0  # of a scattered wave: the half of them, below which a note is printed
FREQUENCIES, HEADINGS = 30, 13  # default numbers; headings every 15 degrees
MOST_PANELS = 6000  # the matrices of this many need some 2 GB
Report = Callable[[str, float], None]


@dataclass(frozen=True)
class HullMesh:
    """A hull for the boundary element method.

    Attributes:
        mesh: File of its surface [m], z up, x forward; the deck may be part of it.
        draught: Draught above the lowest point of the mesh [m].
        origin: Place of the origin of motion in the mesh, along x [m].
        scale: Length of a unit of the mesh [m].
        density: Density of the water [kg/m^3].
        depth: Depth of the water [m]; 0 for deep water.
        panel: Longest edge of a panel [m]; 0 for the panels of the file.
    """

    mesh: Path
    draught: float
    origin: float = 0.0
    scale: float = 1.0
    density: float = 1025.0
    depth: float = 0.0
    panel: float = 0.0


@dataclass(frozen=True)
class MeshStudy:
    """Comparison of a mesh with the same mesh with panels of half the size.

    Attributes:
        panels: Numbers of panels of both.
        change: For added mass and damping (entries on the diagonal), and for excitation and mean
            drift of waves from the bow, the largest change over the largest value of the axis [-],
            and that axis.
    """

    panels: tuple[int, int]
    change: dict[str, tuple[float, str]]


def check_installed() -> None:
    """Raise BadInput with the command that installs Capytaine if it is missing."""
    if find_spec("capytaine") is None or find_spec("trimesh") is None:
        raise BadInput(NEEDED)


def default_frequencies(length: float, depth: float, number: int = FREQUENCIES) -> list[float]:
    """Return equally spaced frequencies of waves from half of the hull's length to 20 lengths.

    Args:
        length: Length of the hull [m].
        depth: Depth of the water [m]; 0 for deep water.
        number: Number of frequencies.
    """
    found = []
    for waves in (LONGEST, SHORTEST):
        k = 2.0 * np.pi / (waves * length)
        attenuation = np.tanh(k * depth) if depth > 0.0 else 1.0
        found.append(float(np.sqrt(GRAVITY * k * attenuation)))
    return [float(w) for w in np.linspace(found[0], found[1], number)]


def mesh_size(hull: HullMesh) -> tuple[float, float]:
    """Return length and beam of the hull's mesh [m].

    Args:
        hull: The hull.

    Raises:
        BadInput: The file does not exist, is no mesh, or Capytaine is not installed.
    """
    check_installed()
    if not hull.mesh.is_file():
        raise BadInput(f"{hull.mesh}: there is no such file")
    import trimesh

    try:
        mesh: Any = trimesh.load(hull.mesh, force="mesh")
        low, high = np.asarray(mesh.bounds) * hull.scale
    except (ValueError, TypeError, IndexError, AttributeError) as error:
        raise BadInput(f"{hull.mesh}: the mesh cannot be read: {error}") from None
    if not 0.0 < hull.draught <= high[2] - low[2] + 1e-9:
        raise BadInput(
            f"--draught = {hull.draught:g} m; allowed is above 0 to the height of the mesh, "
            f"{high[2] - low[2]:g} m"
        )
    return float(high[0] - low[0]), float(high[1] - low[1])


def default_gyradii(length: float, beam: float) -> tuple[float, float, float]:
    """Return radii of gyration in roll, pitch and yaw [m] of a hull whose mass is not known.

    They are 0.35 of the beam and a quarter of the length, the usual values for models whose
    distribution of mass is not known (ITTC 7.5-02-07-02.1, Seakeeping Experiments).

    Args:
        length: Length of the hull [m].
        beam: Beam of the hull [m].
    """
    return 0.35 * beam, 0.25 * length, 0.25 * length


def default_panel(length: float) -> float:
    """Return the longest edge of a panel [m] for the default frequencies.

    Args:
        length: Length of the hull [m].
    """
    return SHORTEST * length / PANELS_PER_WAVE


def highest_resolved(panel: float, speed: float) -> float:
    """Return the frequency of waves from ahead whose scattered waves are four panels long [rad/s].

    At a speed the hull meets waves from ahead at a higher frequency, at which they are scattered as
    shorter waves. The dispersion is that of deep water, which such short waves have.

    Args:
        panel: Longest edge of a panel [m].
        speed: Forward speed [m/s], above 0.
    """
    met = float(np.sqrt(2.0 * np.pi * GRAVITY / (FEWEST_PANELS * panel)))
    tau = speed * met / GRAVITY
    return 2.0 * met / (1.0 + float(np.sqrt(1.0 + 4.0 * tau)))


def run_capytaine(
    hull: HullMesh,
    frequencies: list[float],
    headings: list[float],
    report: Report,
    halvings: int = 0,
    speed: float = 0.0,
) -> list[dict[str, Any]]:
    """Compute the coefficients of a hull; frequencies of an earlier call come from the cache.

    Args:
        hull: The hull.
        frequencies: Angular frequencies [rad/s].
        headings: Directions to which the waves run in SNAME axes [rad].
        report: Called with a text and the fraction done.
        halvings: How often the edges of all panels are halved.
        speed: Forward speed [m/s] at which the excitation is computed too.

    Returns:
        One dictionary for the geometry, for each frequency and for infinite frequency, in the axes
        of Capytaine. At a speed those of the frequencies have `excitation_at_speed`.

    Raises:
        BadInput: Capytaine is not installed or fails.
    """
    check_installed()
    request = {
        "mesh": str(hull.mesh.resolve()),
        "draught": hull.draught,
        "origin": hull.origin,
        "scale": hull.scale,
        "panel": hull.panel,
        "density": hull.density,
        "depth": hull.depth,
        "gravity": GRAVITY,
        "headings": [-angle for angle in headings],
        "halvings": halvings,
        "speed": speed,
        "most_panels": MOST_PANELS,
    }
    key = request | {"mesh": hashlib.sha256(hull.mesh.read_bytes()).hexdigest()}
    key["worker"] = hashlib.sha256(WORKER.read_bytes()).hexdigest()
    key["capytaine"] = version("capytaine")
    digest = hashlib.sha256(json.dumps(key, sort_keys=True).encode()).hexdigest()[:20]
    folder = cache_folder() / "hydrodynamics"
    folder.mkdir(mode=0o700, exist_ok=True)
    results, path = folder / f"{digest}.jsonl", folder / f"{digest}.json"
    request |= {"frequencies": frequencies, "results": str(results)}
    path.write_text(json.dumps(request), encoding="utf-8")
    _run_worker(path, report)
    wanted = {*frequencies, "geometry", "infinite"}
    rows = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()]
    return [row for row in rows if row["frequency"] in wanted]


def _run_worker(request: Path, report: Report) -> None:
    """Run the script of the computation; raise BadInput with its last line if it fails."""
    command = [sys.executable, "-P", str(WORKER), str(request)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            assert process.stdout is not None and process.stderr is not None
            for line in process.stdout:
                words = line.split()
                if len(words) == 4 and words[0] == "done":
                    report(f"frequency {words[1]} of {words[3]}", int(words[1]) / int(words[3]))
            errors = process.stderr.read().strip().splitlines()
        except BaseException:
            process.kill()
            raise
    if process.returncode != 0:
        reason = errors[-1] if errors else f"exit code {process.returncode}"
        raise BadInput(f"Capytaine failed: {reason}")


def coefficients_of_rows(
    rows: list[dict[str, Any]], hull: HullMesh, headings: list[float]
) -> Coefficients:
    """Return coefficients at rest in SNAME axes from results of Capytaine, without mean drift.

    Args:
        rows: Results of `run_capytaine`.
        hull: The hull.
        headings: Directions to which the waves run in SNAME axes (H,) [rad].
    """
    shape = next(row for row in rows if row["frequency"] == "geometry")
    infinite = next(row for row in rows if row["frequency"] == "infinite")
    waves = sorted(
        (row for row in rows if isinstance(row["frequency"], float)),
        key=lambda row: row["frequency"],
    )
    excitation = _complex([row["excitation"] for row in waves])
    x, port, up = shape["buoyancy"]
    restoring = restoring_matrix(
        hull.density * GRAVITY,
        shape["area"],
        np.array([shape["first"][0], -shape["first"][1]]),
        np.array(shape["second"]),
        shape["volume"],
        -up,
    )
    panels = shape["panels"]
    return Coefficients(
        source=f"Capytaine {version('capytaine')}, {hull.mesh.name}, {panels} panels, with a lid",
        density=hull.density,
        depth=hull.depth,
        draught=hull.draught,
        volume=shape["volume"],
        buoyancy=np.array([x, -port, -up]),
        restoring=restoring,
        frequency=np.array([row["frequency"] for row in waves]),
        added_mass=to_sname(np.array([row["added_mass"] for row in waves])),
        damping=to_sname(np.array([row["damping"] for row in waves])),
        infinite_added_mass=to_sname(np.array(infinite["added_mass"])),
        heading=np.array(headings),
        excitation=excitation_to_sname(excitation, conjugate=True),
    )


def _complex(pairs: Any) -> Array:
    values = np.array(pairs)
    return np.asarray(values[..., 0] + 1j * values[..., 1])


def with_excitation_at_speed(
    found: Coefficients, rows: list[dict[str, Any]], speed: float
) -> Coefficients:
    """Return a copy of coefficients with the excitation at a forward speed.

    Args:
        found: Coefficients of `rows` at rest.
        rows: Results of `run_capytaine` at the speed.
        speed: Forward speed [m/s]; the copy equals the coefficients if it is 0.
    """
    if speed == 0.0:
        return found
    by_frequency = {row["frequency"]: row for row in rows}
    pairs = []
    for frequency in found.frequency:
        pairs.append(by_frequency[float(frequency)]["excitation_at_speed"])
    excitation = excitation_to_sname(_complex(pairs), conjugate=True)
    return replace(found, excitation=excitation, speed=speed)


def floating_coefficients(
    rows: list[dict[str, Any]],
    hull: HullMesh,
    headings: list[float],
    ballast: Ballast,
    speed: float = 0.0,
) -> Coefficients:
    """Return coefficients with the mean drift of the freely floating hull at rest.

    Args:
        rows: Results of `run_capytaine`.
        hull: The hull.
        headings: Directions to which the waves run in SNAME axes (H,) [rad].
        ballast: Distribution of the mass.
        speed: Forward speed [m/s] of the excitation and of the results.

    Raises:
        BadInput: The hull would capsize.
    """
    found = coefficients_of_rows(rows, hull, headings)
    response, extra = floating_response(found, ballast)
    drift = mean_drift(rows, found, response, extra)
    found = replace(found, drift=drift, drift_of=ballast.words(found))
    return with_excitation_at_speed(found, rows, speed)


def compute_coefficients(
    hull: HullMesh,
    frequencies: list[float],
    headings: list[float],
    ballast: Ballast,
    report: Report,
    speed: float = 0.0,
) -> Coefficients:
    """Compute the coefficients of a hull by Capytaine and fit the memory of its radiation force.

    Args:
        hull: The hull.
        frequencies: Angular frequencies [rad/s].
        headings: Directions to which the waves run [rad], 0 to pi.
        ballast: Distribution of the mass, by which the hull moves while it drifts.
        report: Called with a text and the fraction done.
        speed: Forward speed [m/s] of the excitation; all other coefficients are those at rest.

    Raises:
        BadInput: Capytaine is not installed or fails, or the hull would capsize.
    """
    rows = run_capytaine(hull, frequencies, headings, report, speed=speed)
    report("memory of the radiation force", 1.0)
    return with_memory(floating_coefficients(rows, hull, headings, ballast, speed))


def study_mesh(
    hull: HullMesh,
    frequencies: list[float],
    ballast: Ballast,
    report: Report,
    speed: float = 0.0,
) -> MeshStudy:
    """Compare a mesh with the same mesh with edges of half the length.

    Args:
        hull: The hull.
        frequencies: Some of the frequencies of the computation [rad/s].
        ballast: Distribution of the mass.
        report: Called with a text and the fraction done.
        speed: Forward speed [m/s] of the excitation.
    """
    headings = [0.75 * np.pi]  # waves that excite all axes
    found, panels = [], []
    for halvings in (0, 1):
        rows = run_capytaine(hull, frequencies, headings, report, halvings, speed)
        found.append(floating_coefficients(rows, hull, headings, ballast, speed))
        panels.append(next(row["panels"] for row in rows if row["frequency"] == "geometry"))
    coarse, fine = found
    change = {}
    for name in ("added_mass", "damping"):
        first = np.einsum("nii->ni", getattr(coarse, name))
        second = np.einsum("nii->ni", getattr(fine, name))
        change[name.replace("_", " ")] = _largest_change(first, second)
    change["excitation"] = _largest_change(
        coarse.excitation.reshape(-1, len(AXES)), fine.excitation.reshape(-1, len(AXES))
    )
    drifts = np.zeros((2, len(frequencies), len(AXES)))
    for place, one in enumerate(found):
        assert one.drift is not None
        drifts[place][:, DRIFT_AXES] = one.drift[:, 0]
    change["mean drift"] = _largest_change(drifts[0], drifts[1])
    return MeshStudy((panels[0], panels[1]), change)


def _largest_change(first: Array, second: Array) -> tuple[float, str]:
    """Return the largest change (N, 6) over the largest value of its axis, and the axis."""
    size = np.abs(second).max(axis=0)
    size[size == 0.0] = np.inf
    change = np.abs(first - second).max(axis=0) / size
    axis = int(np.argmax(change))
    return float(change[axis]), AXES[axis]
