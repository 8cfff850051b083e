"""Sensors of an FMU have the errors, rates and delays of those of `boatsim run` with that seed."""

import ctypes
import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.errors import BadInput
from boatsim.fmu.archive import text_files, write_fmu
from boatsim.fmu.sensors import SensorSuite, sensor_variables
from boatsim.fmu.source import interface_source
from boatsim.fmu.surroundings import with_surroundings
from boatsim.fmu.variables import vessel_variables
from boatsim.fmu.ziggurat import ziggurat_source
from boatsim.physics.native.build import NoCompiler, compiler_path
from boatsim.physics.program import Program
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.run import run
from boatsim.simulate.scenario import Scenario

pytest.importorskip("fmpy")
from fmu_instance import opened  # noqa: E402

try:
    COMPILER = compiler_path()
except NoCompiler:
    pytest.skip("an FMU needs a C compiler", allow_module_level=True)

PERIOD = 0.06  # [s] of the controller: three integration steps
SECONDS = 30.0
SAME = 1e-9  # largest difference, in SI units
ABOARD: Sequence[Mapping[str, object]] = (
    {"use": "imu", "ahead": 0.3, "above": 0.2, "gyro_walk": 1e-3, "accelerometer_walk": 0.01},
    {"use": "gnss", "ahead": -0.2, "above": 1.0, "drift_time": 20.0, "outage_interval": 4.0,
     "outage_length": 1.5, "latency": 0.33},
    {"use": "dvl", "below": 0.4, "starboard": 0.1, "outage_interval": 3.0, "outage_length": 0.7},
    {"use": "compass", "compensation": "accelerometer"},
)  # fmt: skip
NOISY = {"speed_sd": 0.03, "position_sd": 0.4}


def measured(
    vessel: str,
    standard: Mapping[str, object],
    aboard: Sequence[Mapping[str, object]] = (),
    seed: int = 7,
) -> Scenario:
    """A scenario of a vessel whose commands change every second."""
    rng = np.random.default_rng(1)
    boat = load_vessel(vessel)
    goals = []
    for second in range(int(SECONDS)):
        goal: dict[str, float] = {"from": float(second)}
        for name, channel in boat.commands.items():
            goal[name] = float(rng.uniform(0.5 * channel.low, channel.high))
        goals.append(goal)
    return Scenario.from_settings(
        vessel=boat,
        controller={"use": "open_loop", "period": PERIOD},
        sensors=dict(standard),
        sensor=list(map(dict, aboard)),
        engine="compiled",
        duration=SECONDS,
        log=PERIOD,
        start={"u": 0.5},
        goal=goals,
        seed=seed,
    )


def fmu_of(scenario: Scenario, path: Path, version: str = "3") -> tuple[SensorSuite, Path]:
    """The FMU of the scenario's vessel with its sensors."""
    suite = SensorSuite.from_scenario(scenario)
    write_fmu(scenario.vessel, path, version, sensors=suite)
    return suite, path


def columns_of(suite: SensorSuite) -> list[str]:
    return [f"sensed_{column}" for column in suite.columns().values()]


def fmu_readings(
    scenario: Scenario, path: Path, names: Sequence[str], start: Mapping[str, float]
) -> np.ndarray:
    """Readings of the FMU under the commands of the scenario, at the times of its samples."""
    channels = list(scenario.vessel.commands)
    rows = []
    with opened(path) as boat:
        boat.start({"u_mps": 0.5, **start})
        rows.append(boat.get(*names))
        count = round(SECONDS / PERIOD)
        for i in range(count):
            goal = scenario.goal_at(i * PERIOD)
            boat.set({name: goal[name] for name in channels})
            boat.step(i * PERIOD, PERIOD)
            rows.append(boat.get(*names))
    return np.array(rows)


def run_readings(scenario: Scenario, names: Sequence[str], seed: int | None = None) -> np.ndarray:
    recording = run(scenario, seed).recording
    return np.array([recording[name] for name in names]).T


