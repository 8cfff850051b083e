"""Tables of the motions of the KCS next to model tests, as the command prints them."""

from pathlib import Path

import numpy as np

from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from validation.waves import kcs

ROLL_FREE = ("surge", "sway", "heave", "roll", "pitch")


def print_ship(folder: Path, work: Path, has_capytaine: bool) -> None:
    """Print hydrostatics, convergence, and motions next to measured ones.

    Args:
        folder: Folder with the offsets of the ship.
        work: Working folder.
        has_capytaine: Whether boundary elements can be computed.

    Raises:
        BadInput: The offsets cannot be read, or Capytaine fails.
    """
    stations = kcs.read_offsets(folder / kcs.OFFSETS)
    hulls = [kcs.lofted(stations, panels) for panels in kcs.RESOLUTIONS]
    print("\nContainer ship KCS from its offsets, full scale, draught 10.8 m, against published")
    print("hydrostatics (SIMMAN 2008, workshop Tokyo 2015), by the number of triangles of the mesh")
    print(f"             published{''.join(f'{len(hull.mesh):10d}' for hull in hulls)}")
    columns = [kcs.particulars(hull) for hull in hulls]
    for row in zip(*columns, strict=True):
        first = row[0]
        digits = 0 if first.published > 1000.0 else 3
        cells = [f"{one.found:10.{digits}f}" for one in row]
        label = f"{first.name} {first.unit}"
        print(f"{label:12} {first.published:9.{digits}f}{''.join(cells)}")
    if not has_capytaine:
        print("its motions: skipped, Capytaine is not installed")
        return
    waves = kcs.head_waves() + kcs.oblique_waves()
    found = [kcs.compute(work, hull, waves) for hull in hulls]
    print_convergence(hulls, found)
    met = kcs.met_excitation(work, hulls[-1])
    print_motions(kcs.Computed(hulls[-1], found[-1], met))


def print_convergence(hulls: list[kcs.Hull], found: list[Coefficients]) -> None:
    """Print added mass and damping of meshes of increasing fineness.

    Args:
        hulls: The hull with each mesh.
        found: Coefficients of each mesh.
    """
    print("added mass over the mass and damping sqrt(L / g) over it, about the mass centre, in")
    print("pitch over L^2 and in roll over B^2 too")
    print(f"w sqrt(L / g)  triangles  {'  '.join(f'{name:>7}' for name in kcs.COEFFICIENTS)}")
    for wave in (kcs.head_waves()[2], kcs.oblique_waves()[2]):
        for hull, own in zip(hulls, found, strict=True):
            moving = kcs.hull_at_speed(hull, own, kcs.usual_loading())
            values = kcs.coefficients_without_units(moving, wave.encounter)
            number = wave.encounter * np.sqrt(kcs.LENGTH / GRAVITY)
            cells = "  ".join(f"{value:7.4f}" for value in values)
            print(f"{number:13.2f}  {len(hull.mesh):9d}  {cells}")


def print_motions(ship: kcs.Computed) -> None:
    """Print motions next to measured ones, and what assumptions change.

    Args:
        ship: The ship.
    """
    rows = ship.motions(kcs.usual_loading())
    print("\nKCS in regular waves at Fn 0.26 against model tests (workshop Tokyo 2015, cases")
    print("2.10 and 2.11): heave over the amplitude, roll and pitch over the slope of the wave.")
    print("Assumed: radii of gyration 0.25 L in pitch and 0.40 B in roll (SIMMAN; the workshop")
    print("states none), mass centre above the centre of buoyancy, GM 0.6 m, free in heave and")
    print("pitch (2.10) or in surge, heave, roll and pitch (2.11), no damping of roll but by")
    print("radiated waves, position as at rest. none: no effect of speed but the frequency of")
    print("encounter; body: equations of motion in body axes; terms: with the terms of forward")
    print(
        "speed; diffr.: with the moment of the diffraction at speed too; met: as diffr., with the"
    )
    print("diffraction at the frequency of encounter")
    print(
        "case  angle  wave / L  axis   meas.  none          body          terms         "
        "diffr.        met"
    )
    for row in rows:
        cells = []
        for value in row.found:
            cells.append(f"{value:5.3f} {100 * (value / row.measured - 1):+5.0f} %")
        start = f"{row.case}  {row.angle:5.0f}  {row.ratio:8.2f}  {row.axis:5}"
        print(f"{start}  {row.measured:5.3f}  {'  '.join(cells)}")
    print("phase before the crest at the forward perpendicular [deg], heave up and pitch bow up")
    print("wave / L  axis   measured  none  body  terms  diffr.   met")
    for row in rows:
        if not np.isnan(row.measured_phase):
            none, body, terms, last, met = row.phase
            print(
                f"{row.ratio:8.2f}  {row.axis:5}  {row.measured_phase:8.0f}  {none:4.0f}"
                f"  {body:4.0f}  {terms:5.0f}  {last:6.0f}  {met:4.0f}"
            )
    print_errors(rows)
    print_gyradius(ship, rows)
    print_roll(ship, rows)


