"""Couples the FMU of a boat with that of a heading controller, step by step, through FMPy.

python examples/fmu/couple.py        needs fmpy and a C compiler; writes to out/fmu
"""

import argparse
import platform
import shutil
import subprocess
import zipfile
from math import degrees
from pathlib import Path

import fmpy
from fmpy.simulation import instantiate_fmu

from boatsim import load_vessel
from boatsim.fmu.archive import write_fmu

HERE = Path(__file__).parent
VESSEL = "trial_boat"
STEP = 0.1  # [s] communication step: five integration steps of the boat
DURATION = 30.0  # [s]
CURRENT = 0.05  # [m/s] to north
# output of one FMU -> input of the other
TO_CONTROLLER = {"psi_rad": "psi_rad", "r_radps": "r_radps"}
TO_BOAT = {"port_N": "thrust_port_N", "starboard_N": "thrust_starboard_N"}


class Unit:
    """An instance of an FMU for co-simulation whose variables are read and set by name."""

    def __init__(self, path: Path) -> None:
        """Unpack and instantiate the FMU."""
        description = fmpy.read_model_description(path)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.folder = fmpy.extract(str(path))
        self.fmu = instantiate_fmu(self.folder, description, "CoSimulation")
        self.is_fmi2 = description.fmiVersion == "2.0"

    def initialise(self, values: dict[str, float]) -> None:
        """Set start values and leave the initialisation."""
        self.write(values)
        if self.is_fmi2:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def read(self, name: str) -> float:
        """Return the value of a variable."""
        get = self.fmu.getReal if self.is_fmi2 else self.fmu.getFloat64
        return float(get([self.references[name]])[0])

    def write(self, values: dict[str, float]) -> None:
        """Set variables."""
        put = self.fmu.setReal if self.is_fmi2 else self.fmu.setFloat64
        for name, value in values.items():
            put([self.references[name]], [value])

    def close(self) -> None:
        """Free the instance and its unpacked files."""
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def write_controller(path: Path) -> None:
    """Compile the controller and write its FMU for this computer."""
    if platform.system() != "Linux" or platform.machine() != "x86_64":
        raise SystemExit("couple.py: the controller is compiled for Linux on x86_64 only")
    library = path.with_suffix(".so")
    source = HERE / "heading_controller.c"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", library], check=True)
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(HERE / "heading_controller.xml", "modelDescription.xml")
        archive.write(library, "binaries/linux64/heading_controller.so")
    library.unlink()


def couple(boat: Unit, controller: Unit) -> None:
    """Run both units; in each step the controller sees the boat's outputs first."""
    print("t [s]  heading [deg]  x [m]  y [m]  thrust port, starboard [N]")
    for i in range(round(DURATION / STEP)):
        now = i * STEP
        controller.write({there: boat.read(here) for here, there in TO_CONTROLLER.items()})
        controller.fmu.doStep(now, STEP)
        boat.write({there: controller.read(here) for here, there in TO_BOAT.items()})
        boat.fmu.doStep(now, STEP)
        if (i + 1) % 50 == 0:
            thrusts = [controller.read(name) for name in TO_BOAT]
            print(
                f"{now + STEP:5.1f}  {degrees(boat.read('psi_rad')):13.1f}"
                f"  {boat.read('x_m'):5.1f}  {boat.read('y_m'):5.1f}"
                f"  {thrusts[0]:12.2f}, {thrusts[1]:.2f}"
            )


def main() -> None:
    """Write both FMUs and run them together."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/fmu"), help="folder of the FMUs")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    write_fmu(load_vessel(VESSEL), out / "boat.fmu")
    write_controller(out / "controller.fmu")
    boat, controller = Unit(out / "boat.fmu"), Unit(out / "controller.fmu")
    boat.initialise({"current.north": CURRENT})
    controller.initialise({"goal_rad": 1.0})
    couple(boat, controller)
    boat.close()
    controller.close()


if __name__ == "__main__":
    main()
