"""Writes a vessel as an FMU: a zip archive with description, C source and binary."""

import hashlib
import platform
import re
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from boatsim.arguments import checked_choice, checked_number
from boatsim.errors import BadInput
from boatsim.files import replace_file
from boatsim.fmu.model_description import (
    ModelInformation,
    build_description,
    fmi2_description,
    fmi3_description,
)
from boatsim.fmu.sensors import SensorSuite, sensor_variables
from boatsim.fmu.source import HEADER, interface_source, program_source
from boatsim.fmu.surroundings import with_surroundings
from boatsim.fmu.variables import Variable, vessel_variables
from boatsim.physics.native.build import EXACT, PORTABLE, NoCompiler, compiler_path, run_compiler
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel

SUFFIX = ".fmu"
FMI_VERSIONS = ("3", "2")
STEP = 0.02  # [s] default of a scenario, so that an FMU repeats `boatsim run`
SHORTEST_STEP, LONGEST_STEP = 1e-4, 1.0  # [s] as in a scenario
HIDDEN = "-fvisibility=hidden"  # only the functions of FMI are visible to the importing program
EARLIEST = (1980, 1, 1, 0, 0, 0)  # date of all files, so that equal vessels give equal archives
# Name of this computer's folder of binaries: of FMI 3.0 and of FMI 2.0
SYSTEMS = {"linux": ("linux", "linux64", ".so"), "darwin": ("darwin", "darwin64", ".dylib")}
MACHINES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}


def write_fmu(
    vessel: Vessel,
    path: Path,
    fmi_version: str = "3",
    step: float = STEP,
    sensors: SensorSuite | None = None,
) -> list[Variable]:
    """Write a vessel as an FMU with description, C source and a binary of the local compiler.

    The file is replaced only when the new one is complete.

    Args:
        vessel: The vessel.
        path: File to write, which ends in ".fmu".
        fmi_version: "3" for co-simulation and model exchange of FMI 3.0, "2" for co-simulation of
            FMI 2.0.
        step: Integration step [s].
        sensors: Sensors with errors; None for true accelerations only.

    Returns:
        The variables of the FMU in the order of their value references.

    Raises:
        BadInput: There is no C compiler, a law has no C form, or an argument is not allowed.
        OSError: The file cannot be written.
    """
    checked_choice("fmi_version", fmi_version, FMI_VERSIONS)
    step = checked_number("step", step, SHORTEST_STEP, LONGEST_STEP, "s")
    if sensors is not None and step > sensors.period:
        # a sample is taken at the end of a step only
        raise BadInput(
            f"--step = {step:g} s; allowed are at most the control period {sensors.period:g} s of "
            f"{sensors.scenario}"
        )
    if path.suffix != SUFFIX:
        raise BadInput(f"{path}: the name of an FMU ends in {SUFFIX}")
    try:
        command = compiler_path()
    except NoCompiler as error:
        raise NoCompiler(f"an FMU contains a binary: {error}") from None
    program = Program(with_surroundings(vessel))
    measured: list[Variable] = []
    if sensors is not None:
        measured = list(sensor_variables(sensors))
    variables = vessel_variables(program, measured)
    files = text_files(program, variables, fmi_version, step, sensors)
    identifier = model_identifier(vessel.name)
    place = _binary_path(fmi_version, identifier)
    binary = _compile(files, fmi_version, command)
    with replace_file(path) as temporary, ZipFile(temporary, "w", ZIP_DEFLATED) as archive:
        for name, content in files.items():
            _add(archive, name, content.encode())
        _add(archive, place, binary)
    return variables


def model_identifier(name: str) -> str:
    """Return a vessel's name as a C identifier, which names the binary of its FMU."""
    found = re.sub(r"[^A-Za-z0-9_]", "_", name)
    if not found or found[0].isdigit():
        return f"vessel_{found}"
    return found


def text_files(
    program: Program,
    variables: Sequence[Variable],
    fmi_version: str,
    step: float,
    sensors: SensorSuite | None = None,
) -> Mapping[str, str]:
    """Return the description and the C source of an FMU.

    Args:
        program: The compiled program of the vessel, with its surroundings.
        variables: The variables of the FMU in the order of their value references.
        fmi_version: "3" or "2".
        step: Integration step [s].
        sensors: Sensors with errors; None for none.

    Returns:
        Text of each file by its path in the archive.

    Raises:
        NotTranslatable: A law has no C form.
    """
    vessel = program.vessel
    identifier = model_identifier(vessel.name)
    interface = f"fmi{fmi_version}.c"
    sources = {"vessel.h": interface_source("vessel.h"), interface: interface_source(interface)}
    # The token depends on all that the binary is made of, so that it accepts its own states only.
    if sensors is not None:
        sources |= {name: interface_source(name) for name in ("random.h", "sensors.h")}
    digest = hashlib.sha256(program_source(program, variables, step, "", sensors).encode())
    for text in sources.values():
        digest.update(text.encode())
    token = f"{{{digest.hexdigest()[:32]}}}"
    sources[HEADER] = program_source(program, variables, step, token, sensors)
    model = ModelInformation(vessel.name, identifier, vessel.about, token, step)
    if fmi_version == "3":
        description = fmi3_description(model, variables)
        sources["buildDescription.xml"] = build_description(identifier, EXACT)
    else:
        description = fmi2_description(model, variables)
    files = {"modelDescription.xml": description}
    for name, text in sources.items():
        files[f"sources/{name}"] = text
    return files


def _compile(files: Mapping[str, str], fmi_version: str, command: str) -> bytes:
    """Compile the source of an FMU; return the binary."""
    with tempfile.TemporaryDirectory(prefix="boatsim_fmu_") as folder:
        place = Path(folder)
        for name, text in files.items():
            if name.endswith((".c", ".h")):
                (place / Path(name).name).write_text(text, encoding="utf-8")
        library = place / "vessel.bin"
        run_compiler(command, (*PORTABLE, HIDDEN), place / f"fmi{fmi_version}.c", library)
        return library.read_bytes()


def _binary_path(fmi_version: str, identifier: str) -> str:
    """Path of the binary in the archive, named after this computer's system and processor."""
    machine = MACHINES.get(platform.machine().lower())
    if sys.platform not in SYSTEMS or machine is None:
        raise BadInput(f"no FMU for {sys.platform} on {platform.machine()}")
    system, fmi2_folder, suffix = SYSTEMS[sys.platform]
    folder = fmi2_folder if fmi_version == "2" else f"{machine}-{system}"
    return f"binaries/{folder}/{identifier}{suffix}"


def _add(archive: ZipFile, name: str, content: bytes) -> None:
    """Add a file to the archive with a date that does not depend on the time of the export."""
    entry = ZipInfo(name, EARLIEST)
    entry.compress_type = ZIP_DEFLATED
    entry.external_attr = 0o644 << 16
    archive.writestr(entry, content)
