"""`python -m validation.waves`: hulls against published numbers, and vessels in waves.

Hulls by the boundary element method need Capytaine, and the recorded section its recordings;
without them they are skipped.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from validation.waves import (
    cylinder,
    drift,
    dtmb5415,
    hemisphere,
    kcs,
    kcs_tables,
    response,
    righting_arms,
    s175,
    section,
    ship_speed,
    wamit_ships,
    wigley,
    wigley_pitch,
    wigley_speed,
)
from validation.waves.speed_diffraction import MovingHull

WORK = Path("out/validation/waves")
STRONG = 0.3  # reflection above which the error of the drift is counted; below the drift is small


def print_hemisphere(folder: Path) -> None:
    """Print the coefficients of a hemisphere next to those of Hulme."""
    print("\nHemisphere, deep water, against A. Hulme, J. Fluid Mech. 121, 1982, tables 1 and 2")
    print(" k a   axis    A / rho V  Hulme   error    B / rho V w  Hulme   error")
    for row in hemisphere.comparison(folder):
        a, b = row.added_mass, row.damping
        print(
            f"{row.number:4.1f}  {row.axis:6}  {a[0]:9.4f}  {a[1]:.4f}"
            f"  {100 * (a[0] / a[1] - 1):4.1f} %    {b[0]:10.4f}  {b[1]:.4f}"
            f"  {100 * (b[0] - b[1]) / row.largest:4.1f} %"
        )


def print_cylinder(folder: Path) -> None:
    """Print the coefficients of a truncated cylinder next to exact ones, and their convergence."""
    print(
        f"\nTruncated cylinder, draught {cylinder.DRAUGHT / cylinder.RADIUS:g} radii, against "
        "expansions in eigenfunctions (C. J. R."
    )
    print(
        "Garrett, J. Fluid Mech. 46, 1971; R. W. Yeung, Applied Ocean Research 3(3), 1981); error:"
    )
    print("difference over the largest value of the axis at this depth, excitation with its phase")
    print(
        "h / a  k a  axis   A / rho V   exact  error  B / rho V w   exact  error      |X|   exact"
    )
    for depth in cylinder.DEPTHS:
        for row in cylinder.compared(folder, depth):
            a, b, x = row.added_mass, row.damping, row.excitation
            print(
                f"{depth / cylinder.RADIUS:5.1f}  {row.number:3.1f}  {row.axis:5}"
                f"  {a.found:10.4f}  {a.exact:.4f}  {100 * a.error:3.1f} %"
                f"  {b.found:11.4f}  {b.exact:.4f} {100 * b.error:4.1f} %"
                f"  {x.found:7.4f}  {x.exact:.4f}  {100 * x.error:4.1f} %"
            )
    print("largest error over all k a, by the number of panels")
    counts = "".join(f"{cylinder.panel_count(panels):7d}" for panels in cylinder.PANELS)
    print(f"h / a  axis   added mass{counts}    damping{counts}    excitation{counts}")
    for depth in cylinder.DEPTHS:
        for line in cylinder.mesh_convergence(folder, depth):
            blocks = []
            for errors in (line.added_mass, line.damping, line.excitation):
                blocks.append("".join(f"{100 * error:5.1f} %" for error in errors))
            print(
                f"{depth / cylinder.RADIUS:5.1f}  {line.axis:5}            {blocks[0]}"
                f"           {blocks[1]}              {blocks[2]}"
            )


def print_wigley(folder: Path) -> None:
    """Print measured and computed responses of two Wigley hulls in head waves."""
    print(
        "\nWigley hulls in head waves at zero speed, held in surge, against model tests (J. M. J."
    )
    print(
        "Journee, Delft University of Technology, report 909, 1992, tables 10-III and 10-IV): heave"
    )
    print(
        "over the amplitude of the wave, pitch over 2 pi / L times it; panels: boundary elements,"
    )
    print("strips: excitation of strip_wave_loads from the mesh")
    print("hull  wave / L  heave  panels          strips          pitch  panels          strips")
    for hull in wigley.HULLS:
        rows = wigley.responses(folder, hull)
        for row in rows:
            cells = []
            for place in range(2):
                measured = row.measured[place]
                cells.append(f"{measured:5.2f}")
                for found in (row.panels[place], row.strips[place]):
                    cells.append(f"{found:6.3f} {100 * (found / measured - 1):+5.0f} %")
            print(f"{row.hull:4}  {row.ratio:8.3f}  {'  '.join(cells)}")
        for method in ("panels", "strips"):
            errors = wigley.long_wave_errors(rows, method)
            for place, axis in enumerate(("heave", "pitch")):
                print(
                    f"{hull.name}, waves of {wigley.LONG:g} L and more, {axis} by {method}: "
                    f"{errors.within[place]} of {errors.rows} within 10 %, largest error "
                    f"{100 * errors.largest[place]:.0f} %, mean {100 * errors.mean[place]:+.0f} %"
                )


def print_wigley_pitch(folder: Path) -> None:
    """Print what could change the computed pitch of the Wigley hulls."""
    print("\nPitch of the Wigley hulls over the slope of the wave; fine: finer mesh; surging:")
    print(
        f"free in surge; higher: mass centre {wigley_pitch.HIGHER:g} m higher; gyradius: "
        f"{100 * (wigley_pitch.LARGER - 1):.0f} % larger; wave:"
    )
    print("moment of the undisturbed wave over the stiffness, integrated over the lines; missing:")
    print("further moment of inertia, over the computed added one, that gives the measured pitch")
    print("hull  wave / L  measured  panels   fine  surging  higher  gyradius   wave  missing")
    every = []
    for hull in wigley.HULLS:
        rows = wigley_pitch.pitch_study(folder, hull)
        every += rows
        for row in rows:
            measured, missing = "-", "-"
            if not np.isnan(row.measured):
                measured, missing = f"{row.measured:.3f}", f"{row.inertia:.2f}"
            cells = (f"{row.panels:6.3f}", f"{row.fine:5.3f}", f"{row.surging:7.3f}")
            cells += (f"{row.higher:6.3f}", f"{row.gyradius:8.3f}", f"{row.undisturbed:5.3f}")
            text = "  ".join(cells)
            print(f"{hull.name:4}  {row.ratio:8.2f}  {measured:>8}  {text}  {missing:>7}")
    counts = []
    for name in ("panels", "fine", "surging", "higher", "gyradius"):
        counts.append(f"{name} {wigley_pitch.rows_within(every, name)}")
    known = sum(not np.isnan(row.measured) for row in every)
    print(f"within 10 % of the measured pitch, of {known} waves: {', '.join(counts)}")


def print_wigley_speed(folder: Path) -> None:
    """Print measured and computed heave, damping and loads of a Wigley hull at forward speed."""
    table = wigley_speed.slow_table(folder)
    hull = MovingHull(wigley_speed.write_mesh(folder))
    print(
        "\nWigley hull III in head waves at forward speed, from coefficients at zero speed, against"
    )
    print(
        "model tests (J. M. J. Journee, report 909, 1992, tables 2-III, 6-III and 8-III); none: no"
    )
    print("effect of speed but the frequency of encounter; body axes: equations of motion in body")
    print(
        "axes; forward speed: with the terms of radiation_memory; diffraction: with the moment of"
    )
    print("the diffraction at forward speed too, which loads at rest leave out; encounter: with")
    print("the diffraction at the frequency of encounter too")
    print(
        "  Fn  wave / L  heave   none          body axes     forward speed diffraction   encounter"
    )
    rows = wigley_speed.heave_at_speed(table, hull)
    errors: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        cells = []
        values = dict(zip(wigley_speed.METHODS, row.found, strict=True))
        further = {"diffraction": row.diffraction, "encounter": row.encounter}
        for name, found in (values | further).items():
            errors.setdefault(name, []).append((row.measured, found))
            cells.append(f"{found:.3f} {100 * (found / row.measured - 1):+4.0f} %")
        print(f"{row.froude:4.1f}  {row.ratio:8.3f}  {row.measured:5.2f}  {'  '.join(cells)}")
    words = [f"{name} {100 * wigley_speed.mean_error(own):.1f} %" for name, own in errors.items()]
    print(f"mean error of heave: {', '.join(words)}")
    print("pitch over 2 pi / L times the amplitude, of which no measured value is at hand")
    for row in rows:
        values = dict(zip(wigley_speed.METHODS, row.pitch, strict=True))
        text = ", ".join(f"{name} {found:.3f}" for name, found in values.items())
        print(f"{row.froude:4.1f}  {row.ratio:8.3f}  {text}")
    print("held hull at Fn 0.3, force over C33 a and moment over k C55 a")
    print(
        "wave / L  force  zero speed    encounter     moment  zero speed    diffraction   encounter"
    )
    loads = wigley_speed.wave_loads(table, hull)
    for load in loads:
        cells = []
        for place, pairs in enumerate(
            ((load.zero_speed, load.encounter), (load.zero_speed, load.diffraction, load.encounter))
        ):
            cells.append(f"{' ' * place}{load.measured[place]:.3f}")
            for pair in pairs:
                error = pair[place] / load.measured[place] - 1
                cells.append(f"{pair[place]:.3f} {100 * error:+4.0f} %")
        print(f"{load.ratio:8.2f}  {'  '.join(cells)}")
    for place, kind, names in (
        (0, "force", ("zero_speed", "encounter")),
        (1, "moment", ("zero_speed", "diffraction", "encounter")),
    ):
        words = []
        for name in names:
            both = [(load.measured[place], getattr(load, name)[place]) for load in loads]
            error = 100 * wigley_speed.mean_error(both)
            words.append(f"{name.replace('_', ' ')} {error:.1f} %")
        print(f"mean error of the {kind}: {', '.join(words)}")
    print("forced heave at Fn 0.3, on which strip theory has no effect of speed")
    print("w sqrt(L / g)  A33 / rho V               B33 sqrt(L / g) / rho V")
    for one in wigley_speed.forced_heave(table):
        cells = []
        for measured, found in (one.added_mass, one.damping):
            cells.append(f"{measured:.3f}  {found:.3f} {100 * (found / measured - 1):+4.0f} %")
        print(f"{one.frequency:13.2f}  {'      '.join(cells)}")
    print(
        f"forced pitch, B55 sqrt(L / g) / (rho V L^2) at w sqrt(L / g) = "
        f"{wigley_speed.FORCED_PITCH_AT:g}"
    )
    for froude, measured, found in wigley_speed.pitch_damping(table):
        values = dict(zip(wigley_speed.METHODS, found, strict=True))
        text = ", ".join(
            f"{name} {value:.3f} ({100 * (value / measured - 1):+.0f} %)"
            for name, value in values.items()
        )
        print(f"Fn {froude:.1f}  measured {measured:.3f}, {text}")


def print_ship_speed(mss: Path) -> None:
    """Print coefficients and motions of a ship at forward speed next to those of VERES."""
    ship = ship_speed.read_ship(mss)
    print("\nContainer ship S-175 of the MSS toolbox, strip theory by VERES 4.02 at five speeds:")
    print("largest error of added mass and damping at speed over the largest of the axes [%], from")
    print("those at zero speed with the terms of forward speed and without")
    print("Fn    with: heave, pitch  sway, roll, yaw   without: heave, pitch  sway, roll, yaw")
    for speed, *errors in ship_speed.coefficient_errors(ship):
        froude = speed / np.sqrt(ship_speed.GRAVITY * ship.length)
        first, second, third, fourth = (100.0 * error for error in errors)
        print(f"{froude:.3f} {first:19.2f} {second:16.2f} {third:23.1f} {fourth:16.1f}")
    print(
        "motion in head waves over that of VERES, with its loads at the speed; none: no effect of"
    )
    print(
        "speed but the frequency of encounter; body: equations of motion in body axes; terms: with"
    )
    print("the terms of forward speed; loads: these with its loads at zero speed")
    print(
        "Fn     wave / L  heave  none   body   terms  loads      pitch  none   body   terms  loads"
    )
    rows = ship_speed.motions(ship)
    for row in rows:
        froude = row.speed / np.sqrt(ship_speed.GRAVITY * ship.length)
        text = []
        for place in range(2):
            cells = [f"{pair[place]:.3f}" for pair in row.found]
            text.append(
                f"{row.table[place]:5.3f}  {'  '.join(cells)}  {row.zero_speed_loads[place]:.3f}"
            )
        print(f"{froude:.3f}  {row.ratio:8.2f}  {'      '.join(text)}")
    for place, axis in enumerate(("heave", "pitch")):
        words = []
        for number, method in enumerate(ship_speed.METHODS):
            worst = max(abs(row.found[number][place] - 1.0) for row in rows)
            words.append(f"{method} {100 * worst:.1f} %")
        worst = max(abs(row.zero_speed_loads[place] - 1.0) for row in rows)
        print(
            f"largest difference in {axis}: {', '.join(words)}, loads at zero speed "
            f"{100 * worst:.1f} %"
        )


def print_lofted_ship(mss: Path, work: Path) -> None:
    """Print coefficients, loads and motions of a lofted ship next to those of strip theory.

    Args:
        mss: Folder of the MSS toolbox.
        work: Working folder.
    """
    veres = s175.read_results(mss, work)
    ship = s175.Ship(mss, work, s175.FINE, veres.coefficients)
    theirs, mass = veres.coefficients, float(veres.coefficients.body[2, 2])
    height = float(theirs.stiffness[0, 0, 0, 3, 3]) / (mass * s175.GRAVITY)
    print("\nContainer ship S-175 of the MSS toolbox, lofted through its offsets, by boundary")
    print("elements at zero speed and terms of forward speed, against strip theory (VERES 4.02).")
    print("Tanks and viscous damping in roll are those of VERES")
    panels = ship.coefficients.source.split(", ")[-2]
    print(
        f"{panels}; displaced mass {ship.mass / 1e3:.0f} t, VERES {mass / 1e3:.0f} t; GM "
        f"{ship.height:.3f} m, VERES {height:.3f} m"
    )
    print("at rest, coefficients over those of VERES")
    print("wave / L    A33    B33    A55    B55")
    for row in s175.coefficient_rows(ship, veres):
        shares = [own / other for own, other in zip(row.found, row.published, strict=True)]
        print(f"{row.ratio:8.2f}  {'  '.join(f'{share:5.2f}' for share in shares)}")
    print("loads of head waves, force over C33 a and moment over k C55 a; rest: those at rest;")
    print(
        "moment: with the moment of the diffraction at the speed; encounter: with the diffraction"
    )
    print("at the frequency of encounter too")
    print("  U m/s  wave / L  force   rest  moment  encounter    moment   rest  moment  encounter")
    for load in s175.load_rows(ship, veres):
        cells = []
        for place in range(2):
            rest, moment, met = (pair[place] for pair in load.found)
            cell = f"{load.published[place]:5.3f}  {rest:5.3f}"
            if load.speed > 0.0:
                cell += f"  {moment:6.3f}  {met:9.3f}"
            cells.append(f"{cell:31}")
        print(f"{load.speed:7.2f}  {load.ratio:8.2f}  {'     '.join(cells)}".rstrip())
    rows = s175.motions(ship, veres)
    speeds = sorted({row.speed for row in rows})
    for speed in speeds:
        for heading, words in ((s175.HEAD, "head"), (s175.BEAM, "beam")):
            chosen = [row for row in rows if (row.speed, row.heading) == (speed, heading)]
            print_lofted_motions(chosen, f"{words} waves at {speed:.2f} m/s")
    low, high = s175.RESONANT[s175.HEAVE]
    first, last = s175.RESONANT[s175.ROLL]
    print(
        f"errors near resonance, waves of {low:g} to {high:g} L in heave and pitch and of "
        f"{first:g} to {last:g} L in roll:"
    )
    print("number of waves with errors up to 10 %, mean and largest error")
    print(f"  U m/s  waves  motion  {'  '.join(f'{name:18}' for name in s175.METHODS)}".rstrip())
    for line in lofted_error_lines(rows, speeds):
        print(line)
    coarse = s175.Ship(mss, work, s175.COARSE, veres.coefficients)
    before = s175.motions(coarse, veres, s175.METHODS[:1])
    panels = coarse.coefficients.source.split(", ")[-2]
    changes = []
    for axis, name in s175.NAMES.items():
        changes.append(f"{name} {100 * s175.largest_change(before, rows, axis):.1f} %")
    print(f"largest change of these motions from a mesh of {panels}: {', '.join(changes)}")


def print_lofted_motions(rows: list[s175.Motion], words: str) -> None:
    """Print the motions of a lofted ship in the waves of one direction at one speed.

    Args:
        rows: Published and computed motions.
        words: Direction and speed in words.
    """
    methods = len(s175.METHODS)
    if rows[0].heading == s175.BEAM:
        methods -= 1  # the frequency of encounter is that of the wave
    if rows[0].speed == 0.0:
        methods = 1
    heads = "".join(f"{name:>14}" for name in s175.METHODS[:methods])
    axes = sorted({row.axis for row in rows})
    titles = "   ".join(f"{s175.NAMES[axis]:>6}{heads}" for axis in axes)
    print(f"{words}; motions by VERES, and by boatsim with their errors\nwave / L  {titles}")
    for ratio in sorted({row.ratio for row in rows}, reverse=True):
        cells = []
        for axis in axes:
            cell = " " * (6 + 14 * methods)
            for row in rows:
                if (row.ratio, row.axis) == (ratio, axis):
                    cell = f"{row.published:6.3f}"
                    for found in row.found[:methods]:
                        cell += f"{found:7.3f} {100 * (found / row.published - 1):+4.0f} %"
            cells.append(cell)
        print(f"{ratio:8.2f}  {'   '.join(cells)}".rstrip())


def lofted_error_lines(rows: list[s175.Motion], speeds: list[float]) -> list[str]:
    """Return the errors of the motions of a lofted ship in words, and their sums.

    Args:
        rows: Published and computed motions.
        speeds: Forward speeds [m/s].
    """
    lines = []
    for speed in speeds:
        methods = 1 if speed == 0.0 else len(s175.METHODS)
        within, waves = [0] * methods, 0
        for heading, words, axes in (
            (s175.HEAD, "head", (s175.HEAVE, s175.PITCH)),
            (s175.BEAM, "beam", (s175.HEAVE, s175.ROLL)),
        ):
            for axis in axes:
                cells = []
                for method in range(methods):
                    one = s175.errors(rows, speed, heading, axis, method)
                    within[method] += one.within
                    cells.append(
                        f"{one.within:2d} of {one.waves:2d} {100 * one.mean:2.0f} "
                        f"{100 * one.largest:+3.0f} %"
                    )
                waves += one.waves
                text = "  ".join(f"{cell:18}" for cell in cells)
                lines.append(f"{speed:7.2f}  {words:5}  {s175.NAMES[axis]:6}  {text}".rstrip())
        text = "  ".join(f"{f'{count:2d} of {waves}':18}" for count in within)
        lines.append(f"{speed:7.2f}  all            {text}".rstrip())
    return lines


def print_wamit_ship(mss: Path, work: Path, ship: wamit_ships.Ship) -> None:
    """Print errors of coefficients and motions of a ship against WAMIT with the same panels.

    Args:
        mss: Folder of the MSS toolbox.
        work: Working folder.
        ship: The ship.
    """
    found = wamit_ships.comparison(mss, ship, work)
    print(
        f"\n{ship.name} of the MSS toolbox at rest, against WAMIT with the same panels, each as two"
    )
    print(f"triangles ({found.panels}); errors [%]")
    if found.stiffness:
        words = []
        for name, (theirs, own) in zip(("C33", "C44", "C55"), found.stiffness, strict=True):
            words.append(f"{name} {100 * (own / theirs - 1):+.2f} %")
        print(f"stiffness: {', '.join(words)}")
    periods = "".join(f"{period:8.2f}" for period in wamit_ships.PERIODS)
    print(f"period s{periods}")
    ratios = []
    for period in wamit_ships.PERIODS:
        length = s175.GRAVITY * period**2 / (2.0 * np.pi)
        ratios.append(f"{length / ship.length:8.2f}")
    print(f"wave / L{''.join(ratios)}")
    every = []
    for letter, rows in (("A", found.added_mass), ("B", found.damping)):
        for (_, name), pairs in zip(wamit_ships.DIAGONAL, rows, strict=True):
            text = "".join(f"{100 * pair.error:+8.1f}" for pair in pairs)
            print(f"{letter}{name}     {text}")
            every += pairs
    print("motions over the amplitude or the slope of the wave: WAMIT, boatsim, error")
    titles = "   ".join(f"{words:23}" for _, _, words in wamit_ships.MOTIONS)
    print(f"period s  {titles}".rstrip())
    moved = []
    for place, period in enumerate(wamit_ships.PERIODS):
        cells = []
        for pairs in found.motions:
            one = pairs[place]
            cells.append(f"{one.published:6.3f}  {one.found:6.3f} {100 * one.error:+5.1f} %")
            moved.append(one)
        print(f"{period:8.2f}  {'   '.join(cells)}")
    limit = f"{100 * wamit_ships.CLOSE:.0f} %"
    print(
        f"within {limit}: {wamit_ships.within(every)} of {len(every)} coefficients, "
        f"{wamit_ships.within(moved)} of {len(moved)} motions"
    )


def print_ship_arms(navaltoolbox: Path) -> None:
    """Print righting arms of a ship next to those of another program."""
    hull = dtmb5415.loaded_hull(navaltoolbox)
    print("\nSurface combatant DTMB 5415, righting arms against those of the program GHS (A. K.")
    print("Ariffin, PhD thesis, 2017, figure 3.15), free in trim")
    print("heel deg  GZ m    here   error m   trim deg  here, by the bow")
    rows = dtmb5415.arms(hull)
    for row in rows:
        arm, found = row.arm
        print(
            f"{row.heel:8.0f}  {arm:.3f}  {found + 0.0:.3f}  {found - arm:+8.3f}"
            f"  {row.trim[0]:8.2f}  {row.trim[1]:5.2f}"
        )
    largest = max(row.arm[0] for row in rows)
    for limit in (30.0, 60.0):
        worst = max(abs(row.arm[1] - row.arm[0]) for row in rows if row.heel <= limit)
        print(
            f"largest error up to {limit:.0f} deg: {worst:.3f} m, {100 * worst / largest:.1f} % of "
            "the largest arm"
        )
    volume, height = dtmb5415.upright(hull)
    print(
        f"volume at a draught of {dtmb5415.DRAUGHT:g} m: {volume:.1f} m^3, published "
        f"{dtmb5415.VOLUME:.1f} m^3 ({100 * (volume / dtmb5415.VOLUME - 1):+.1f} %)"
    )
    slope = rows[1].arm[0] / np.sin(np.radians(rows[1].heel))
    print(f"GM {height:.3f} m; slope of the first arm of GHS {slope:.3f} m")


def print_ship_motions(navaltoolbox: Path) -> None:
    """Print coefficients and motions of a ship's model next to published ones."""
    found = dtmb5415.compute(navaltoolbox)
    table = dtmb5415.table_of_model(navaltoolbox, found)
    print(
        "\nIts model DTMB 5512 of 3.048 m at rest, coefficients against a table of another program"
    )
    print("(FRyDoM, DTMB5512.hdb5, February 2019); waves from ahead, about the mass centre")
    print(f"w rad/s  {'  '.join(f'{name:>6}    here' for name in dtmb5415.COLUMNS)}")
    rows = dtmb5415.coefficient_rows(table)
    for row in rows:
        cells = []
        for published, own in zip(row.published, row.found, strict=True):
            cells.append(f"{published:6.1f}  {own:6.1f}")
        print(f"{row.frequency:7.3f}  {'  '.join(cells)}")
    differences = []
    for place, name in enumerate(dtmb5415.COLUMNS):
        published = np.array([row.published[place] for row in rows])
        own = np.array([row.found[place] for row in rows])
        worst = np.abs(own - published).max() / published.max()
        differences.append(f"{name} {100 * worst:.1f} %")
    print(f"largest difference over the largest value: {', '.join(differences)}")
    words = []
    for name, (published, own) in zip(
        ("C33", "C35", "C55"), dtmb5415.stiffness_pairs(table), strict=True
    ):
        words.append(f"{name} {published:.0f} {own:.0f} ({100 * (own / published - 1):+.1f} %)")
    print(f"stiffness: {', '.join(words)}")
    print("\nThe model in head waves against tests (M. Irvine, J. Longo, F. Stern, J. Ship")
    print("Research 52(2), 2008), values read from figures: heave over the amplitude, pitch over")
    print("the slope of the wave; none: no effect of speed but the frequency of encounter; body:")
    print("equations of motion in body axes; terms: with the terms of forward speed; diffr.: with")
    print("the moment of the diffraction at speed too; damp.: as terms, but the damping of pitch")
    print("at zero speed; enc.: as terms, with the diffraction at the frequency of encounter")
    heads = "none   body   terms  diffr. damp.  enc. "
    print(f"  Fn    Hz  wave / L  heave  {heads}    pitch  {heads}".rstrip())
    met = dtmb5415.met_excitation(navaltoolbox)
    motions = dtmb5415.motions(table, met)
    for motion in motions:
        text = []
        for place, measured in enumerate(motion.measured):
            cells = [f"{pair[place]:.3f}" for pair in motion.found]
            text.append(f"{measured:.3f}  {'  '.join(cells)}")
        start = f"{motion.froude:4.2f} {motion.encounter:5.3f}  {motion.ratio:8.2f}"
        print(f"{start}  {'    '.join(text)}")
    quarter = 0.25 * dtmb5415.MODEL_LENGTH
    light = dtmb5415.motions(dtmb5415.table_of_model(navaltoolbox, found, quarter), met)
    print("number of waves with errors up to 10 %, and mean and largest error")
    print(
        "gyradius  method         heave, 1 to 2 L     pitch, 1 to 2 L     heave, from 1 L on  "
        "pitch, from 1 L on"
    )
    for gyradius, own_rows in ((dtmb5415.GYRADIUS, motions), (quarter, light)):
        start = f"{gyradius / dtmb5415.MODEL_LENGTH:6.2f} L"
        for line in ship_error_lines(own_rows):
            print(f"{start}  {line}")


