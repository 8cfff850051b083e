"""Composition: an edited law is compiled anew, a suspect that is off does nothing, a user's own
effect works."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import boats
import numpy as np
import pytest
from alike import few

from boatsim.errors import BadInput
from boatsim.physics import content, dependency_hash, vessel
from boatsim.physics.base import AXES, Array, make_motion
from boatsim.physics.effects.added_mass import AddedMass
from boatsim.physics.effects.current import Current
from boatsim.physics.effects.damping import LinearDamping
from boatsim.physics.effects.wind import Wind
from boatsim.physics.program import Program

SPRING = '''"""A spring in roll."""

from dataclasses import dataclass
from typing import ClassVar

from numba import njit

from boatsim.physics.base import Force, param, wrench


@njit(inline="always")
def law(m, q):
    """Moment against the heel."""
    return wrench(K=-3.0 * q.stiffness * m.phi)


@dataclass(frozen=True)
class Spring(Force):
    """Moment in proportion to the heel."""

    words: ClassVar[str] = "a spring turns the boat back"
    shown_by: ClassVar[str] = "a roll decay"
    law: ClassVar = law

    stiffness: float = param(1.0, low=0.0, high=10.0, unit="N m", words="per rad")
'''
PITCH = "pitch_inertia = 0.5, "
IMPORT = "from boatsim.physics.base import"
GRAVITY = f"from boatsim.physics import particulars\n{IMPORT}"
USE_SPRING = '[[effect]]\nuse = "spring"\n'
SNIPPET = """
import sys
import numpy as np
from boatsim.physics import vessel
from boatsim.physics.program import Program
from boatsim.physics.trust import trust_folders

with trust_folders(sys.argv[1]):
    program = Program(vessel.load_vessel(sys.argv[1]))
