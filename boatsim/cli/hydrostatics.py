"""Implementation of `boatsim hydrostatics`: a floating hull, and its righting arms over heel."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from math import degrees, radians
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import Exit, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.physics.content import all_content_names
from boatsim.physics.effects.hull_buoyancy import HullBuoyancy
from boatsim.physics.hull.floating import (
    LoadedHull,
    RightingArm,
    depth_of_volume,
    metacentric_heights,
    righting_arm,
    righting_arms,
    vanishing_angle,
)
from boatsim.physics.hull.mesh import KINDS, ClosedMesh, read_closed_mesh
from boatsim.physics.hull.submerged import submerged_part
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.simulate import scenario
from boatsim.view.curve_plot import curve_plot

CSV, SVG = "righting_arm.csv", "righting_arm.svg"
HEELS = ",".join(str(10 * i) for i in range(19))  # [deg] default


@dataclass(frozen=True)
class HydrostaticsOptions:
    """Options of the command.

    Attributes:
        mass: Mass [kg]; None for that of the vessel, or of the draught.
        draught: Draught of the level hull above its lowest point [m]; None for that of the mass.
        centre_depth: Depth of the mass centre below the waterline of the level hull [m], for a
            mesh; None for 0.
        centre_ahead: Place of the mass centre along x of the mesh [m]; None for above the centre of
            buoyancy.
        density: Density of the water [kg/m^3], for a mesh; None for sea water.
        scale: Length of a unit of the mesh [m]; None for 1.
        heels: Heel angles [deg], separated by commas.
        loads: Load conditions of a vessel.
        out: Output folder.
    """

    mass: float | None
    draught: float | None
    centre_depth: float | None
    centre_ahead: float | None
    density: float | None
    scale: float | None
    heels: str
    loads: Sequence[str]
    out: Path


def write_hydrostatics(name: str, options: HydrostaticsOptions) -> int:
    """Print the hydrostatics of a hull and write its righting arms as a table and a plot.

    Args:
        name: A mesh, or a vessel or scenario with the effect `hull_buoyancy`.
        options: Options of the command.

    Returns:
        Exit code.

    Raises:
        BadInput: The hull cannot be read, does not float, or the options do not fit.
    """
    heels = _heels(options.heels)
    if Path(name).suffix.lower() in KINDS:
        hull, density = _hull_of_mesh(Path(name), options)
    else:
        hull, density = _hull_of_vessel(name, options)
    rest = righting_arm(hull, 0.0)
    curve = righting_arms(hull, heels)
    print_lines([escape_for_terminal(name), *_rest_lines(hull, density, rest)])
    rows = []
    for one in curve:
        rows.append(
            [
                f"{degrees(one.heel):.4g}",
                _decimals(one.arm, 5),
                _decimals(degrees(one.trim), 3),
                _decimals(_draught(hull.mesh, one), 5),
            ]
        )
    print_text_table(
        "Righting arm, free to sink and trim",
        ["heel [deg]", "GZ [m]", "trim [deg]", "draught [m]"],
        rows,
        0,
    )
    print_lines(_stability_lines(hull, curve))
    with atomic_folder(options.out) as folder:
        _write_csv(folder / CSV, hull.mesh, curve)
        written = [CSV]
        if len(curve) > 1:
            angles = np.array([degrees(one.heel) for one in curve])
            arms = np.array([one.arm for one in curve])
            labels = ("heel [deg]", "righting arm GZ [m]")
            plot = curve_plot(f"{Path(name).name}: righting arm", labels, angles, arms)
            (folder / SVG).write_text(plot, encoding="utf-8")
            written.insert(0, SVG)
    print_lines([escape_for_terminal(f"written to {options.out}: {', '.join(written)}")])
    return Exit.MET


def _heels(text: str) -> list[float]:
    """Return the heel angles [rad] of the option `--heel`."""
    try:
        found = [radians(float(word)) for word in text.split(",")]
    except ValueError:
        raise BadInput(f"--heel = {text}; allowed are angles in degrees: 0,10,20") from None
    if not all(abs(heel) <= np.pi + 1e-9 for heel in found):
        raise BadInput(f"--heel = {text}; allowed are -180 to 180 degrees")
    if any(b <= a for a, b in zip(found[:-1], found[1:], strict=True)):
        raise BadInput(f"--heel = {text}; the angles must increase")
    return found


def _hull_of_mesh(path: Path, options: HydrostaticsOptions) -> tuple[LoadedHull, float]:
    """Return the loaded hull of a mesh file, with its lowest point at z = 0, and the density."""
    if options.loads:
        raise BadInput("--load belongs to a vessel, not to a mesh")
    if (options.mass is None) == (options.draught is None):
        raise BadInput("a mesh needs either --mass or --draught")
    density = options.density or 1025.0
    mesh = read_closed_mesh(path, options.scale or 1.0)
    volume = _volume(mesh, density, 0.0, options)
    depth = depth_of_volume(mesh, volume)
    level = submerged_part(mesh, depth)
    ahead, aside, _ = level.centre
    if options.centre_ahead is not None:
        ahead = options.centre_ahead
    below = (options.centre_depth or 0.0) - depth
    return LoadedHull(mesh, volume, np.array([ahead, aside, below])), density


def _hull_of_vessel(name: str, options: HydrostaticsOptions) -> tuple[LoadedHull, float]:
    """Return the loaded hull of a vessel or scenario, in its axes of motion, and the density."""
    for option, value in (
        ("--centre-depth", options.centre_depth),
        ("--centre-ahead", options.centre_ahead),
        ("--density", options.density),
        ("--scale", options.scale),
    ):
        if value is not None:
            raise BadInput(f"{option} belongs to a mesh; {name} states it")
    if options.mass is not None and options.draught is not None:
        raise BadInput("--mass and --draught exclude each other")
    own = _buoyancy_of(name, _vessel(name, options.loads))
    mesh = own.placed_mesh()
    volume = own.mass / own.density
    if options.mass is not None or options.draught is not None:
        lowest = float(mesh.points[:, 2].max())
        volume = _volume(mesh, own.density, lowest, options)
    return LoadedHull(mesh, volume, np.array([own.ahead, 0.0, own.below])), own.density


def _vessel(name: str, loads: Sequence[str]) -> Vessel:
    """Return the vessel of a name, or that of a scenario."""
    scenarios = all_content_names("scenario")
    is_scenario = name in scenarios or ".toml:" in name
    if name.endswith(".toml") and Path(name).name != "vessel.toml":
        is_scenario = True
    if not is_scenario:
        return load_vessel(name, loads)
    if loads:
        raise BadInput("--load belongs to a vessel; a scenario states its loads")
    return scenario.load(name).vessel


def _buoyancy_of(name: str, vessel: Vessel) -> HullBuoyancy:
    """Return the effect of a vessel that holds the mesh of its hull. Raises BadInput."""
    for effect in vessel.effects:
        if isinstance(effect, HullBuoyancy):
            return effect
    raise BadInput(
        f"{name}: the vessel has no hull_buoyancy, whose mesh is needed; give a mesh with --mass "
        "or --draught"
    )


def _volume(mesh: ClosedMesh, density: float, lowest: float, options: HydrostaticsOptions) -> float:
    """Return the volume [m^3] that a mass or draught given as an option displaces."""
    if options.mass is not None:
        return options.mass / density
    draught = options.draught or 0.0
    if not draught < mesh.height:
        raise BadInput(
            f"--draught = {draught:g} m; allowed is less than the height of the mesh, "
            f"{mesh.height:.6g} m"
        )
    return submerged_part(mesh, draught - lowest).volume


def _draught(mesh: ClosedMesh, at: RightingArm) -> float:
    """Return the depth of the deepest point of a hull below the surface [m]."""
    return float((mesh.points @ at.submerged.rotation[2]).max()) + at.depth


def _decimals(value: float, number: int) -> str:
    """Return a value with a number of decimals, without the sign of a zero."""
    return f"{round(value, number) + 0.0:.{number}f}"


def _rest_lines(hull: LoadedHull, density: float, rest: RightingArm) -> list[str]:
    """Lines on the hull at rest without heel."""
    mesh, part = hull.mesh, rest.submerged
    lowest = float(mesh.points[:, 2].max())
    across, along = metacentric_heights(hull, part)
    buoyancy, flotation = part.body_centre, part.flotation
    trim = _decimals(degrees(rest.trim), 3)
    ahead = [_decimals(float(x), 4) for x in (buoyancy[0], hull.centre[0], flotation[0])]
    return [
        f"{len(mesh.faces)} triangles, length {mesh.length:.4g} m, beam {mesh.beam:.4g} m, height "
        f"{mesh.height:.4g} m, encloses {mesh.volume:.6g} m^3",
        f"displacement {hull.volume * density:.6g} kg, {hull.volume:.6g} m^3 of {density:g} kg/m^3",
        f"draught {_draught(mesh, rest):.5g} m, trim {trim} deg, bow up",
        f"centre of buoyancy {ahead[0]} m ahead, {lowest - buoyancy[2]:.4f} m above the "
        "lowest point",
        f"mass centre {ahead[1]} m ahead, {lowest - hull.centre[2]:.4f} m above the lowest point",
        f"waterplane {part.area:.6g} m^2, centre of flotation {ahead[2]} m ahead",
        f"GM {across:.4f} m transverse, {along:.4f} m longitudinal",
    ]


def _stability_lines(hull: LoadedHull, curve: Sequence[RightingArm]) -> list[str]:
    """Lines on the largest righting arm and the angle of vanishing stability."""
    largest = max(curve, key=lambda one: one.arm)
    lines = [f"largest GZ {largest.arm:.4f} m at {degrees(largest.heel):.4g} deg"]
    vanishing = vanishing_angle(hull, curve)
    if vanishing is not None:
        lines.append(f"angle of vanishing stability {degrees(vanishing):.1f} deg")
    else:
        lines.append(
            f"no angle of vanishing stability from {degrees(curve[0].heel):.4g} to "
            f"{degrees(curve[-1].heel):.4g} deg"
        )
    return lines


def _write_csv(path: Path, mesh: ClosedMesh, curve: Sequence[RightingArm]) -> None:
    """Write a row for each heel."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(
            [
                "heel_rad",
                "righting_arm_m",
                "trim_rad",
                "draught_m",
                "waterplane_m2",
                "buoyancy_x_m",
                "buoyancy_y_m",
                "buoyancy_z_m",
            ]
        )
        for one in curve:
            values = [one.heel, one.arm, one.trim, _draught(mesh, one), one.submerged.area]
            row = [f"{value:.9g}" for value in (*values, *one.submerged.body_centre.tolist())]
            writer.writerow(row)
