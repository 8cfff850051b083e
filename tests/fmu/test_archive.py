"""The content of an FMU: valid description, source that compiles, and names with units."""

import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from alike import few
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.errors import BadInput
from boatsim.fmu.archive import FMI_VERSIONS, model_identifier, text_files, write_fmu
from boatsim.fmu.source import program_source
from boatsim.fmu.surroundings import with_surroundings
from boatsim.fmu.units import base_unit
from boatsim.fmu.variables import quoted_name, vessel_variables
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.native.build import NoCompiler, compiler_path
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel, load_vessel

try:
    compiler_path()
except NoCompiler:
    pytest.skip("an FMU needs a C compiler", allow_module_level=True)


def strange_vessel() -> Vessel:
    """Names that neither XML nor C nor FMI allow as they are."""
    return Vessel.from_effects(
        name='7 <boats> & "one"',
        dof=("surge", "sway", "yaw"),
        length=2.0,
        beam=0.8,
        draught=0.2,
        body={"mass": 120.0, "roll_inertia": 8.0, "yaw_inertia": 40.0},
        channels={"thrust.port-1_N": {"low": -50.0, "high": 50.0, "about": "a < b & \x02 c"}},
        effects=[
            {"use": "added_mass", "surge": 10.0, "sway": 90.0, "yaw": 15.0},
            {"use": "linear_damping", "surge": 12.0, "sway": 60.0, "yaw": 30.0},
            {
                "use": "thruster",
                "name": 'a "motor"\\',
                "on": {"thrust": "thrust.port-1_N", "angle": 0.1},
            },
        ],
    )


@pytest.mark.parametrize("name", few(shipped_content_names("vessel"), 0, 3))
def test_the_description_of_each_vessel_is_valid(name: str, tmp_path: Path) -> None:
    validation = pytest.importorskip("fmpy.validation")
    program = Program(with_surroundings(load_vessel(name)))
    for version in FMI_VERSIONS:
        files = text_files(program, vessel_variables(program), version, 0.02)
        (tmp_path / "modelDescription.xml").write_text(files["modelDescription.xml"])
        assert validation.validate_fmu(str(tmp_path)) == []


@pytest.mark.parametrize("version", ["3", "2"])
def test_strange_names_give_a_valid_fmu(version: str, tmp_path: Path) -> None:
    validation = pytest.importorskip("fmpy.validation")
    variables = write_fmu(strange_vessel(), tmp_path / "boat.fmu", version)
    assert validation.validate_fmu(str(tmp_path / "boat.fmu")) == []
    names = [variable.name for variable in variables]
    assert "'thrust.port-1_N'" in names and "'a _motor__'.gain" in names
    assert "'actual_thrust.port-1_N'" in names


def test_the_archive_has_description_source_and_binary(tmp_path: Path) -> None:
    write_fmu(load_vessel("trial_boat"), tmp_path / "a.fmu")
    write_fmu(load_vessel("trial_boat"), tmp_path / "b.fmu")
    names = zipfile.ZipFile(tmp_path / "a.fmu").namelist()
    assert "modelDescription.xml" in names and "sources/buildDescription.xml" in names
    binaries = [name for name in names if name.startswith("binaries/")]
    assert len(binaries) == 1 and "/trial_boat." in binaries[0]
    assert (tmp_path / "a.fmu").read_bytes() == (tmp_path / "b.fmu").read_bytes()
    assert not list(tmp_path.glob("*.part-*"))


def test_the_binary_is_for_any_processor_of_the_kind_and_shows_the_functions_of_fmi_only(
    tmp_path: Path,
) -> None:
    write_fmu(load_vessel("trial_boat"), tmp_path / "boat.fmu", "2")
    with zipfile.ZipFile(tmp_path / "boat.fmu") as archive:
        (name,) = [one for one in archive.namelist() if one.startswith("binaries/")]
        archive.extract(name, tmp_path)
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", str(tmp_path / name)], capture_output=True, text=True
    )
    if listed.returncode:
        pytest.skip("nm is not installed")
    symbols = [line.split()[-1] for line in listed.stdout.splitlines()]
    assert "fmi2DoStep" in symbols
    assert not [symbol for symbol in symbols if not symbol.startswith(("fmi2", "_"))]


