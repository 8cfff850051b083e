"""Implementation of `boatsim tune`: gains of a controller, sought on drawn boats."""

from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import Exit, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.cli.progress import show_task_progress
from boatsim.cli.robustness import make_controller, parse_draw, parse_ladder
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.vessel_margins import format_vessel_margins, margins_on_vessel
from boatsim.sweeps.robustness.tuned_files import JSON, TABLE, write_tuning
from boatsim.sweeps.robustness.tuned_tables import tuning_tables
from boatsim.sweeps.robustness.tuning import tune


def tune_controller(
    controller: str,
    vessel: str,
    loads: Sequence[str],
    gains: Sequence[str],
    boats: int,
    seed: int,
    draws: Sequence[str],
    spread: float,
    disturbances: Sequence[str],
    budget: int,
    out: Path,
) -> int:
    """Tune a controller, print its gains, errors and margins, and write its table.

    Args:
        controller: Name of a controller, or path of a .py file, with changed parameters:
            `NAME,KEY=VALUE,...`.
        vessel: Name or path of a vessel.
        loads: Load conditions.
        gains: `NAME` or `NAME=LOW:HIGH` of each gain; empty for the usual ones.
        boats: Number of drawn boats.
        seed: Random seed.
        draws: Sampled parameters, `KEY=DISTRIBUTION(...)`.
        spread: Factor of the standard deviations of the usual draws.
        disturbances: `NAME` or `NAME=VALUE,VALUE,...`; empty for all.
        budget: Number of designs.
        out: Output folder.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong.
    """
    name, made = make_controller(controller)
    boat = load_vessel(vessel, loads)
    sampled = [parse_draw(text) for text in draws]
    asked = [_parse_gain(text) for text in gains]
    conditions = dict(parse_ladder(text) for text in disturbances)
    with show_task_progress() as report:
        found = tune(
            name, made, boat, asked, conditions, boats, seed, sampled, spread, budget, report
        )
    for table in tuning_tables(found):
        print_text_table(table.title, table.head, table.rows, table.left)
    if not found.is_better:
        print_lines(["No design is better than the former one on boats that it was not tuned on."])
    if hasattr(found.controller, "operating_points"):
        print_lines([format_vessel_margins(margins_on_vessel(found.controller, boat), boat)])
    file = controller.split(",")[0]
    with atomic_folder(out) as folder:
        write_tuning(found, file, made, folder)
    print_lines([f"written to {out}: {TABLE}, {JSON}"])
    return Exit.MET


def _parse_gain(text: str) -> tuple[str, float | None, float | None]:
    """Name and range of a gain NAME or NAME=LOW:HIGH. Raises BadInput."""
    name, equals, given = text.partition("=")
    if not equals:
        return name.strip(), None, None
    low, colon, high = given.partition(":")
    try:
        values = float(low), float(high)
    except ValueError:
        colon = ""
    if not colon or not all(map(isfinite, values)):
        raise BadInput(f"--gain {text}: allowed is NAME or NAME=LOW:HIGH, such as pole=0.3:2")
    return name.strip(), *values