def ship_error_lines(rows: list[dtmb5415.Motion]) -> list[str]:
    """Return the errors of the motions of a ship's model in words, one line for each method.

    Args:
        rows: Measured and computed motions.
    """
    lines = []
    cases = [("at rest", 0, False)]
    cases += [(name, method, True) for method, name in enumerate(dtmb5415.NAMES)]
    for name, method, moving in cases:
        cells = []
        for longest in (dtmb5415.RESONANT, np.inf):
            for place in range(2):
                one = dtmb5415.errors(rows, place, method, longest, moving)
                cells.append(
                    f"{one.within:2d} of {one.waves:2d} {100 * one.mean:3.0f} "
                    f"{100 * one.largest:+4.0f} %"
                )
        lines.append(f"{name:14} {'  '.join(cells)}")
    return lines


def print_righting_arms() -> None:
    """Print righting arms next to closed forms and a printed example."""
    print("\nRighting arms of meshes against closed forms")
    for words, arms in (
        ("ellipsoid, semi-axes 2, 0.8 and 0.4 m, half immersed", righting_arms.arms_of_ellipsoid),
        ("paraboloid of revolution (Archimedes)", righting_arms.arms_of_paraboloid),
    ):
        print(f"{words}\nheel deg      GZ m   exact m")
        rows = arms()
        for arm in rows:
            # + 0.0: rounding leaves no negative zero
            cells = (round(arm.found, 4) + 0.0, round(arm.exact, 4) + 0.0)
            print(f"{arm.heel:8.0f}  {cells[0]:8.4f}  {cells[1]:8.4f}")
        errors = [righting_arms.largest_error(arms(n, n // 2)) for n in (24, 48, 96)]
        text = ", ".join(f"{100 * error:.2f} %" for error in errors)
        print(f"largest error over the largest arm with 24, 48 and 96 meridians: {text}")
    found, exact = righting_arms.archimedes()
    print(
        f"paraboloid floats upright above a relative density of {found:.4f}, by Archimedes "
        f"{exact:.4f}"
    )
    print("box-shaped vessel of C. B. Barrass, D. R. Derrett, Ship Stability for Masters and Mates")
    for heel, (arm, moment), (own, turning) in righting_arms.box_example():
        print(
            f"heel {heel:g} deg: GZ {own:.4f} m, printed {arm:g} m; moment {turning:.1f} t m, "
            f"printed {moment:g} t m"
        )


def print_regular(folder: Path) -> None:
    """Print the errors of the simulated motion in regular waves."""
    rows = response.regular_wave_errors(folder)
    print("\nCatamaran of the Otter's particulars in regular waves, six degrees of freedom, soft")
    print(
        "springs in surge, sway and yaw: simulated response against the frequency domain with the"
    )
    print(
        "same coefficients, difference of the complex amplitudes over the largest of the axis [%]"
    )
    print("period s  heading deg  surge  sway  heave  roll  pitch  yaw")
    for period, heading, *errors in rows:
        text = "  ".join(f"{error:5.2f}" for error in errors)
        print(f"{period:8.2f}  {np.degrees(heading):11.0f}  {text}")
    worst = np.array(rows)[:, 2:].max(axis=0)
    print(f"largest                {'  '.join(f'{error:5.2f}' for error in worst)}")


def print_irregular(folder: Path) -> None:
    """Print the rms responses in an irregular sea."""
    print("\nThe same in a sea of 160 waves, 600 s: rms simulated and by linear theory")
    print("axis        simulated     linear   difference")
    for axis, (found, expected, error) in zip(
        ("heave", "roll", "pitch"), response.irregular_sea_errors(folder), strict=True
    ):
        unit = "m" if axis == "heave" else "rad"
        print(f"{axis:6} {found:12.4g} {expected:10.4g} {unit:4} {error:5.1f} %")


def print_drift(folder: Path) -> None:
    """Print the mean drift of a cylinder and of the ship section next to closed forms."""
    print(
        "\nMean drift of a held circular cylinder in deep water, draught three radii, against the"
    )
    print("series of T. H. Havelock, Proc. R. Soc. A 175, 1940; energy: relative error of its")
    print("conservation in the scattered waves")
    print(" k a   F / rho g a A^2   Havelock    error    energy")
    for one in drift.cylinder_drift(folder):
        error = 100.0 * (one.force / one.exact - 1.0)
        print(
            f"{one.number:4.1f}  {one.force:16.4f}  {one.exact:9.4f}"
            f"  {error:5.1f} %  {100.0 * one.energy:6.1f} %"
        )
    results = drift.section_drift(folder)
    print("\nMean drift of the ship section in deep water and beam waves, per length and square of")
    print(
        "the amplitude [N/m^3], by the far-field method, against H. Maruo, J. Ship Research 4(3),"
    )
    print("1960, with the reflection by the pressure on the hull")
    print("period s  section  reflection   far field       Maruo   error")
    for row in results:
        words = "free" if row.moves else "held"
        print(
            f"{2.0 * np.pi / row.frequency:8.3f}  {words:7}  {row.reflection:10.3f}"
            f"  {row.far_field:10.1f}  {row.maruo:10.1f}  {100.0 * row.error:5.1f} %"
        )
    for words, moves in (("held", False), ("free", True)):
        strong = [row for row in results if row.moves == moves and row.reflection > STRONG]
        worst = max(100.0 * abs(row.error) for row in strong)
        print(
            f"largest error where the {words} section reflects more than {STRONG:g} of the "
            f"amplitude: {worst:.1f} % ({len(strong)} periods)"
        )


def print_section(folder: Path) -> None:
    """Print the errors of the prediction of the recorded ship section."""
    results = section.run_errors(folder)
    print("\nShip section in a flume, free runs from the measured wave, nothing fitted: rms error")
    print("over rms motion; held: the freedom that the rig holds")
    print("run      period s  held   heave   roll")
    held = {"3": "none", "4": "roll", "5": "heave", "6": "sway"}
    for name, period, errors in results:
        cells = "  ".join(
            f"{errors[axis]:5.2f}" if axis in errors else "    -" for axis in section.SIGNALS
        )
        print(f"{name:8} {period:8.3f}  {held[name[0]]:5}  {cells}")
    for words, chosen in (
        (f"periods above {section.LONGEST:g} s", lambda period: period > section.LONGEST),
        (f"periods up to {section.LONGEST:g} s", lambda period: period <= section.LONGEST),
    ):
        cells = []
        for axis in section.SIGNALS:
            values = [e[axis] for _, period, e in results if axis in e and chosen(period)]
            cells.append(f"{axis} {np.median(values):.2f} ({len(values)} runs)")
        print(f"median, {words}: {', '.join(cells)}")
    at_centre, at_waterline = section.roll_periods(folder)
    print(f"natural period of roll, held in sway at the mass centre: {at_centre:.2f} s, at the")
    print(f"waterline: {at_waterline:.2f} s; by the makers' decay tests with sway clamped 1.28 s")


def print_mss_hulls(mss: Path | None, work: Path, has_capytaine: bool) -> None:
    """Print comparisons with the hulls of the MSS toolbox that are there, or why they are skipped.

    Args:
        mss: Folder of the MSS toolbox; None if it is not given.
        work: Working folder.
        has_capytaine: Whether Capytaine is installed.
    """
    if mss is None or not has_capytaine:
        print("hulls of the MSS toolbox: skipped, they need --mss and Capytaine")
        return
    if (mss / s175.SHIP).is_file():
        print_lofted_ship(mss, work)
    else:
        print(f"lofted container ship: skipped, {mss / s175.SHIP} is missing")
    for ship in (wamit_ships.TANKER, wamit_ships.FPSO):
        path = mss / wamit_ships.SHIPS / ship.name / ship.mesh
        if path.is_file():
            print_wamit_ship(mss, work, ship)
        else:
            print(f"{ship.name}: skipped, {path} is missing")


def main() -> None:
    """Print all comparisons."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, default=WORK, help="working folder")
    parser.add_argument("--mss", type=Path, help="folder of the MSS toolbox")
    parser.add_argument("--navaltoolbox", type=Path, help="folder of navaltoolbox-lib")
    parser.add_argument("--kcs", type=Path, help="folder with kcs.fix, offsets of the KCS")
    given = parser.parse_args()
    folder = given.work
    has_capytaine = find_spec("capytaine") is not None and find_spec("trimesh") is not None
    print_righting_arms()
    if has_capytaine:
        print_hemisphere(folder)
        print_cylinder(folder)
        print_drift(folder)
        print_wigley(folder)
        print_wigley_pitch(folder)
        print_wigley_speed(folder)
    else:
        print("hulls by boundary elements: skipped, Capytaine is not installed")
    if given.mss is not None and (given.mss / ship_speed.TABLE).is_file():
        print_ship_speed(given.mss)
    else:
        print("container ship at forward speed: skipped, --mss names the folder of the MSS toolbox")
    print_mss_hulls(given.mss, folder, has_capytaine)
    toolbox = given.navaltoolbox
    if toolbox is not None and (toolbox / dtmb5415.MESH).is_file():
        print_ship_arms(toolbox)
        if has_capytaine:
            print_ship_motions(toolbox)
    else:
        print("surface combatant: skipped, --navaltoolbox names the folder of navaltoolbox-lib")
    if given.kcs is not None and (given.kcs / kcs.OFFSETS).is_file():
        kcs_tables.print_ship(given.kcs, folder, has_capytaine)
    else:
        print("container ship KCS: skipped, --kcs names the folder with its offsets kcs.fix")
    print_regular(folder)
    print_irregular(folder)
    if has_capytaine and section.RUNS.is_dir():
        print_section(folder)
    else:
        print("ship section: skipped, it needs Capytaine and the recordings")


if __name__ == "__main__":
    main()