@pytest.mark.parametrize(
    ("name", "standard", "aboard", "version"),
    [
        ("trial_boat", {}, (), "3"),
        ("trial_boat", NOISY, ABOARD[1:2], "2"),
        pytest.param("otter", NOISY, ABOARD, "3", marks=pytest.mark.slow),
        pytest.param(
            "otter", {"ideal": True}, (ABOARD[3] | {"compensation": "none"},), "2",
            marks=pytest.mark.slow,
        ),
        pytest.param(
            "joystick_boat", {}, (ABOARD[3] | {"compensation": "exact"}, ABOARD[0]), "3",
            marks=pytest.mark.slow,
        ),
    ],
)  # fmt: skip
def test_readings_are_those_of_a_run_with_the_same_seed(
    name: str,
    standard: Mapping[str, object],
    aboard: Sequence[Mapping[str, object]],
    version: str,
    tmp_path: Path,
) -> None:
    scenario = measured(name, standard, aboard)
    suite, path = fmu_of(scenario, tmp_path / "boat.fmu", version)
    names = columns_of(suite)
    found = fmu_readings(scenario, path, names, {})
    expected = run_readings(scenario, names)
    assert len(found) == len(expected) == round(SECONDS / PERIOD) + 1
    np.testing.assert_allclose(found, expected, rtol=SAME, atol=SAME)
    if any("outage_interval" in table for table in aboard):
        assert np.isnan(found).any()  # outages, which agree too


def test_the_seed_is_a_parameter_and_so_are_the_sizes_of_the_errors(tmp_path: Path) -> None:
    scenario = measured("trial_boat", {})
    suite, path = fmu_of(scenario, tmp_path / "boat.fmu")
    names = columns_of(suite)
    others = fmu_readings(scenario, path, names, {"sensors.seed": 2.0**40 + 11})
    expected = run_readings(scenario, names, seed=2**40 + 11)
    np.testing.assert_allclose(others, expected, rtol=SAME, atol=SAME)
    assert np.abs(others - run_readings(scenario, names)).max() > 1e-3
    noisier = {"sensors.gyro_sd": 0.05, "sensors.gyro_bias": -0.1}
    found = fmu_readings(scenario, path, names, noisier)
    changed = measured("trial_boat", {"gyro_sd": 0.05, "gyro_bias": -0.1})
    np.testing.assert_allclose(found, run_readings(changed, names), rtol=SAME, atol=SAME)


@pytest.mark.parametrize("version", ["3", pytest.param("2", marks=pytest.mark.slow)])
def test_a_stored_state_is_continued_with_the_same_errors(version: str, tmp_path: Path) -> None:
    scenario = measured("trial_boat", NOISY, ABOARD[:2])
    suite, path = fmu_of(scenario, tmp_path / "boat.fmu", version)
    names = columns_of(suite)

    def continue_run(boat) -> list[list[float]]:
        rows = []
        for i in range(20, 40):
            boat.step(i * PERIOD, PERIOD)
            rows.append(boat.get(*names))
        return rows

    with opened(path) as boat, opened(path) as other:
        boat.start()
        other.start({"sensors.seed": 99.0})
        for i in range(20):
            boat.step(i * PERIOD, PERIOD)
        state, content = boat.states()
        first = continue_run(boat)
        boat.restore(state)
        np.testing.assert_array_equal(continue_run(boat), first)
        other.restore(other.from_bytes(content))
        np.testing.assert_array_equal(continue_run(other), first)


def test_readings_are_held_between_two_samples(tmp_path: Path) -> None:
    scenario = measured("trial_boat", {})
    suite, path = fmu_of(scenario, tmp_path / "boat.fmu")
    names = columns_of(suite)
    with opened(path) as boat:
        boat.start({"u_mps": 0.5})
        before = boat.get(*names)
        boat.step(0.0, 0.04)
        assert boat.get(*names) == before
        boat.step(0.04, 0.02)
        assert boat.get(*names) != before