act = np.zeros(program.actuator_signal_size)
print(program.module.total_body_force(0.0, np.array([0.1, 0.0]), act, np.int64(0), program.values(), program.effect_switches())[0])
"""


def with_spring(folder: Path) -> Path:
    """Folder of a vessel with an effect of its own beside it."""
    place = boats.written(folder, "test_roller", boats.ROLL + USE_SPRING)
    (place / "spring.py").write_text(SPRING)
    return place


def moment(place: Path, more: Mapping[str, str] | None = None) -> float:
    """Roll moment [N m] at 0.1 rad, in a fresh process with further variables in its
    environment."""
    done = subprocess.run(
        [sys.executable, "-c", SNIPPET, str(place)],
        cwd=place,
        env=os.environ | dict(more or {}),
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout)


def forces(program: Program, state: Sequence[float], on: Array | None = None) -> tuple[float, ...]:
    """Body force over the freedoms at a state in joint coordinates and their rates, actuators at
    rest."""
    act, switches = (
        np.zeros(program.actuator_signal_size),
        program.effect_switches() if on is None else on,
    )
    return tuple(
        program.module.total_body_force(
            0.0, np.array(state), act, np.int64(0), program.values(), switches
        )
    )


@pytest.mark.slow
def test_an_edited_law_gives_its_new_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    place = with_spring(tmp_path)
    assert moment(place) == pytest.approx(-0.1 * (2.0 + 3.0))
    law = place / "spring.py"
    law.write_text(law.read_text().replace("-3.0", "-4.0"))
    assert moment(place) == pytest.approx(-0.1 * (2.0 + 4.0))
    assert len(list((tmp_path / "cache").glob("program_*"))) == 2


@pytest.mark.usefixtures("trusted")
def test_a_law_edited_while_the_program_runs_gives_its_new_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    place = with_spring(tmp_path)
    law = place / "spring.py"
    for factor in (3.0, 4.0):
        law.write_text(SPRING.replace("-3.0", f"-{factor}"))
        assert forces(Program(vessel.load_vessel(str(place))), [0.1, 0.0]) == pytest.approx(
            [-0.1 * (2.0 + factor)]
        )


@pytest.mark.usefixtures("trusted")
def test_effects_of_one_name_beside_two_vessels_are_two_effects(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    places = []
    for folder, factor in (("one", "-3.0"), ("two", "-5.0")):
        (tmp_path / folder).mkdir()
        places.append(with_spring(tmp_path / folder))
        law = places[-1] / "spring.py"
        law.write_text(law.read_text().replace("-3.0", factor))
    found = [forces(Program(vessel.load_vessel(str(place))), [0.1, 0.0]) for place in places]
    assert found == [pytest.approx([-0.1 * (2.0 + 3.0)]), pytest.approx([-0.1 * (2.0 + 5.0)])]


STATE = [0.1, 0.2, 0.4, 0.3, -0.2, 0.1]


def test_a_suspect_acts_only_when_it_is_switched_on(tmp_path: Path) -> None:
    suspects = (Wind(force=0.3, toward=0.2), Current(north=0.1))
    bare = boats.planar(tmp_path)
    program = Program(bare, suspects)
    off, windy = program.effect_switches(), program.effect_switches(["wind"])
    assert list(off[-2:]) == [0.0, 0.0] and list(windy[-2:]) == [1.0, 0.0]
    own = Program(bare)
    none = forces(own, STATE)
    assert forces(program, STATE, off) == none
    north, east = 0.3 * np.cos(0.2), 0.3 * np.sin(0.2)
    along, across = (
        0.5 * (np.cos(0.4) * north + np.sin(0.4) * east),
        np.cos(0.4) * east - np.sin(0.4) * north,
    )
    assert np.subtract(forces(program, STATE, windy), none) == pytest.approx([along, across, 0.0])
    assert forces(program, STATE, program.effect_switches(["current"])) != none


def test_parameters_lie_where_the_index_says(tmp_path: Path) -> None:
    program = Program(boats.planar(tmp_path, {"quadratic_damping": {"yaw": 1.25}}))
    assert program.values()[program.parameter_index("quadratic_damping", "yaw")] == 1.25
    assert program.values()[program.parameter_index("port", "y")] == -0.5


def test_commands_that_are_not_given_are_zero(tmp_path: Path) -> None:
    program = Program(boats.planar(tmp_path))
    assert list(program.command_array({"thrust_starboard_N": 2.0})) == [0.0, 2.0, 0.0, 0.0]
    with pytest.raises(BadInput, match="test_boat: command 'steer' does not exist"):
        program.command_array({"steer": 0.1})


@pytest.mark.parametrize(
    "dof", [("surge", "sway"), ("sway", "roll"), ("surge", "heave", "pitch"), ("yaw",)]
)
def test_any_freedoms_feel_their_part_of_the_same_law(tmp_path: Path, dof: tuple[str, ...]) -> None:
    text = boats.PLANAR.replace('["surge", "sway", "yaw"]', str(list(dof))).replace(
        "body = { ", f"body = {{ {PITCH}"
    )
    program = Program(vessel.load_vessel(str(boats.written(tmp_path, "test_boat", text))))
    rates = {"surge": 0.3, "sway": -0.2, "yaw": 0.1, "heave": 0.2, "roll": 0.4, "pitch": -0.3}
    moving = {a: rates.get(a, 0.0) if a in dof else 0.0 for a in AXES}
    m = make_motion(**{symbol: moving[a] for symbol, a in zip("uvwpqr", AXES, strict=True)})
    wanted = sum(
        np.array(e.wrench(m)) for e in program.effects if isinstance(e, AddedMass | LinearDamping)
    )
    seen = forces(program, [*(0.0 for _ in dof), *(moving[a] for a in AXES if a in dof)])
    assert seen == pytest.approx([wanted[AXES.index(a)] for a in AXES if a in dof])
    assert np.any(seen)


def test_an_unwritable_cache_folder_falls_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    monkeypatch.setenv("BOATSIM_CACHE", str(blocked / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    for name in [n for n in sys.modules if n.startswith("boatsim_program_")]:
        monkeypatch.delitem(sys.modules, name)  # another test may have composed the same program
    boat = vessel.load_vessel(str(boats.written(tmp_path, "test_fallback", boats.ROLL)))
    assert str(Program(boat).module.__file__).startswith(str(tmp_path / "boatsim-"))


def test_programs_not_used_for_90_days_are_removed_when_a_new_one_is_composed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("BOATSIM_CACHE", str(tmp_path / "cache"))
    used = time.time() - 91 * 86400.0
    for name, age in (("program_old", used), ("program_recent", time.time() - 89 * 86400.0)):
        folder = tmp_path / "cache" / name
        folder.mkdir(parents=True)
        (folder / "__init__.py").write_text("")
        os.utime(folder, (age, age))
    program = Program(boats_own_roller(tmp_path))
    stamp = program.module.__name__.removeprefix("boatsim_program_")
    left = {folder.name for folder in (tmp_path / "cache").iterdir()}
    assert left == {"program_recent", f"program_{stamp}"}
    folder = tmp_path / "cache" / f"program_{stamp}"
    os.utime(folder, (used, used))
    assert (
        Program(program.vessel).module is program.module and folder.stat().st_mtime > used + 86400.0
    )


def boats_own_roller(folder: Path) -> vessel.Vessel:
    """A vessel whose program no other test composes."""
    return vessel.load_vessel(
        str(boats.written(folder, "roller", boats.ROLL + '[[effect]]\nuse = "wind"\n'))
    )


# A program's name covers all that its laws can reach: tried on a copy of the package


STAMP = """
import sys
from boatsim.physics import cache, vessel
from boatsim.physics.program import Program

