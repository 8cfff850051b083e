"""`python -m validation.waves`: vessels in waves against the frequency domain and a recording.

The recorded section needs Capytaine and the recordings; without them it is skipped.
"""

import argparse
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from validation.waves import drift, hemisphere, response, section

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
    for cylinder in drift.cylinder_drift(folder):
        error = 100.0 * (cylinder.force / cylinder.exact - 1.0)
        print(
            f"{cylinder.number:4.1f}  {cylinder.force:16.4f}  {cylinder.exact:9.4f}"
            f"  {error:5.1f} %  {100.0 * cylinder.energy:6.1f} %"
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


def main() -> None:
    """Print all comparisons."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, default=WORK, help="working folder")
    folder = parser.parse_args().work
    has_capytaine = find_spec("capytaine") is not None and find_spec("trimesh") is not None
    if has_capytaine:
        print_hemisphere(folder)
        print_drift(folder)
    else:
        print("hemisphere and drift: skipped, Capytaine is not installed")
    print_regular(folder)
    print_irregular(folder)
    if has_capytaine and section.RUNS.is_dir():
        print_section(folder)
    else:
        print("ship section: skipped, it needs Capytaine and the recordings")


if __name__ == "__main__":
    main()
