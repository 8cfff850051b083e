"""Batches on Warp's CPU device: the twin's laws, the water's mass in MuJoCo's matrix, each boat its
own."""

import sys
from collections.abc import Callable
from pathlib import Path

import boats
import numpy as np
import pytest
from alike import long

pytest.importorskip("warp")
pytest.importorskip("mujoco_warp")

from benchmarks import gpu
from boatsim.diagnosis.candidates import candidate_library
from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.physics.trust import trust_folders
from boatsim.physics.vessel import Vessel
from boatsim.simulate import batch as cores
from boatsim.warp import Batch
from boatsim.warp.kernels import HEAD
from boatsim.warp.on_mujoco import MujocoMotion
from boatsim.warp.program import import_program, import_text
from boatsim.warp.runtime import import_warp
from boatsim.warp.translate import Translation
from boatsim.warp.values import REAL, ROW, WHOLE

CURRENT = Path(__file__).parents[1] / "data" / "current.csv"
MODELS = sorted(path.parent.name for path in Path("models").glob("*/vessel.toml"))
KINDS = (  # vessels whose degrees of freedom, hulls and drives all differ
    "catamaran",
    "eastward_ho",
    "jet_ski",
    "kvlcc2_mmg",
    "mariner",
    "osv",
    "otter",
    "pendulum",
)
SECONDS, STEP = 10, 0.02
WIDEST = 1e3  # of a command
# A pendulum on its upper dead point multiplies the rounding of single precision
RANGE = {"torque_Nm": (-0.3, 0.3)}  # below the moment of its weight
CHECK = """
@wp.kernel
def check(
    t: wp.array(dtype=T), s: wp.array2d(dtype=T), act: wp.array2d(dtype=T), p: wp.array2d(dtype=T),
    on: wp.array2d(dtype=T), commands: wp.array2d(dtype=T), memory: wp.array2d(dtype=T), moved: wp.array2d(dtype=T),
    pauses: wp.array(dtype=T), force: wp.array2d(dtype=T),
):
    i = wp.tid()
    X, Y, N = motion_total_body_force(t[i], s[i], act[i], 0, p[i], on[i])
    force[i, 0] = X
    force[i, 1] = Y
    force[i, 2] = N
    pauses[i] = run_substep_length(commands[i], memory[i], T(0.02), T(1e-6), p[i], on[i])
    run_advance_actuators(commands[i], memory[i], T(0.02), p[i], on[i], moved[i])
"""


def drawn_commands(boat: Vessel, shape: tuple[int, ...], seed: int = 1) -> Array:
    """(..., C) commands anywhere in their ranges."""
    limits = [RANGE.get(name, limits) for name, limits in boat.limits().items()]
    ranges = np.clip(np.array(limits).reshape(-1, 2), -WIDEST, WIDEST)
    return np.random.default_rng(seed).uniform(ranges[:, 0], ranges[:, 1], (*shape, len(ranges)))


def drawn_starts(boat: Vessel, n: int) -> Array:
    """(n, 2 NQ) near the origin, moving."""
    return np.random.default_rng(2).uniform(-0.3, 0.3, (n, 2 * len(boat.dof)))


def sailed(batch: Batch, starts: Array, commands: Array) -> Array:
    """States (rows + 1, n, 2 NQ) once a second, each row of commands (rows, n, C) held for one."""
    batch.reset(starts, commands[0])
    found = [batch.states]
    for row in commands:
        batch.advance(row, round(1.0 / batch.step))
        found.append(batch.states)
    return np.array(found)


def furthest(batch: Batch, boats_there: int) -> float:
    """Largest difference to the twin over ten seconds, each state by its largest size."""
    boat = batch.vessels[0]
    starts, commands = drawn_starts(boat, batch.n), drawn_commands(boat, (SECONDS, batch.n))
    found = sailed(batch, starts, commands)[:, :boats_there]
    compiled_engine = cores.Batch(boat, step=batch.step)
    wanted = np.stack(
        [compiled_engine.rollout(starts[i], commands[:, i], 1.0) for i in range(boats_there)],
        axis=1,
    )
    return float((np.abs(found - wanted) / np.abs(wanted).max(axis=(0, 1))).max())


def test_a_batch_on_mujoco_goes_as_the_twin() -> None:
    assert furthest(Batch(vessel.load_vessel("joystick_boat"), 1000), 50) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n in KINDS else long(n) for n in MODELS])
def test_a_thousand_boats_of_any_vessel_go_as_the_twin(name: str) -> None:
    assert furthest(Batch(vessel.load_vessel(name), 1000), 1000) < 1e-4


@pytest.mark.parametrize("double", [False, True])
def test_a_batch_without_mujoco_goes_as_the_twin(double: bool) -> None:
    batch = Batch(vessel.load_vessel("joystick_boat"), 100, mujoco=False, double=double)
    assert furthest(batch, 100) < (1e-9 if double else 1e-4)