@pytest.mark.parametrize("time", [-5.0, 1e6])
def test_sensors_count_from_the_start_of_the_simulation(time: float, tmp_path: Path) -> None:
    suite, path = fmu_of(measured("trial_boat", NOISY, ABOARD), tmp_path / "boat.fmu")
    found = []
    for start in (0.0, time):
        rows = []
        with opened(path) as boat:
            boat.start({"u_mps": 0.5}, start)
            for i in range(100):
                rows.append(boat.get(*columns_of(suite)))
                boat.step(start + i * PERIOD, PERIOD)
        found.append(rows)
    np.testing.assert_allclose(found[1], found[0], atol=1e-6)


def test_no_sample_is_late_where_times_are_rounded(tmp_path: Path) -> None:
    suite, path = fmu_of(measured("trial_boat", {}), tmp_path / "boat.fmu")
    names = columns_of(suite)
    now, step = 2e5, 0.02  # [s]; the rounding error of a time grows by up to 1.5e-11 s per step
    sampled = []
    with opened(path) as boat:
        boat.start({"u_mps": 0.5}, now)
        last = boat.get(*names)
        for _ in range(300):
            boat.step(now, step)
            now += step
            sampled.append(boat.get(*names) != last)
            last = boat.get(*names)
    assert sampled == [False, False, True] * 100


def test_a_step_longer_than_the_control_period_is_refused(tmp_path: Path) -> None:
    scenario = measured("trial_boat", {})
    suite = SensorSuite.from_scenario(scenario)
    message = f"--step = 1 s; allowed are at most the control period 0.06 s of {scenario.name}"
    with pytest.raises(BadInput) as refused:
        write_fmu(scenario.vessel, tmp_path / "boat.fmu", step=1.0, sensors=suite)
    assert str(refused.value) == message
    write_fmu(scenario.vessel, tmp_path / "boat.fmu", step=PERIOD, sensors=suite)


def test_a_wrong_seed_and_a_late_one_are_refused(tmp_path: Path) -> None:
    _, path = fmu_of(measured("trial_boat", {}), tmp_path / "boat.fmu")
    with opened(path) as boat:
        with pytest.raises(Exception, match="fmi3Error|status"):
            boat.set({"sensors.seed": 1.5})
        assert boat.messages[-1] == "sensors.seed = 1.5; allowed are whole numbers"
        boat.start()
        with pytest.raises(Exception, match="fmi3Error|status"):
            boat.set({"sensors.seed": 2.0})
        assert boat.messages[-1] == "sensors.seed can be set before the start only"


@pytest.mark.parametrize("version", ["3", "2"])
def test_the_description_with_sensors_is_valid(version: str, tmp_path: Path) -> None:
    validation = pytest.importorskip("fmpy.validation")
    scenario = measured("trial_boat", NOISY, ABOARD)
    program = Program(with_surroundings(scenario.vessel))
    suite = SensorSuite.from_scenario(scenario)
    variables = vessel_variables(program, sensor_variables(suite))
    files = text_files(program, variables, version, 0.02, suite)
    (tmp_path / "modelDescription.xml").write_text(files["modelDescription.xml"])
    assert validation.validate_fmu(str(tmp_path)) == []