def print_errors(rows: list[kcs.Motion]) -> None:
    """Print how many motions are near the measured ones.

    Args:
        rows: Motions.
    """
    print("number of waves of 1 to 2 lengths with errors up to 10 %, mean and largest error")
    print(
        "case  axis   none              body              terms             diffr.            met"
    )
    for case, axes in (("2.10", ("heave", "pitch")), ("2.11", ("heave", "roll", "pitch"))):
        for axis in axes:
            own = kcs.chosen(rows, case, axis)
            cells = []
            for method in range(len(kcs.NAMES)):
                within, mean, largest = kcs.errors(own, method)
                cells.append(f"{within} of {len(own)} {100 * mean:4.0f} {100 * largest:+5.0f} %")
            print(f"{case}  {axis:5}  {' '.join(cells)}")


def print_gyradius(ship: kcs.Computed, rows: list[kcs.Motion]) -> None:
    """Print how the assumed radius of gyration in pitch changes the motions in head waves.

    Args:
        ship: The ship.
        rows: Motions with the usual radius.
    """
    print("change of heave and pitch (terms) in head waves by the radius of gyration in pitch [%]")
    print("wave / L  axis   0.24 L  0.26 L")
    usual, changed = kcs.usual_loading(), []
    for step in (-kcs.GYRADIUS_STEP, kcs.GYRADIUS_STEP):
        roll, pitch, yaw = usual.gyradii
        loading = usual._replace(gyradii=(roll, pitch + step, yaw + step))
        changed.append(ship.motions(loading))
    terms = kcs.NAMES.index("forward speed")
    for row, *others in zip(rows, *changed, strict=True):
        if row.case == "2.10":
            cells = [100 * (one.found[terms] / row.found[terms] - 1) for one in others]
            print(f"{row.ratio:8.2f}  {row.axis:5}  {cells[0]:+6.1f}  {cells[1]:+6.1f}")
    for words, own in (("0.24 L", changed[0]), ("0.25 L", rows), ("0.26 L", changed[1])):
        counts = []
        for axis in ("heave", "pitch"):
            near = kcs.chosen(own, "2.10", axis)
            counts.append(f"{axis} {kcs.errors(near, terms)[0]} of {len(near)}")
        print(f"{words}: within 10 % in waves of 1 to 2 L, {', '.join(counts)}")


def print_roll(ship: kcs.Computed, rows: list[kcs.Motion]) -> None:
    """Print how assumptions of the restraint and of viscous damping change the roll.

    Args:
        ship: The ship.
        rows: Motions with sway held and without viscous damping.
    """
    print(f"roll by assumption; damped: {100 * kcs.ROLL_STEP:.0f} % of the critical damping more;")
    print("narrow: radius of gyration 0.36 B; sway: free in sway too")
    print("angle  measured  held   damped  narrow  sway")
    usual = kcs.usual_loading()
    narrow = (0.9 * usual.gyradii[0], *usual.gyradii[1:])
    cases = [rows]
    for loading in (usual._replace(roll_damping=kcs.ROLL_STEP), usual._replace(gyradii=narrow)):
        cases.append(ship.motions(loading))
    cases.append(ship.motions(usual, ROLL_FREE))
    last = kcs.NAMES.index("diffraction")
    for row, *others in zip(*cases, strict=True):
        if row.axis == "roll":
            held, damped, thin, sway = (one.found[last] for one in (row, *others))
            print(
                f"{row.angle:5.0f}  {row.measured:8.2f}  {held:4.2f}  {damped:6.2f}"
                f"  {thin:6.2f}  {sway:4.2f}"
            )