@pytest.mark.parametrize("mujoco", [False, True])
def test_boats_in_the_current_of_a_table_go_as_the_twin(mujoco: bool) -> None:
    table = {"use": "current_table", "file": str(CURRENT), "start": 1.5}
    boat = vessel.load_vessel("joystick_boat").with_effect(table)
    batch = Batch(boat, 100, mujoco=mujoco, double=not mujoco)
    assert furthest(batch, 100) < (1e-4 if mujoco else 1e-9)


def test_accelerations_are_the_forces_by_the_whole_mass(tmp_path: Path) -> None:
    """Water with a centre ahead of the origin: M nu' = thrust, at rest on any heading."""
    boat = boats.planar(tmp_path, {"added_mass": {"sway_at": 0.2}})
    batch = Batch(boat, 3)
    headings, pushed = (0.0, 0.7, -2.0), (4.0, 0.5)  # [rad], [N] ahead, [N m]
    commands = {**boats.push(*pushed), "steer_port_rad": 0.6, "steer_starboard_rad": 0.6}
    batch.reset([(0, 0, psi, 0, 0, 0) for psi in headings], [[commands[c] for c in boat.commands]])
    c, s = np.cos(0.6), np.sin(0.6)
    force = np.array([pushed[0] * c, pushed[0] * s, pushed[1] * c])
    M = np.array(
        [[6.0 + 0.6, 0, 0], [0, 6.0 + 3.0, 3.0 * 0.2], [0, 3.0 * 0.2, 0.5 + 0.3 + 3.0 * 0.2**2]]
    )
    ahead, aside, turning = np.linalg.solve(M, force)
    batch.copy_inputs_to_device()
    assert isinstance(batch.motion, MujocoMotion)
    for psi, found in zip(headings, batch.motion.accelerations(), strict=True):
        turned = (
            np.cos(psi) * ahead - np.sin(psi) * aside,
            np.sin(psi) * ahead + np.cos(psi) * aside,
            turning,
        )
        assert found == pytest.approx(turned, rel=1e-5, abs=1e-6)


def test_the_whole_library_has_the_same_forces_and_actuators() -> None:
    """All that a diagnosis may find on a boat, described laws with it: to rounding in double
    precision."""
    boat, n, rng = vessel.load_vessel("joystick_boat"), 200, np.random.default_rng(3)
    program = Program(boat, candidate_library(boat).compiled_effects)
    code, own = program.module, len(boat.effects)
    values = np.tile(program.values(), (n, 1))
    for effect, first in zip(program.effects[own:], program.offsets[own:], strict=True):
        for j, about in enumerate(type(effect).params().values()):
            if about.fit:
                values[:, first + j] += rng.uniform(0.0, 0.1, n) * min(1.0, about.high)
    on = (rng.uniform(size=(n, len(program.effects))) < 0.5).astype(float)
    on[:, :own] = 1.0
    s, act = (
        rng.uniform(-0.5, 0.5, (n, 6)),
        rng.uniform(-1.0, 1.0, (n, program.actuator_signal_size)),
    )
    t, commands = rng.uniform(0.0, 10.0, n), drawn_commands(boat, (n,))
    memory, moved, pauses = (
        np.zeros((n, program.memory_size)),
        np.zeros((n, program.actuator_signal_size)),
        np.zeros(n),
    )

    translation = Translation()
    translation.translate_function(code.total_body_force, [REAL, ROW, ROW, WHOLE, ROW, ROW])
    translation.translate_function(code.substep_length, [ROW, ROW, REAL, REAL, ROW, ROW])
    translation.translate_function(code.advance_actuators, [ROW, ROW, REAL, ROW, ROW, ROW])
    wp, kernels = (
        import_warp(),
        import_text(HEAD.replace("{real}", "float64") + translation.text + CHECK),
    )
    there = [
        wp.array(x, dtype=wp.float64)
        for x in (t, s, act, values, on, commands, memory, moved, pauses, s[:, :3])
    ]
    wp.launch(kernels.check, dim=n, inputs=there, device="cpu")

    force = [
        code.total_body_force(t[i], s[i], act[i], np.int64(0), values[i], on[i]) for i in range(n)
    ]
    for i in range(n):
        pauses[i] = code.substep_length(commands[i], memory[i], 0.02, 1e-6, values[i], on[i])
        code.advance_actuators(commands[i], memory[i], 0.02, values[i], on[i], moved[i])
    for found, wanted in zip(there[-4:], (memory, moved, pauses, np.array(force)), strict=True):
        assert np.abs(wanted).max() > 1e-3
        assert found.numpy() == pytest.approx(wanted, rel=1e-9, abs=1e-9)


@pytest.fixture(scope="module")
def batch() -> Batch:
    """Five boats, which tests put back to where they begin."""
    return Batch(vessel.load_vessel("joystick_boat"), 5)


