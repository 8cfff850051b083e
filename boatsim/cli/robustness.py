"""Implementation of `boatsim robustness`: the largest disturbances that drawn boats survive."""

from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import Exit, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.cli.progress import show_task_progress
from boatsim.control.base import Controller
from boatsim.errors import BadInput
from boatsim.learn.distributions import SampledParameter, make_sampled_parameter
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.sweeps.robustness.benchmark import run_benchmark
from boatsim.sweeps.robustness.files import CSV, JSON, write_csv, write_json
from boatsim.sweeps.robustness.page import NAME, write_page
from boatsim.sweeps.robustness.tables import notes, result_tables


def measure_robustness(
    controllers: Sequence[str],
    vessel: str,
    loads: Sequence[str],
    boats: int,
    seed: int,
    draws: Sequence[str],
    spread: float,
    disturbances: Sequence[str],
    out: Path,
) -> int:
    """Run a robustness benchmark, print its tables and write its files.

    Args:
        controllers: Names of controllers, or paths of .py files, with changed parameters:
            `NAME,KEY=VALUE,...`.
        vessel: Name or path of a vessel.
        loads: Load conditions.
        boats: Number of drawn boats.
        seed: Random seed.
        draws: Sampled parameters, `KEY=DISTRIBUTION(...)`.
        spread: Factor of the standard deviations of the usual draws.
        disturbances: `NAME` or `NAME=VALUE,VALUE,...`; empty for all.
        out: Output folder.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong.
    """
    made: dict[str, Controller] = {}
    for text in controllers:
        name, controller = make_controller(text)
        if name in made:
            raise BadInput(f"controller {name} is given twice; allowed is once")
        made[name] = controller
    boat = load_vessel(vessel, loads)
    sampled = [parse_draw(text) for text in draws]
    ladders = dict(parse_ladder(text) for text in disturbances)
    with show_task_progress() as report:
        found = run_benchmark(made, boat, boats, seed, sampled, spread, ladders, report)
    for table in result_tables(found):
        print_text_table(table.title, table.head, table.rows, table.left)
    print_lines(notes(found))
    with atomic_folder(out) as folder:
        write_csv(found, folder)
        write_json(found, folder)
        write_page(found, folder)
    print_lines([f"written to {out}: {CSV}, {JSON}, {NAME}"])
    return Exit.MET


def make_controller(text: str) -> tuple[str, Controller]:
    """Return the name in the tables and the controller of NAME,KEY=VALUE,...

    Args:
        text: Name of a controller, or path of a .py file, with changed parameters.

    Raises:
        BadInput: The controller or a parameter does not exist, or a value is not allowed.
    """
    name, *settings = text.split(",")
    values: dict[str, object] = {}
    for setting in settings:
        key, equals, number = setting.partition("=")
        try:
            values[key.strip()] = _parse_value(number.strip())
        except ValueError:
            equals = ""
        if not equals:
            raise BadInput(
                f"controller {text}: {setting!r} is no parameter; allowed is NAME,KEY=NUMBER, true "
                "or false, such as l1_joystick,pole=1"
            )
    found = load_class("controller", name, named=True)
    try:
        controller: Controller = found.from_settings(values)
    except BadInput as error:
        raise BadInput(f"controller {text}: {error}") from None
    return ",".join([Path(name).stem, *settings]), controller


def parse_draw(text: str) -> SampledParameter:
    """Return the sampled parameter of KEY=DISTRIBUTION(...).

    Args:
        text: The option of the command line.

    Raises:
        BadInput: The text has another form.
    """
    key, equals, call = text.partition("=")
    if not equals:
        raise BadInput(
            f"--draw {text}: allowed is KEY=DISTRIBUTION(NUMBERS), such as body.mass=uniform(4,6)"
        )
    return make_sampled_parameter(key.strip(), call.strip())


def parse_ladder(text: str) -> tuple[str, list[float]]:
    """Return name and values of a disturbance NAME=VALUE,VALUE.

    Args:
        text: The option of the command line.

    Raises:
        BadInput: The text has another form, or a value is no number of 0 or more.
    """
    name, equals, numbers = text.partition("=")
    values = []
    for number in filter(None, map(str.strip, numbers.split(","))):
        try:
            value = float(number)
        except ValueError:
            value = -1.0
        if not isfinite(value) or value < 0.0:
            raise BadInput(
                f"--disturbance {text}: {number!r} is no value; allowed is NAME=VALUE,VALUE, such "
                "as delay=0.1,0.2"
            )
        values.append(value)
    if equals and not values:
        raise BadInput(f"--disturbance {text}: allowed is NAME or NAME=VALUE,VALUE")
    return name.strip(), values


def _parse_value(text: str) -> float | bool:
    """Number or switch of a parameter. Raises ValueError."""
    if text in ("true", "false"):
        return text == "true"
    return float(text)