@pytest.mark.parametrize("version", ["3", "2"])
def test_the_source_compiles_by_itself_without_warnings(version: str, tmp_path: Path) -> None:
    scenario = measured("trial_boat", NOISY, ABOARD)
    program = Program(with_surroundings(scenario.vessel))
    suite = SensorSuite.from_scenario(scenario)
    variables = vessel_variables(program, sensor_variables(suite))
    for name, text in text_files(program, variables, version, 0.02, suite).items():
        (tmp_path / Path(name).name).write_text(text)
    done = subprocess.run(
        [
            COMPILER, "-std=gnu11", "-Wall", "-Wextra", "-Wno-unused", "-fsyntax-only",
            "-Wno-unused-parameter", f"fmi{version}.c",
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )  # fmt: skip
    assert done.stderr == ""


def test_model_exchange_takes_samples_at_events(tmp_path: Path) -> None:
    import fmpy

    scenario = measured("trial_boat", {})
    suite, path = fmu_of(scenario, tmp_path / "boat.fmu")
    names = columns_of(suite)
    start = {name: channel.high / 3 for name, channel in scenario.vessel.commands.items()}
    results = []
    for kind in ("CoSimulation", "ModelExchange"):
        found = fmpy.simulate_fmu(
            str(path),
            fmi_type=kind,
            start_values=start,
            stop_time=3.0,
            output_interval=PERIOD,
            relative_tolerance=1e-9,
            output=names,
        )
        times = found["time"]
        last = {round(t / PERIOD, 4): i for i, t in enumerate(times.tolist())}
        rows = [last[float(k)] for k in range(round(3.0 / PERIOD))]
        results.append(np.array([found[name][rows] for name in names]))
    # at an event FMPy records the values after it
    np.testing.assert_allclose(results[1], results[0], atol=1e-5)


def test_a_sensor_without_a_form_in_c_is_refused_by_name() -> None:
    scenario = measured("trial_boat", {}, ({"use": "echo_sounder"},))
    with pytest.raises(BadInput, match="takes no sensor 'echo_sounder'; allowed are imu, compass"):
        SensorSuite.from_scenario(scenario)


def test_the_command_takes_the_sensors_of_a_scenario(tmp_path: Path) -> None:
    out = tmp_path / "boat.fmu"
    done = CliRunner().invoke(
        app, ["export", "fmu", "trial_boat", "--sensors", "joystick_boat/sway_1", "--out", str(out)]
    )
    assert done.exit_code == 0, done.output
    with opened(out) as boat:
        boat.start()
        assert boat.get("sensors.gyro_sd") == [0.00175]
    done = CliRunner().invoke(app, ["export", "fmu", "trial_boat", "--sensors", "nowhere/at_all"])
    assert done.exit_code == 2


Draw = Callable[[int, tuple[int, ...], int, int], np.ndarray]


@pytest.fixture(scope="module")
def draw(tmp_path_factory: pytest.TempPathFactory) -> Draw:
    """Random numbers of the C source: seed, key, kind (normal, exponential, uniform), count."""
    folder = tmp_path_factory.mktemp("random")
    source = [
        "#include <math.h>\n#include <stdbool.h>\n#include <stdint.h>",
        "#define INLINE static inline",
        ziggurat_source(),
        interface_source("random.h"),
        "void draw(uint64_t seed, const uint32_t *key, int n, int kind, int count, double *out) {",
        "    generator_t g = seeded_generator(seed, key, n);",
        "    for (int i = 0; i < count; i++)",
        "        out[i] = kind == 0 ? random_normal(&g) : kind == 1 ? random_exponential(&g)",
        "                                                : random_uniform(&g);",
        "}",
    ]
    (folder / "draw.c").write_text("\n".join(source))
    command = [COMPILER, "-O2", "-shared", "-fPIC", "-o", "draw.so", "draw.c", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "draw.so"))

    def numbers(seed: int, key: tuple[int, ...], kind: int, count: int) -> np.ndarray:
        out = np.zeros(count)
        words = (ctypes.c_uint32 * len(key))(*key)
        address = out.ctypes.data_as(ctypes.c_void_p)
        library.draw(ctypes.c_uint64(seed), words, len(key), kind, count, address)
        return out

    return numbers


@pytest.mark.parametrize(("seed", "key"), [(0, (0,)), (7, (2, 1)), (2**52 + 3, (5,))])
def test_random_numbers_are_those_of_numpy(seed: int, key: tuple[int, ...], draw: Draw) -> None:
    count = 300_000  # with some hundred numbers of the tails
    for kind, name in enumerate(("standard_normal", "standard_exponential", "random")):
        rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
        expected = getattr(rng, name)(count)
        np.testing.assert_allclose(draw(seed, key, kind, count), expected, rtol=0, atol=1e-14)


def test_random_numbers_have_their_distributions(draw: Draw) -> None:
    for kind, law in enumerate((stats.norm, stats.expon, stats.uniform)):
        assert stats.kstest(draw(3, (1,), kind, 100_000), law.cdf).pvalue > 1e-3