@pytest.mark.parametrize("mujoco", [True, False])
def test_all_calls_do_what_they_do_on_cores(mujoco: bool) -> None:
    """Parameters, resets of some boats, another load, commands by name: a batch on cores beside
    that of a device."""
    boats_there = [vessel.load_vessel("joystick_boat", [load]) for load in ("light", "heavy")]
    there, here = Batch(boats_there, 5, mujoco=mujoco), cores.Batch(boats_there, 5)
    commands, starts = drawn_commands(boats_there[0], (5,)), drawn_starts(boats_there[0], 5)
    for batch in (there, here):
        batch.reset(starts, commands)
        batch.set("surge_drag.linear", [0.1, 0.2, 0.3, 0.4, 0.5])
        batch.advance(commands[::-1], 20)
        batch.reset(starts[0], boats=[1, 3])
        batch.assign(0, boats=[4])
        batch.advance({"pwm_port": 100.0, "steer_port_rad": 0.3}, 17)
        batch.set("surge_drag.quadratic", 1.0, boats=[0])
        batch.advance(steps=3)
    assert there.t.tolist() == here.t.tolist()
    assert there.states == pytest.approx(here.states, rel=1e-4, abs=1e-5)
    assert there.actuators == pytest.approx(here.actuators, rel=1e-4, abs=1e-5)
    assert len(np.unique(here.states[:, 0].round(4))) == 5  # no two alike


def test_what_comes_in_two_calls_is_what_comes_in_one(batch: Batch) -> None:
    commands, starts = drawn_commands(batch.vessels[0], (5,)), drawn_starts(batch.vessels[0], 5)
    batch.reset(starts)
    batch.advance(commands, 30)
    at_once = batch.states
    batch.reset(starts)
    batch.advance(commands, 13)
    batch.advance(steps=17)
    assert batch.states.tolist() == at_once.tolist()


@pytest.mark.parametrize(
    ("does", "says"),
    [
        (lambda f: f.advance([[1.0]]), "commands of shape (1, 1); allowed are 6 a boat"),
        (
            lambda f: f.reset([1.0, 2.0]),
            "states of shape (2,); allowed are 6 finite numbers a boat",
        ),
        (lambda f: f.set("surge_drag.liner", 1.0), "did you mean 'surge_drag.linear'"),
        (lambda f: f.set("surge_drag.linear", -1.0), "surge_drag.linear = -1; allowed 0 to"),
        (lambda f: Batch(f.vessels[0], 2, device="moon"), "device = 'moon'; allowed here: cpu"),
        (lambda f: Batch(f.vessels[0], 2, double=True), "mujoco_warp has single precision only"),
        (
            lambda f: Batch(
                vessel.load_vessel("kynoc", settings={"filtered_sea": {"realisation": 2**24 + 1}}),
                2,
            ),
            "allowed to",
        ),
    ],
)
def test_a_mistake_is_named_in_one_line(
    batch: Batch, does: Callable[[Batch], object], says: str
) -> None:
    with pytest.raises(BadInput) as caught:
        does(batch)
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_an_effect_that_has_no_form_there_is_named_with_its_line(tmp_path: Path) -> None:
    law = (
        "from dataclasses import dataclass\nfrom typing import ClassVar\nimport numpy as np\nfrom numba import njit\n"
        "from boatsim.physics.base import Force, param, wrench\n\n\n"
        '@njit(inline="always")\ndef law(m, q):\n    return wrench(X=q.gain * np.zeros(3).sum())\n\n\n'
        "@dataclass(frozen=True)\nclass Odd(Force):\n"
        '    """Odd."""\n\n    words: ClassVar[str] = "it is odd"\n    shown_by: ClassVar[str] = "nothing"\n'
        '    law: ClassVar = law\n\n    gain: float = param(1.0, low=0.0, high=2.0, unit="N", words="how odd")\n'
    )
    place = boats.written(tmp_path, "odd_boat", boats.PLANAR + '\n[[effect]]\nuse = "odd.py"\n')
    (place / "odd.py").write_text(law)
    with (
        trust_folders(allowed=[tmp_path]),
        pytest.raises(BadInput, match=r"odd_boat: .*odd.py:10: .* has no Warp form"),
    ):
        Batch(vessel.load_vessel(str(place)), 2)


@pytest.mark.parametrize("missing", ["warp", "mujoco_warp"])
def test_without_the_libraries_one_line_says_what_brings_them(
    missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, missing, None)
    with pytest.raises(BadInput, match=r'pip install "boatsim\[warp\]"'):
        Batch(vessel.load_vessel("joystick_boat"), 2)


@pytest.mark.parametrize("name", ["joystick_boat", "otter"])
def test_a_program_compiles_for_a_gpu_where_there_is_none(name: str, tmp_path: Path) -> None:
    import_warp().compile_aot_module(
        import_program(Program(vessel.load_vessel(name))), arch=90, module_dir=tmp_path
    )
    assert any(path.stat().st_size > 10_000 for path in tmp_path.glob("*.cubin"))


def test_the_benchmark_prints_a_rate_for_each_number_of_boats(
    capsys: pytest.CaptureFixture[str],
) -> None:
    gpu.main(["--vessel", "kvlcc2_roll", "--most", "10"])
    rows = [line.split() for line in capsys.readouterr().out.splitlines()[2:]]
    assert [row[0] for row in rows] == ["1", "10"]
    assert all(float(cell) > 0.0 for row in rows for cell in row[1:])