cache._import_package = lambda path, name: name  # the name alone: nothing is compiled
print(*(Program(vessel.load_vessel(place)).module for place in sys.argv[1:]))
"""
# a file, what of it is changed into what, whether a spring in roll, and waves, can feel it
EDITS = [
    ("particulars.py", ("GRAVITY = 9.81", "GRAVITY = 19.62"), (True, True)),
    ("noise.py", ("9007199254740992.0", "9007199254740993.0"), (False, True)),
    ("kernel/run.py", ("LONG = 1e4", "LONG = 2e4"), (True, True)),
    ("kernel/compiling.py", ("\n", "\n\n"), (True, True)),
    ("kinds/force.py", ('ADD = "; "', 'ADD = ";  "'), (True, True)),
    ("signals.py", ("\n", "\n\n"), (True, True)),
    ("waves/sea_state.py", ("LOWEST = 0.45", "LOWEST = 0.5"), (False, True)),
    ("effects/righting_arm.py", ("return wrench(K=-", "return wrench(K=-2.0 * "), (True, False)),
    ("effects/tether.py", ("SOFT = 0.02", "SOFT = 0.03"), (False, False)),
]


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package, a boat with a spring and one in waves, and the names of their
    programs."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(
        content.content_root() / "boatsim",
        folder / "boatsim",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    boats.written(folder, "sprung", boats.ROLL)
    waves = boats.ROLL[: boats.ROLL.index("[[effect]]")].replace(
        '["roll"]', '["sway", "roll", "yaw"]'
    )
    boats.written(folder, "tossed", f'{waves}[[effect]]\nuse = "irregular_sea"\n')
    (folder / "before").write_text(" ".join(names_in(folder)))
    return folder


def names_in(folder: Path) -> list[str]:
    """Names of the programs of both boats, by a fresh process on the package in a folder."""
    places = [str(folder / name) for name in ("sprung", "tossed")]
    environment = os.environ | {"PYTHONPATH": str(folder), "BOATSIM_CACHE": str(folder / "cache")}
    done = subprocess.run(
        [sys.executable, "-c", STAMP, *places],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.split()


@pytest.mark.parametrize(("file", "change", "felt"), few(EDITS), ids=[file for file, _, _ in EDITS])
def test_a_program_has_another_name_when_anything_its_laws_reach_is_edited(
    copied: Path, file: str, change: tuple[str, str], felt: tuple[bool, bool]
) -> None:
    before, source = (copied / "before").read_text().split(), copied / "boatsim" / "physics" / file
    text = source.read_text()
    assert change[0] in text and len(set(before)) == 2
    try:
        source.write_text(text.replace(*change, 1))
        after = names_in(copied)
    finally:
        source.write_text(text)
    assert tuple(a != b for a, b in zip(before, after, strict=True)) == felt


def test_what_a_file_imports_by_dots_is_reached_too(
    copied: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    physics = copied / "boatsim" / "physics"
    monkeypatch.setattr(dependency_hash, "PACKAGE", copied / "boatsim")
    effect = physics / "effects" / "by_dots.py"
    effect.write_text(
        "from .thruster import thrust_wrench_at_mount\nfrom ..noise import uniform_random\nfrom .. import particulars\n"
    )
    reached = dependency_hash.imported_files(effect)
    assert {
        physics / n for n in ("effects/thruster.py", "noise.py", "particulars.py", "signals.py")
    } <= reached
    assert physics / "effects" / "tether.py" not in reached


def test_a_controllers_compiled_law_is_known_by_all_that_it_reaches() -> None:
    law = content.content_root() / "controllers" / "pid_autopilot.py"
    home = content.content_root() / "boatsim"
    needed = ("control/allocation.py", "control/compiled.py", "physics/kernel/compiling.py")
    assert {law, *(home / n for n in needed)} <= dependency_hash.imported_files(law)
    assert content.load_class(
        "controller", "pid_autopilot"
    ).law._cache._cache_file._source_stamp == dependency_hash.dependency_digest(law)


@pytest.mark.slow
def test_an_edited_constant_gives_its_new_force(tmp_path: Path, copied: Path) -> None:
    """GRAVITY goes into the law at compile time: what was compiled before must not answer."""
    source, found = copied / "boatsim" / "physics" / "particulars.py", {}
    text = source.read_text()
    place = boats.written(tmp_path, "weighty", boats.ROLL + '[[effect]]\nuse = "weight"\n')
    (place / "weight.py").write_text(
        SPRING.replace("Spring", "Weight")
        .replace("-3.0", "-particulars.GRAVITY")
        .replace(IMPORT, GRAVITY)
    )
    try:
        for gravity in (9.81, 19.62):
            source.write_text(text.replace("GRAVITY = 9.81", f"GRAVITY = {gravity}"))
            found[gravity] = moment(
                place, {"PYTHONPATH": str(copied), "BOATSIM_CACHE": str(tmp_path / "cache")}
            )
    finally:
        source.write_text(text)
    assert found == {g: pytest.approx(-0.1 * (2.0 + g)) for g in (9.81, 19.62)}
