"""Implementation of `boatsim export`: a recording as MCAP, or a vessel as an FMU."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from boatsim.api import load_scenario, read
from boatsim.cli.exits import print_lines, print_notes
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.fmu.archive import SUFFIX as FMU_SUFFIX
from boatsim.fmu.archive import write_fmu
from boatsim.fmu.sensors import SensorSuite
from boatsim.fmu.surroundings import added_surroundings
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.exporting.mcap import SUFFIX as MCAP_SUFFIX
from boatsim.recordings.exporting.mcap import write_mcap


def export_recording(path: Path, out: Path | None, vessel: str | None, load: Sequence[str]) -> int:
    """Write a recording to an MCAP file.

    Args:
        path: File of the recording.
        out: File to write; None for one next to the recording.
        vessel: Vessel of the recording; None for the one that recording.toml names.
        load: Load conditions.

    Returns:
        Exit code.

    Raises:
        BadInput: If the recording cannot be read, or a library is not installed.
    """
    if out is None:
        out = path.with_suffix(MCAP_SUFFIX)
    if out.resolve() == path.resolve():
        raise BadInput(f"--out {out} would overwrite the recording; give another name")
    recording = read(path, vessel, load)
    count = write_mcap(recording, out)
    print_notes(recording.remarks)
    print_lines(
        [escape_for_terminal(f"written to {out}: {len(recording)} rows in {count} messages")]
    )
    return 0


def export_vessel(
    name: str,
    out: Path | None,
    fmi: str,
    step: float,
    load: Sequence[str],
    sensors: str | None = None,
) -> int:
    """Write a vessel to an FMU.

    Args:
        name: Name, folder or file of the vessel.
        out: File to write; None for one in the folder `out`.
        fmi: Version of FMI, "3" or "2".
        step: Integration step [s].
        load: Load conditions.
        sensors: Scenario with the sensors of the vessel, by name or path; None for no sensors.

    Returns:
        Exit code.

    Raises:
        BadInput: If the vessel or the scenario cannot be read, an FMU cannot have one of the
            sensors, or there is no C compiler.
    """
    vessel = load_vessel(name, load)
    suite = None
    if sensors is not None:
        suite = SensorSuite.from_scenario(load_scenario(sensors))
    if out is None:
        out = Path("out") / f"{vessel.name}{FMU_SUFFIX}"
    variables = write_fmu(vessel, out, fmi, step, suite)
    counts = Counter(variable.causality for variable in variables)
    print_notes(added_surroundings(vessel))
    print_lines(
        [
            escape_for_terminal(
                f"written to {out}: FMI {fmi}.0, {counts['input']} inputs, "
                f"{counts['parameter']} parameters, {counts['output']} outputs, step {step:g} s"
            )
        ]
    )
    return 0
