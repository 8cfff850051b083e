"""Files of a tuned controller: controller.toml for scenario files, and tuning.json."""

import json
from pathlib import Path

import tomlkit

from boatsim.control.base import Controller
from boatsim.files import replace_file
from boatsim.sweeps.robustness.tuning import Design, Tuning

TABLE, JSON = "controller.toml", "tuning.json"


def write_tuning(found: Tuning, controller: str, former: Controller, folder: Path) -> None:
    """Write the table of a scenario file with the tuned controller, and all results.

    Args:
        found: Result of the search.
        controller: Name of the controller, or path of its .py file.
        former: The controller before; its parameters that differ from the defaults are written,
            too.
        folder: Output folder.

    Raises:
        OSError: A file cannot be written.
    """
    usual = type(former)()
    settings: dict[str, object] = {}
    for name in type(former).params():
        value = getattr(former, name)
        is_unset = value != value
        if not is_unset and value != getattr(usual, name):
            settings[name] = value
    settings |= found.best.gains
    text = tomlkit.dumps({"controller": {"use": controller, **settings}})
    with replace_file(folder / TABLE) as temporary:
        temporary.write_text(text, encoding="utf-8")
    content = {
        "vessel": found.vessel.name,
        "load": list(found.vessel.load),
        "boats": found.boats,
        "seed": found.seed,
        "designs": found.designs,
        "ranges": {gain.name: [gain.low, gain.high] for gain in found.ranges},
        "before": _design(found, found.start),
        "tuned": _design(found, found.best),
    }
    with replace_file(folder / JSON) as temporary:
        temporary.write_text(f"{json.dumps(content, indent=2)}\n", encoding="utf-8")


def _design(found: Tuning, design: Design) -> dict[str, object]:
    """Gains, cost and results of a design; errors of SI units."""
    conditions = []
    for result in design.results:
        errors = {}
        for signal, value in zip(found.signals, result.errors.tolist(), strict=True):
            errors[signal.goal] = value if value < float("inf") else None
        conditions.append(
            {
                "disturbance": result.condition.words,
                "errors_p95": errors,
                "survivors": result.survivors,
            }
        )
    return {"gains": dict(design.gains), "cost": design.cost, "conditions": conditions}
