"""`python -m validation.waves.peers [--mss FOLDER]`: the same sea in boatsim and other programs.

MCSimPython is a package of PyPI (`boatsim[peers]`). MSS is a copy of its repository, and runs in
GNU Octave. Their tables are read where they are; a program that is not there is skipped.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.files import toml_value
from boatsim.hydrodynamics.mss import read_mss
from boatsim.physics.base import AXES, Array
from boatsim.physics.coefficients.table import WaveLoads
from boatsim.physics.effects.panel_wave_loads import PanelWaveLoads
from boatsim.physics.waves import spectra
from boatsim.physics.waves.field import WaveField
from validation.waves.peers import mcsimpython, mss
from validation.waves.peers.comparison import (
    loads_at,
    regular_sea,
    relative_difference,
    sea_of_table,
    spectrum_difference,
    times_of_period,
    waves_of,
)
from validation.waves.peers.followed_motion import motions_at

WORK = Path("out/validation/waves/peers")
# Directions of the waves relative to the hull [deg]: those of a table, and others
IN_TABLE, BETWEEN = (0.0, 40.0, 90.0, 140.0, 180.0), (5.0, 47.0, 95.0, 133.0)
OMITTED = (10.0, 50.0, 90.0, 130.0, 170.0)  # of a table without every second heading
PLACE = (1.3, -0.7)  # [m] of the drillship
# Height [m] and modal period [s] of the seas, for waves of some lengths of the hull
DRILLSHIP = {"spectrum": "jonswap", "significant_height": 0.06, "modal_period": 2.2}
SEAS = {
    "supply vessel": {"spectrum": "jonswap", "significant_height": 4.0, "modal_period": 9.0},
    "tanker": {"spectrum": "jonswap", "significant_height": 5.0, "modal_period": 12.0},
}
GAMMA = 3.3
FINER = 8  # intervals into which a spline divides those between the frequencies of a table
FREE_RUN, FREE_STEP = 30.0, 0.004  # [s]
FREE_HEIGHTS = (0.02, 0.002)  # [m]


def percent(values: Sequence[float] | Array) -> str:
    """Return differences in per cent, one for each column of a table."""
    return "".join(f"{100.0 * value:8.2f}" for value in values)


def head(words: str) -> str:
    """Return the line above differences of six axes."""
    return f"{words:56}" + "".join(f"{axis:>8}" for axis in AXES)


def print_spectra(name: str, theirs: dict[str, Array], frequency: Array, sea: mss.Spectrum) -> None:
    """Print the differences of the spectra of a program."""
    modal = 2.0 * np.pi / sea.period
    own = {
        "bretschneider": spectra.bretschneider(frequency, sea.height, modal),
        "jonswap": spectra.jonswap(frequency, sea.height, modal, sea.gamma),
        "torsethaugen": spectra.torsethaugen(frequency, sea.height, modal),
    }
    for spectrum, density in theirs.items():
        peak, ratio = spectrum_difference(own[spectrum], density)
        print(
            f"{name}, spectrum {spectrum}: density differs by {100.0 * peak:.2f} % of its peak, "
            f"height {ratio:.4f} of boatsim's"
        )


def frequencies_of_table(loads: WaveLoads, waves: WaveField) -> Array:
    """Return the frequencies of a table that lie within those of a sea."""
    own = loads.frequency
    return own[(own > waves.frequency[0]) & (own < waves.frequency[-1])]


def headings(degrees: Sequence[float]) -> Array:
    """Return the headings of a hull in waves to the north that have these directions to it."""
    return -np.radians(np.array(degrees))


def print_mcsimpython(work: Path) -> None:
    """Print the comparison with MCSimPython."""
    path = mcsimpython.vessel_file()
    print("\nMCSimPython, C/S Arctic Drillship (model of 2.58 m): rms of the difference over the")
    print("largest rms of the axis, at the heading where it is largest [%]")
    frequency = np.linspace(1.3, 12.0, 2000)
    sea = mss.Spectrum(float(DRILLSHIP["significant_height"]), 2.2, GAMMA)
    theirs = mcsimpython.spectra(frequency, sea.height, sea.period, sea.gamma)
    print_spectra("MCSimPython", theirs, frequency, sea)
    loads = mcsimpython.read_vessel(path)
    own = sea_of_table(work / "drillship", loads, **DRILLSHIP)
    copy = mcsimpython.consistent_file(path, work / "drillship.json")
    print(head("first-order loads"))
    chosen = frequencies_of_table(loads, waves_of(own))
    for words, file in (("its file as published", path), ("its file, phases consistent", copy)):
        rows = drillship_in_regular_waves(own, file, chosen)
        print(f"{words + ', waves of the table':56}{percent(rows)}")
    fine = mcsimpython.consistent_file(path, work / "fine_drillship.json", FINER)
    t = np.arange(0.0, 120.0, 0.25)
    for table, file in (("phases consistent", copy), (f"{FINER} times the frequencies", fine)):
        peer = mcsimpython.wave_load(file, waves_of(own))
        for words, degrees in (("in the table", IN_TABLE), ("between", BETWEEN)):
            ours, others = [], []
            for psi in headings(degrees):
                ours.append(loads_at(own, t, float(psi), PLACE))
                others.append(mcsimpython.first_order(peer, t, float(psi), PLACE))
            rows = relative_difference(np.array(ours), np.array(others))
            print(f"{f'irregular sea, {table}, {words}':56}{percent(rows)}")
    print_drift(own, path)
    print_free_drillship(work, own, fine)


def drillship_in_regular_waves(own: PanelWaveLoads, file: Path, chosen: Array) -> Array:
    """Return the differences (6,) in regular waves at points of the table."""
    ours, others = [], []
    for w in chosen:
        wave = replace(own, **regular_sea(own, float(w)))  # type: ignore[arg-type]
        peer = mcsimpython.wave_load(file, waves_of(wave))
        t = times_of_period(float(w))
        for psi in headings(IN_TABLE):
            ours.append(loads_at(wave, t, float(psi), PLACE))
            others.append(mcsimpython.first_order(peer, t, float(psi), PLACE))
    return relative_difference(np.array(ours), np.array(others))


def print_drift(own: PanelWaveLoads, file: Path) -> None:
    """Print the differences of mean and slow drift to MCSimPython, and to its mirrored phases."""
    t = np.arange(0.0, 240.0, 0.5)
    print(f"{'mean and slow drift, irregular sea':56}{'surge':>8}{'sway':>8}{'yaw':>8}")
    ours = []
    for psi in headings(IN_TABLE):
        drifting = loads_at(replace(own, drift=1.0), t, float(psi))
        ours.append((drifting - loads_at(own, t, float(psi)))[:, [0, 1, 5]])
    for words, sign in (("its phases", -1.0), ("its phases with the other sign", 1.0)):
        peer = mcsimpython.wave_load(file, waves_of(own), sign)
        others = [mcsimpython.slow_drift(peer, t, float(psi)) for psi in headings(IN_TABLE)]
        both = np.array(ours), np.array(others)
        print(f"{words:56}{percent(relative_difference(*both))}")
    means = [one.mean(axis=1, keepdims=True) for one in both]
    print(f"{'mean of 240 s':56}{percent(relative_difference(*means))}")


def print_free_drillship(work: Path, own: PanelWaveLoads, file: Path) -> None:
    """Print the differences of the free motion of the drillship."""
    print(head("free motion from rest, 30 s, uncoupled coefficients"))
    for height in FREE_HEIGHTS:
        values = DRILLSHIP | {"components": own.components, "significant_height": height}
        table = f'\n[[effect]]\nuse = "panel_wave_loads"\ncoefficients = "{own.coefficients}"\n'
        for key, value in values.items():
            table += f"{key} = {toml_value(value)}\n"
        vessel = mcsimpython.same_vessel(work / "free_drillship", table)
        peer = mcsimpython.wave_load(file, waves_of(replace(own, significant_height=height)))
        ours, others = [], []
        for psi in headings(IN_TABLE):
            run = float(psi), FREE_RUN, FREE_STEP
            ours.append(turned(mcsimpython.same_free_motion(vessel, *run), float(psi)))
            others.append(turned(mcsimpython.free_motion(peer, *run), float(psi)))
        rows = relative_difference(np.array(ours), np.array(others))
        print(f"{f'significant height {height:g} m':56}{percent(rows)}")


def turned(motion: Array, psi: float) -> Array:
    """Return a motion (T, 6) with the yaw from a heading on [rad]."""
    own = motion.copy()
    own[:, 5] = (own[:, 5] - psi + np.pi) % (2.0 * np.pi) - np.pi
    return own


def print_mss(folder: Path, work: Path) -> None:
    """Print the comparison with MSS."""
    print("\nMSS in GNU Octave: rms of the difference over the largest rms of the axis, at the")
    print("heading where it is largest [%]")
    t = np.arange(0.0, 300.0, 1.5)
    for number, (name, place) in enumerate(mss.TABLES.items()):
        table = folder / place
        found = read_mss(table, 0.0, 0.0, "load")
        loads = WaveLoads(found.source, 0.0, found.frequency, found.heading, found.values)
        own = sea_of_table(work / "mss", loads, **SEAS[name])
        waves = waves_of(own)
        frequency = np.linspace(0.2, 3.0, 2000)
        spectrum = mss.Spectrum(own.significant_height, own.modal_period, GAMMA)
        print(head(f"{name}, first-order loads"))
        rows = mss_in_regular_waves(folder, table, work, own, loads)
        print(f"{'waves of the table':56}{percent(rows)}")
        for words, degrees in (("headings of the table", IN_TABLE), ("between them", BETWEEN)):
            psi = headings(degrees)
            done = mss.run_mss(
                folder, table, work, waves, t, psi, frequency=frequency, spectrum=spectrum
            )
            ours = np.array([loads_at(own, t, float(one)) for one in psi])
            rows = relative_difference(ours, done.loads)
            print(f"{'irregular sea, ' + words:56}{percent(rows)}")
        print_thinned(folder, table, work, own, loads, t)
        largest = np.abs(waves.elevation(0.0, 0.0, t) - done.elevation).max()
        print(f"elevation differs by at most {largest:.1g} m of {own.significant_height:g} m")
        if number == 0:
            print_mss_motions(folder, table, work)
            print_spectra("MSS", done.spectra, frequency, spectrum)


def mss_in_regular_waves(
    folder: Path, table: Path, work: Path, own: PanelWaveLoads, loads: WaveLoads
) -> Array:
    """Return the differences (6,) in regular waves at some points of the table."""
    chosen = frequencies_of_table(loads, waves_of(own))[::3]
    psi = headings(IN_TABLE)
    ours, others = [], []
    for w in chosen:
        wave = replace(own, **regular_sea(own, float(w)))  # type: ignore[arg-type]
        t = times_of_period(float(w))
        others.append(mss.run_mss(folder, table, work, waves_of(wave), t, psi).loads)
        ours.append([loads_at(wave, t, float(one)) for one in psi])
    return relative_difference(np.concatenate(np.array(ours)), np.concatenate(others))


def print_thinned(
    folder: Path, table: Path, work: Path, own: PanelWaveLoads, loads: WaveLoads, t: Array
) -> None:
    """Print the errors at headings that are left out of a table, of boatsim and of MSS."""
    half = replace(loads, heading=loads.heading[::2], excitation=loads.excitation[:, ::2])
    psi = headings(OMITTED)
    whole = np.array([loads_at(own, t, float(one)) for one in psi])
    coarse = sea_of_table(work / "thinned", half, **settings(own))
    found = np.array([loads_at(coarse, t, float(one)) for one in psi])
    full = mss.run_mss(folder, table, work, waves_of(own), t, psi)
    part = mss.run_mss(folder, table, work, waves_of(own), t, psi, thinned=True)
    words = "error at headings left out of the table, boatsim"
    print(f"{words:56}{percent(relative_difference(whole, found))}")
    words = "error at headings left out of the table, MSS"
    print(f"{words:56}{percent(relative_difference(full.loads, part.loads))}")


def settings(own: PanelWaveLoads) -> dict[str, object]:
    """Return the settings of a sea."""
    names = ("spectrum", "significant_height", "modal_period", "toward", "components")
    return {name: getattr(own, name) for name in names}


def print_mss_motions(folder: Path, table: Path, work: Path) -> None:
    """Print the differences of the motions of the supply vessel, simulated and of MSS."""
    print(head("motions, simulated from the table of motions"))
    t = np.arange(300.0, 600.0, 1.5)
    ours, others = [], []
    for degrees in IN_TABLE:
        run, waves = motions_at(table, work / "followed", np.radians(degrees), t)
        done = mss.run_mss(folder, table, work, waves, t, np.zeros(1), motions=True)
        ours.append(run)
        others.append(done.motions[0])
    rows = relative_difference(np.array(ours), np.array(others))
    print(f"{'irregular sea, headings of the table':56}{percent(rows)}")


def main() -> None:
    """Print the comparisons with the programs that are there."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", type=Path, default=WORK, help="working folder")
    parser.add_argument("--mss", type=Path, help="folder of the MSS toolbox")
    given = parser.parse_args()
    work = given.work.resolve()
    try:
        print_mcsimpython(work)
    except ImportError as missing:
        print(f"MCSimPython: not installed ({missing})")
    try:
        folder = mss.check_installed(given.mss)
    except ImportError as missing:
        print(f"MSS: not installed ({missing})")
        return
    print_mss(folder, work)


if __name__ == "__main__":
    main()
