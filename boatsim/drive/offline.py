"""The driver's page without a server: the vessel's program is WebAssembly inside the page."""

import json
from collections.abc import Mapping, Sequence
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
from boatsim.physics.base import Array
from boatsim.physics.signals import AXES, COMPONENTS, MeasuredMotion, motion_signals
from boatsim.simulate.control_loop import TIME_TOLERANCE
from boatsim.simulate.engine import State
from boatsim.simulate.open_water import OpenWater
from boatsim.simulate.run import build_engine
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
    engine = engine_at_start(task)
    content = {
        "hello": PageData(scene, task.dials, task.scenario).initial_data(ready=True),
        "simulation": {
            **_simulation(task, engine, scene, numbers),
            **_sticks(task),
            "program": numbers.place_program(compile_driving_program(engine.program, compiler)),
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


def _simulation(
    task: DriveTask, engine: OpenWater, scene: Scene, numbers: PackedNumbers
) -> dict[str, object]:
    """Return what the script needs to simulate the vessel and to record the run."""
    vessel, file = engine.vessel, task.scenario.file
    arrays: dict[str, Array] = {**engine.batch.fleet._asdict()}
    order = list(arrays)
    arrays["actuators"] = np.array(list(engine.actuators.values()))
    limits = vessel.limits()
    channels = []
    for name, channel in vessel.commands.items():
        low, high = limits[name]
        channels.append({"name": name, "low": low, "high": high, "neutral": channel.neutral})
    signals = motion_signals(vessel.dof)
    forces = [f"force_{COMPONENTS[axis]}" for axis in AXES if axis in vessel.dof]
    columns = ["t_s", *(signal.column for signal in signals), *vessel.commands, *vessel.measured]
    columns += map("sent_{}".format, vessel.commands)
    columns += map(f"{ACTUAL}{{}}".format, vessel.actuators)
    columns += forces
    return {
        "step": file.step,
        "period": task.scenario.controller.period,
        "log": file.log,
        "duration": file.duration,
        "tolerance": TIME_TOLERANCE,
        "arrays": {name: numbers.place(array) for name, array in arrays.items()},
        "order": order,
        "channels": channels,
        "motion": MeasuredMotion._fields,
        "shown": [MeasuredMotion._fields.index(signal.symbol) for signal in signals],
        "forces": forces,
        "columns": columns,
        "arrows": _arrows(scene, vessel.actuators),
        "scenario": task.scenario_around_goals(),
        "most_bytes": MAX_TOML_BYTES,
        "off": OFF,
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
