"""Waves, loads and motions of T. I. Fossen's MSS toolbox for the sea of boatsim, by GNU Octave."""

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array
from boatsim.physics.waves.field import WaveField

SCRIPT = Path(__file__).with_name("in_octave.m")
ENVIRONMENT = Path("LIBRARY") / "environment"
TABLES = {
    "supply vessel": Path("HYDRO") / "vessels_shipx" / "supply" / "supply.mat",
    "tanker": Path("HYDRO") / "vessels_wamit" / "tanker" / "tanker.mat",
}
RAND = """function r = rand(varargin)
global SEA_PHASES
r = SEA_PHASES / (2 * pi);
end
"""


@dataclass(frozen=True, eq=False)
class MssResult:
    """Results of MSS.

    Attributes:
        loads: First-order loads (H, T, 6) of each heading [N, N m].
        motions: Motions (H, T, 6) [m, rad]; 0 if they were not asked for.
        elevation: Elevation (T,) [m].
        seconds: Computing time of the loads [s].
        spectra: Density (F,) of each spectrum by the name of boatsim's [m^2 s].
    """

    loads: Array
    motions: Array
    elevation: Array
    seconds: float
    spectra: dict[str, Array]


@dataclass(frozen=True)
class Spectrum:
    """Parameters of a spectrum: height [m], modal period [s], and enhancement of the peak."""

    height: float
    period: float
    gamma: float


def check_installed(folder: Path | None) -> Path:
    """Return the folder of MSS.

    Args:
        folder: Folder of the toolbox, None if it is not given.

    Raises:
        ImportError: The folder is no copy of MSS, or Octave is not installed.
    """
    if folder is None:
        raise ImportError("--mss FOLDER names a copy of the toolbox")
    if not (folder / ENVIRONMENT / "waveForceRAO.m").is_file():
        raise ImportError(f"{folder} has no {ENVIRONMENT / 'waveForceRAO.m'}")
    if shutil.which("octave") is None:
        raise ImportError("no command octave")
    return folder.resolve()


def run_mss(
    mss: Path,
    table: Path,
    work: Path,
    waves: WaveField,
    t: Array,
    psi: Array,
    *,
    frequency: Array | None = None,
    spectrum: Spectrum | None = None,
    motions: bool = False,
    thinned: bool = False,
) -> MssResult:
    """Return the results of MSS for waves of one direction on a vessel at the origin.

    Args:
        mss: Folder of the toolbox.
        table: Vessel structure, NAME.mat.
        work: Working folder.
        waves: The waves.
        t: Times (T,) [s].
        psi: Headings of the vessel (H,) [rad].
        frequency: Frequencies (F,) of the spectra [rad/s].
        spectrum: Parameters of the spectra.
        motions: Whether motions are computed.
        thinned: Whether every second heading of the table is left out.

    Raises:
        RuntimeError: Octave fails.
    """
    from scipy.io import loadmat, savemat

    own = (work / "octave").resolve()
    own.mkdir(parents=True, exist_ok=True)
    (own / "rand.m").write_text(RAND)
    given = spectrum or Spectrum(1.0, 10.0, 3.3)
    grid = np.array([0.5, 1.0]) if frequency is None else frequency
    values = {
        "phase": waves.phase,
        "omega": waves.frequency,
        "amplitude": waves.amplitude,
        "toward": float(waves.direction[0]),
        "t": t,
        "psi": psi,
        "environment": str(mss / ENVIRONMENT),
        "table_file": str(table.resolve()),
        "output_file": str(own / "output.mat"),
        "with_motions": float(motions),
        "thinned": float(thinned),
        "height": given.height,
        "period": given.period,
        "gamma_peak": given.gamma,
        "spectrum_omega": grid,
    }
    savemat(own / "input.mat", values)
    code = f"input_file = '{own / 'input.mat'}'; source('{SCRIPT.resolve()}');"
    done = subprocess.run(
        ["octave", "--no-gui", "--quiet", "--norc", "--eval", code],
        capture_output=True,
        text=True,
        cwd=own,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"octave: {done.stderr.strip().splitlines()[-1]}")
    found = loadmat(own / "output.mat")
    return MssResult(
        loads=found["loads"],
        motions=found["motions"],
        elevation=found["elevation"].ravel(),
        seconds=float(found["seconds"].ravel()[0]),
        spectra={
            "bretschneider": found["pierson"].ravel(),
            "jonswap": found["jonswap"].ravel(),
            "torsethaugen": found["torsethaugen"].ravel(),
        },
    )