@pytest.mark.parametrize("version", ["3", "2"])
def test_the_source_in_the_archive_compiles(version: str, tmp_path: Path) -> None:
    write_fmu(load_vessel("trial_boat"), tmp_path / "boat.fmu", version)
    zipfile.ZipFile(tmp_path / "boat.fmu").extractall(tmp_path)
    if version == "3":
        root = ElementTree.parse(tmp_path / "sources" / "buildDescription.xml").getroot()
        files = [one.get("name") for one in root.iter("SourceFile")]
    else:
        root = ElementTree.parse(tmp_path / "modelDescription.xml").getroot()
        files = [one.get("name") for one in root.iter("File")]
    command = [compiler_path(), "-Wall", "-Wno-unused", "-Werror", "-shared", "-fPIC", "-O0"]
    subprocess.run([*command, *files, "-o", "boat.so", "-lm"], cwd=tmp_path / "sources", check=True)


def test_variables_have_the_names_and_units_of_recordings() -> None:
    variables = {v.name: v for v in vessel_variables(Program(load_vessel("otter")))}
    assert (variables["psi_rad"].unit, variables["psi_rad"].causality) == ("rad", "output")
    assert variables["der(psi_rad,2)"].derivative_of == "der(psi_rad)"
    assert variables["force_N_Nm"].unit == "N m"
    assert variables["body.mass"].start == 55.0
    assert variables["body.centre[2]"].start == -0.2
    assert variables["external.K_Nm"].causality == "input"


def test_each_unit_of_the_library_is_known_in_base_units() -> None:
    units = set()
    for name in shipped_content_names("effect"):
        units |= {about.unit for about in load_class("effect", name).params().values()}
    for unit in units - {""}:
        base_unit(unit)
    assert base_unit("N s^2/m^2").exponents == {"kg": 1, "m": -1}
    assert base_unit("V").exponents == base_unit("N m/s").exponents | {"A": -1}  # W = V A
    assert base_unit("rpm").factor == pytest.approx(2 * np.pi / 60)
    with pytest.raises(BadInput, match="'furlong' is not known"):
        base_unit("furlong/s")


def test_an_effect_that_remembers_the_motion_is_refused_by_its_name() -> None:
    waves = {"use": "heave_radiation", "name": "waves", "damping": 80.0, "frequency": 6.1}
    boat = Vessel.from_effects(
        name="raft",
        dof=("heave",),
        length=2.0,
        beam=0.8,
        draught=0.2,
        body={"mass": 120.0, "roll_inertia": 8.0, "yaw_inertia": 40.0},
        channels={},
        effects=[{"use": "added_mass", "heave": 60.0}, waves],
    )
    with pytest.raises(BadInput, match="an FMU takes no effect with a memory of the motion: waves"):
        program_source(Program(boat), [], 0.02, "token")


def test_names_are_quoted_where_fmi_requires_it() -> None:
    assert quoted_name("thrust_port_N") == "thrust_port_N"
    assert quoted_name("a b") == "'a b'"
    assert quoted_name("it's") == "'it_s'"
    assert model_identifier("7 boats é") == "vessel_7_boats__"


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["trial_bot"], "vessel 'trial_bot' does not exist; did you mean 'trial_boat'?"),
        (["trial_boat", "--step", "0"], "step = 0.0; allowed 0.0001 to 1 s"),
        (["trial_boat", "--out", "boat.zip"], "boat.zip: the name of an FMU ends in .fmu"),
        (["trial_boat", "--fmi", "4"], "is not one of '3', '2'"),
        (["trial_boat", "--out", "taken/boat.fmu"], "taken: File exists"),
    ],
)
def test_a_mistake_is_one_line_and_writes_nothing(
    arguments: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("a file, no folder")
    result = CliRunner().invoke(app, ["export", "fmu", *arguments])
    assert result.exit_code == 2 and not result.stdout
    assert result.stderr.count("\n") == 1 and said in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]


def test_without_a_compiler_nothing_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", "no_such_compiler")
    out = tmp_path / "new" / "boat.fmu"
    result = CliRunner().invoke(app, ["export", "fmu", "trial_boat", "--out", str(out)])
    assert result.exit_code == 2 and "an FMU contains a binary: no C compiler" in result.stderr
    assert not out.parent.exists()


def test_the_command_states_what_it_wrote_and_what_has_no_influence(tmp_path: Path) -> None:
    out = tmp_path / "new" / "boat.fmu"
    result = CliRunner().invoke(app, ["export", "fmu", "trial_boat", "--out", str(out)])
    assert result.exit_code == 0 and out.is_file()
    assert "FMI 3.0, 11 inputs, 51 parameters, 15 outputs, step 0.02 s" in result.stdout
    assert "act once the parameters measured_wind.front" in result.stderr
