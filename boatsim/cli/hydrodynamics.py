"""Implementation of `boatsim hydrodynamics`: coefficients of a hull over frequency and heading."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.cli.exits import print_lines, print_notes
from boatsim.cli.progress import report_stages
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.hydrodynamics import computation
from boatsim.hydrodynamics.axes import ASYMMETRY, asymmetry, with_memory
from boatsim.hydrodynamics.mss import read_mss
from boatsim.hydrodynamics.nemoh import RADIATION, read_nemoh
from boatsim.hydrodynamics.rao_csv import read_rao_csv
from boatsim.hydrodynamics.rao_table import Complex, Kind, RaoTable, at_origin, opposite_axes
from boatsim.hydrodynamics.response import Ballast
from boatsim.hydrodynamics.veres import SUFFIXES, read_veres
from boatsim.hydrodynamics.wamit import OutputScale, read_wamit, read_wamit_operators
from boatsim.physics.coefficients.files import UNUSED, write_coefficients, write_wave_loads
from boatsim.physics.coefficients.table import Coefficients, WaveLoads
from boatsim.physics.signals import AXES, ROTATIONS, Array
from boatsim.physics.vessel import load_vessel
from boatsim.physics.waves.dispersion import wave_number
from boatsim.simulate.motion_loads import loads_of_motion

FOLDER = "hydrodynamics"  # default name of the folder of coefficients
OPERATORS = (".2", ".3", ".4", ".re1", ".re8", ".mat", ".csv")  # of response amplitude operators
STUDIED = 3  # frequencies of the comparison of meshes
FINEST = 1600  # panels up to which a mesh is compared with one of four times as many


@dataclass(frozen=True)
class HydrodynamicsOptions:
    """Options of the command.

    Attributes:
        draught: Draught [m]; None for a table of response amplitude operators.
        density: Density of the water [kg/m^3].
        depth: Depth of the water [m]; 0 for deep water.
        origin: Place of the origin of motion in the mesh, along x [m].
        scale: Length of a unit of the mesh, or of WAMIT's output [m].
        panel: Longest edge of a panel [m]; None for a sixteenth of the length.
        frequencies: Number of frequencies.
        headings: Number of headings from 0 to pi.
        lowest: Lowest frequency [rad/s]; None for waves of 20 lengths.
        highest: Highest frequency [rad/s]; None for waves of half the length.
        centre_depth: Depth of the mass centre below the waterline [m], negative above it.
        roll_gyradius: Radius of gyration in roll [m]; None for 0.35 of the beam.
        pitch_gyradius: Radius of gyration in pitch and yaw [m]; None for a quarter of the length.
        roll_damping: Damping of roll added to that of the waves, as a share of the critical one.
        compare: Whether the mesh is compared with one of half the panel size.
        out: Folder to write; None for `hydrodynamics` next to the hull.
        vessel: Vessel that moves as a table of motions states; None for another file.
        loads: Its load conditions.
        speed: Forward speed of the excitation of a mesh, or of a table of response amplitude
            operators [m/s].
    """

    draught: float | None
    density: float
    depth: float
    origin: float
    scale: float
    panel: float | None
    frequencies: int
    headings: int
    lowest: float | None
    highest: float | None
    centre_depth: float
    roll_gyradius: float | None
    pitch_gyradius: float | None
    roll_damping: float
    compare: bool
    out: Path | None
    vessel: str | None = None
    loads: Sequence[str] = ()
    speed: float = 0.0


def write_hydrodynamics(hull: Path, options: HydrodynamicsOptions) -> int:
    """Compute or convert the coefficients of a hull, write them to a folder and print a summary.

    Args:
        hull: A mesh, WAMIT's NAME.1, Nemoh's folder or RadiationCoefficients.tec, or a table of
            response amplitude operators.
        options: Options of the command.

    Returns:
        Exit code.

    Raises:
        BadInput: The hull cannot be read, or Capytaine is not installed.
    """
    out = options.out or hull.parent / FOLDER
    if hull.suffix.lower() in OPERATORS:
        return _write_operators(hull, options, out)
    if options.vessel is not None or options.loads:
        raise BadInput(
            f"{hull}: --vessel and --load apply to tables of response amplitude operators "
            f"({', '.join(OPERATORS)})"
        )
    notes: list[str] = []
    if hull.suffix.lower() in computation.MESHES:
        found, notes = _from_mesh(hull, options)
    elif options.speed != 0.0:
        raise BadInput(
            f"{hull}: --speed applies to meshes ({', '.join(computation.MESHES)}) and to tables of "
            f"response amplitude operators ({', '.join(OPERATORS)})"
        )
    else:
        found = with_memory(_from_output(hull, options))
    renamed = write_coefficients(out, found)
    print_lines(_summary(found))
    print_lines(notes)
    print_notes(_renaming(out, renamed))
    share = asymmetry(found.added_mass)
    if share > ASYMMETRY:
        print_notes(
            [
                f"the hull is not symmetric to port and starboard (coupling {share:.2f}); the "
                "effects use a symmetric one"
            ]
        )
    print_lines([escape_for_terminal(f"written to {out}")])
    return 0


def _write_operators(path: Path, options: HydrodynamicsOptions, out: Path) -> int:
    """Convert a table of response amplitude operators, write the loads and print a summary."""
    table = at_origin(_read_operators(path, options))
    notes = []
    opposite = opposite_axes(table)
    if opposite:
        notes.append(
            f"{path.name}: {', '.join(opposite)} of the longest waves, "
            f"{table.frequency[0]:.3g} rad/s, oppose the motion of the surface; check axes, phase "
            "and direction of the table"
        )
    loads = np.nan_to_num(table.values)
    words = f"{table.kind}s of {table.source}"
    axes = table.axes
    if table.kind == "motion":
        if options.vessel is None:
            raise BadInput(f"{path}: a table of motions needs --vessel, the vessel that moves so")
        vessel = load_vessel(options.vessel, options.loads)
        number = np.asarray(wave_number(table.frequency, table.depth))
        loads, axes = loads_of_motion(
            vessel, table.frequency, table.heading, table.values, number, table.speed
        )
        words += f" for {vessel.name}"
        unused = [axis for axis in table.axes if axis not in axes]
        if unused:
            notes.append(f"{vessel.name} is not free in {', '.join(unused)}; not used")
    elif options.vessel is not None or options.loads:
        raise BadInput(f"{path}: --vessel and --load apply to tables of motions; these are loads")
    if table.speed > 0.0:
        words += f" at {table.speed:g} m/s"
    # loads of motions belong to the vessel, whose equations contain the effects of speed
    speed = table.speed if table.kind == "load" else 0.0
    converted = WaveLoads(
        source=words,
        depth=table.depth,
        frequency=table.frequency,
        heading=table.heading,
        excitation=np.asarray(loads),
        drift=table.drift,
        speed=speed,
    )
    renamed = write_wave_loads(out, converted)
    notes += _renaming(out, renamed)
    kinds = f"loads in {', '.join(axes)}"
    if table.drift is not None:
        kinds += ", and mean drift"
    print_lines(
        [
            escape_for_terminal(words),
            f"{len(table.frequency)} frequencies from {table.frequency[0]:.3g} to "
            f"{table.frequency[-1]:.3g} rad/s, {len(table.heading)} headings",
            kinds,
            *_largest_loads(loads, table, axes),
        ]
    )
    print_notes(notes)
    print_lines([escape_for_terminal(f"written to {out}")])
    return 0


def _renaming(folder: Path, names: Sequence[str]) -> list[str]:
    """Notes on files that were renamed because the hydrodynamics written now have none."""
    notes = []
    for name in names:
        notes.append(
            f"{folder / name} is not part of this conversion; renamed to {name}{UNUSED}, and no "
            "longer used"
        )
    return notes


def _read_operators(path: Path, options: HydrodynamicsOptions) -> RaoTable:
    """Read a table of response amplitude operators by the suffix of its file."""
    suffix = path.suffix.lower()
    if suffix in SUFFIXES:
        return read_veres(path, options.depth, options.speed)
    if suffix == ".mat":
        kind: Kind = "load" if options.vessel is None else "motion"
        return read_mss(path, options.depth, options.speed, kind)
    if suffix == ".csv":
        found = read_rao_csv(path, options.depth)
    else:
        scale = OutputScale(options.scale, options.density, options.depth, 0.0)
        found = read_wamit_operators(path, scale, options.origin)
    if options.speed != found.speed and options.speed != 0.0:
        raise BadInput(
            f"{path}: --speed = {options.speed:g} m/s; the table has {found.speed:g} m/s"
        )
    return found


def _largest_loads(loads: Complex, table: RaoTable, axes: Sequence[str]) -> list[str]:
    """Lines on the largest load of each axis."""
    lines = []
    for axis in axes:
        sizes = np.abs(loads[:, :, AXES.index(axis)])
        k, h = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
        unit = "N" if axis in ROTATIONS else "N/m"
        lines.append(
            f"  {axis} at most {sizes[k, h]:.4g} {unit}, at {table.frequency[k]:.3g} rad/s and "
            f"{np.degrees(table.heading[h]):.0f} deg"
        )
    return lines


def _draught(path: Path, options: HydrodynamicsOptions) -> float:
    if options.draught is None:
        raise BadInput(f"{path}: --draught is required for a mesh and for coefficients")
    return options.draught


def _from_output(path: Path, options: HydrodynamicsOptions) -> Coefficients:
    draught = _draught(path, options)
    scale = OutputScale(options.scale, options.density, options.depth, draught)
    if path.suffix == ".1":
        return read_wamit(path, scale)
    if path.is_dir() or path.name == RADIATION:
        return read_nemoh(path, scale)
    kinds = ", ".join(computation.MESHES)
    raise BadInput(
        f"{path}: allowed are a mesh ({kinds}), WAMIT's NAME.1, Nemoh's {RADIATION} or its "
        f"folder, and tables of response amplitude operators ({', '.join(OPERATORS)})"
    )


def _from_mesh(path: Path, options: HydrodynamicsOptions) -> tuple[Coefficients, list[str]]:
    hull = computation.HullMesh(
        path,
        _draught(path, options),
        options.origin,
        options.scale,
        options.density,
        options.depth,
    )
    length, beam = computation.mesh_size(hull)
    roll, pitch, yaw = computation.default_gyradii(length, beam)
    ballast = Ballast(
        options.centre_depth,
        (
            options.roll_gyradius or roll,
            options.pitch_gyradius or pitch,
            options.pitch_gyradius or yaw,
        ),
        options.roll_damping,
    )
    panel = options.panel
    if panel is None:
        panel = computation.default_panel(length)
    hull = computation.HullMesh(**{**vars(hull), "panel": panel})
    low, high = computation.default_frequencies(length, options.depth, 2)
    low = options.lowest or low
    high = options.highest or high
    if not 0.0 < low < high:
        raise BadInput(f"--lowest = {low:g} rad/s; allowed is below --highest = {high:g} rad/s")
    frequencies = [float(w) for w in np.linspace(low, high, options.frequencies)]
    headings = [float(angle) for angle in np.linspace(0.0, np.pi, options.headings)]
    with report_stages() as report:

        def report_frequency(stage: str, share: float) -> None:
            report("Capytaine", share, stage)

        found = computation.compute_coefficients(
            hull, frequencies, headings, ballast, report_frequency, options.speed
        )
        lines = _unresolved(panel, frequencies[-1], options.speed)
        panels = int(found.source.split(" panels")[0].split()[-1])
        if not options.compare or panels > FINEST:
            return found, lines
        some = frequencies[:: max(1, (len(frequencies) - 1) // (STUDIED - 1))][:STUDIED]
        study = computation.study_mesh(hull, some, ballast, report_frequency, options.speed)
    lines.append(
        f"convergence: {study.panels[1]} panels instead of {study.panels[0]} change, relative to "
        "the largest value of the axis,"
    )
    for name, (change, axis) in study.change.items():
        lines.append(f"  {name} by at most {100.0 * change:.1f} % ({axis})")
    return found, lines


def _unresolved(panel: float, highest: float, speed: float) -> list[str]:
    """Line on waves whose scattered waves at a speed are too short for the panels, or none."""
    if speed == 0.0 or panel == 0.0:
        return []
    limit = computation.highest_resolved(panel, speed)
    if limit >= highest:
        return []
    return [
        f"above {limit:.3g} rad/s the panels of {panel:.3g} m are too long for the waves that the "
        f"hull scatters ahead at {speed:g} m/s; give a shorter --panel or a lower --highest"
    ]


def _largest_drift(found: Coefficients, drift: Array) -> str:
    """Words on the largest mean drift of surge, sway and yaw."""
    texts = []
    for i, (axis, unit) in enumerate((("surge", "N/m^2"), ("sway", "N/m^2"), ("yaw", "N/m"))):
        k, h = np.unravel_index(int(np.argmax(np.abs(drift[:, :, i]))), drift.shape[:2])
        texts.append(f"{axis} {drift[k, h, i]:.4g} {unit} at {found.frequency[k]:.3g} rad/s")
    return f"largest per square of the amplitude: {', '.join(texts)}"


def _summary(found: Coefficients) -> list[str]:
    """Lines on the coefficients: size, frequencies, and the fit of the memory."""
    lines = [
        escape_for_terminal(found.source),
        f"{len(found.frequency)} frequencies from {found.frequency[0]:.3g} to "
        f"{found.frequency[-1]:.3g} rad/s, {len(found.heading)} headings",
    ]
    if found.speed > 0.0:
        lines.append(
            f"excitation at a forward speed of {found.speed:g} m/s; all other coefficients at rest"
        )
    if found.volume > 0.0:
        lines.append(
            f"displaces {found.volume:.6g} m^3, {found.volume * found.density:.6g} kg; centre of "
            f"buoyancy {found.buoyancy[0]:.4g} m ahead and {found.buoyancy[2]:.4g} m below"
        )
    diagonal = np.diag(found.infinite_added_mass)
    values = [f"{axis} {value:.4g}" for axis, value in zip(AXES, diagonal, strict=True)]
    lines.append(f"added mass at infinite frequency [kg, kg m^2]: {', '.join(values)}")
    if found.memory is not None:
        for axes, sections, error in zip(
            ("surge, heave, pitch", "sway, roll, yaw"),
            found.memory.sections,
            found.memory.error,
            strict=True,
        ):
            lines.append(
                f"memory in {axes}: order {2 * len(sections)} for each axis, error "
                f"{100.0 * error:.2g} % rms"
            )
    if found.drift is not None:
        lines += [
            f"mean drift: {escape_for_terminal(found.drift_of)}",
            f"  {_largest_drift(found, found.drift)}",
        ]
    if found.drift_pairs is not None:
        pairs = found.drift_pairs
        lines.append(
            f"slow drift of pairs of waves: {len(pairs.frequency)} frequencies from "
            f"{pairs.frequency[0]:.3g} to {pairs.frequency[-1]:.3g} rad/s, "
            f"{len(pairs.heading)} headings"
        )
    return lines
