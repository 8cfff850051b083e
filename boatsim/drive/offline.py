"""The driver's page without a server: the vessel's program is WebAssembly inside the page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from boatsim.drive.driver_input import DEAD, STEPS
from boatsim.drive.page import OFFLINE, SCRIPT, drive_page
from boatsim.drive.session import scene_of
from boatsim.drive.stick_mapping import DIGITS
from boatsim.drive.task import DriveTask
from boatsim.drive.telemetry import PageData
from boatsim.errors import BadInput
from boatsim.files import MAX_TOML_BYTES, replace_file
from boatsim.physics.base import Array, Force
from boatsim.physics.signals import AXES, COMPONENTS, MeasuredMotion, motion_signals
from boatsim.simulate.engine import State
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run import build_engine
from boatsim.simulate.run_end import TIME_TOLERANCE
from boatsim.simulate.scenario import OFF
from boatsim.view.scene import Scene
from boatsim.webassembly.compiler import WasmCompiler
from boatsim.webassembly.packing import LOADER, MOST_BYTES, PackedNumbers
from boatsim.webassembly.program import compile_driving_program

ACTUAL = "actual_"  # prefix of the columns of actuators


def write_offline_page(task: DriveTask, path: Path, compiler: WasmCompiler) -> int:
    """Write a page in which a vessel is simulated and driven without a server.

    Args:
        task: Task with `offline`.
        path: The HTML file, which is written completely or not at all.
        compiler: A compiler for WebAssembly.

    Returns:
        Its size [bytes].

    Raises:
        BadInput: The path is a folder, or the page would be larger than `MOST_BYTES`.
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
        OSError: The file cannot be written.
    """
    if path.is_dir():
        raise BadInput(f"{path} is a folder; --offline needs the name of a file, such as page.html")
    content = offline_page(task, compiler).encode()
    if len(content) > MOST_BYTES:
        raise BadInput(
            f"{task.vessel.name}: the offline page would have {len(content):,} bytes; allowed are "
            f"{MOST_BYTES:,}"
        )
    with replace_file(path) as temporary:
        temporary.write_bytes(content)
    return len(content)


def offline_page(task: DriveTask, compiler: WasmCompiler) -> str:
    """Return the HTML text of a page in which a vessel is simulated and driven without a server.

    Args:
        task: Task with `offline`.
        compiler: A compiler for WebAssembly.

    Raises:
        NotTranslatable: A law has no C form.
        NoWasmCompiler: The compiler fails.
    """
    scene, numbers = scene_of(task.scenario), PackedNumbers()
    engine, wind = engine_at_start(task), _engine_of_wind(task)
    program = compile_driving_program(engine.program, compiler, wind.program if wind else None)
    content = {
        "hello": PageData(scene, task.dials, task.scenario).initial_data(ready=True),
        "simulation": {
            **_simulation(task, engine, scene, numbers),
            **_recorded(task, engine, wind is not None),
            **_sticks(task),
            "wind": None if wind is None else _places_of_wind(wind, numbers),
            "program": numbers.place_program(program),
        },
    }
    text = json.dumps(content, allow_nan=False).replace("<", "\\u003c")
    data = (
        f'<script type="application/json" id="model">{text}</script>\n'
        f'<script type="text/plain" id="numbers">{numbers.text}</script>\n'
    )
    page = drive_page(LOADER, SCRIPT, OFFLINE)
    return page.text(page.policy(" 'wasm-unsafe-eval'"), data)


def engine_at_start(task: DriveTask) -> OpenWater:
    """Return the compiled engine of a task with the vessel at its start.

    Args:
        task: Task with `offline`.
    """
    engine = build_engine(task.scenario)
    assert isinstance(engine, OpenWater)
    start = task.scenario.file.start
    commands = {**task.scenario.controller.initial_commands(), **start.commands}
    engine.reset(State(**start.initial_state_values()), commands)
    return engine


def _engine_of_wind(task: DriveTask) -> OpenWater | None:
    """Return an engine of the vessel with its effects of air alone; None if it has none."""
    vessel = task.scenario.vessel
    effects = [e for e in vessel.effects if isinstance(e, Force) and type(e).of_air]
    if not effects:
        return None
    seeded = tuple(effect.with_seed(task.scenario.file.seed) for effect in effects)
    return OpenWater(replace(vessel, effects=seeded), task.scenario.file.step)


def _places_of_wind(wind: OpenWater, numbers: PackedNumbers) -> list[tuple[int, int]]:
    """Return the places of the arrays that `place_wind` of the program takes."""
    fleet = wind.batch.fleet
    return [numbers.place(array) for array in (fleet.act, fleet.p, fleet.on)]


def _simulation(
    task: DriveTask, engine: OpenWater, scene: Scene, numbers: PackedNumbers
) -> dict[str, object]:
    """Return what the script needs to simulate the vessel."""
    vessel, file = engine.vessel, task.scenario.file
    arrays: dict[str, Array] = {**engine.batch.fleet._asdict()}
    order = list(arrays)
    arrays["actuators"] = np.array(list(engine.actuators.values()))
    limits = vessel.limits()
    channels = []
    for name, channel in vessel.commands.items():
        low, high = limits[name]
        channels.append({"name": name, "low": low, "high": high, "neutral": channel.neutral})
    return {
        "step": file.step,
        "period": task.scenario.controller.period,
        "duration": file.duration,
        "tolerance": TIME_TOLERANCE,
        "arrays": {name: numbers.place(array) for name, array in arrays.items()},
        "order": order,
        "channels": channels,
        "arrows": _arrows(scene, vessel.actuators),
        "scenario": task.scenario_around_goals(),
        "most_bytes": MAX_TOML_BYTES,
        "off": OFF,
    }


def _recorded(task: DriveTask, engine: OpenWater, wind: bool) -> dict[str, object]:
    """Return what the script needs to record the run, with the columns of `boatsim run`.

    `observed` are the values that the program writes; `motion` and `forces` are the places of those
    that the recording has.
    """
    vessel, motion = engine.vessel, MeasuredMotion._fields
    signals = motion_signals(vessel.dof)
    forces = [f"force_{COMPONENTS[axis]}" for axis in AXES if axis in vessel.dof]
    if wind:
        forces += [force.replace("force_", "wind_") for force in forces]
    columns = ["t_s", *(signal.column for signal in signals), *vessel.commands, *vessel.measured]
    columns += map("sent_{}".format, vessel.commands)
    columns += map(f"{ACTUAL}{{}}".format, vessel.actuators)
    return {
        "log": task.scenario.file.log,
        "columns": [*columns, *forces],
        "observed": [*motion, *forces],
        "motion": [motion.index(signal.symbol) for signal in signals],
        "forces": list(range(len(motion), len(motion) + len(forces))),
    }


def _arrows(scene: Scene, actuators: Sequence[str]) -> list[list[int]]:
    """Return the places of each thruster's thrust and angle among the actuators; -1 for none."""
    places: Mapping[str, int] = {f"{ACTUAL}{name}": i for i, name in enumerate(actuators)}
    found = []
    for thruster in scene.thrusters:
        found.append([places.get(thruster.thrust, -1), places.get(thruster.steer, -1)])
    return found


def _sticks(task: DriveTask) -> dict[str, object]:
    """Return how sticks become commands; see `apply_dead_zone` and `StickMappings`."""
    return {
        "dead": DEAD,
        "steps": STEPS,
        "digits": DIGITS,
        "dials": [dial._asdict() for dial in task.dials.dials],
        "neutral": dict(task.dials.neutral),
        "limits": {key: list(ends) for key, ends in task.dials.limits.items()},
    }
