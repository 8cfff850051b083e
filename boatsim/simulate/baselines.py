"""Norms pinned beside the scenarios they are of, so that no change of a boat, a controller or this program goes unseen.

`pins.toml` in a folder of scenarios holds each norm's value with the scenario's own seed, and a tolerance: its range
over several seeds, for a change that but draws other noise is none, and at least what other machines' arithmetic moves.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from pydantic import Field

from boatsim.files import Table, checked, read_toml
from boatsim.simulate.evaluation import Norm

FILE = "pins.toml"
# Arithmetic of other machines differs in the 16th digit. Start conditions off by 1e-12 move the
# norms of nearly every
# scenario by less than 1e-7 of themselves, relays in a controller included; so 1e-6 is a change of
# the code.
TOLERANCE = 1e-6
NOTHING = 1e-9  # absolute, for norms that are zero


class Pin(Table):
    """A norm as it was."""

    value: float | None = None  # None: not reached
    unit: str = ""
    tolerance: float = Field(default=0.0, ge=0.0)  # either way


class PinsFile(Table):
    """The content of a pins.toml."""

    seeds: int = Field(default=1, ge=1)  # over which the tolerances were drawn
    scenario: dict[str, dict[str, Pin]] = {}  # by file, or file:case


def same(old: float | str | None, new: float | str | None, reach: float) -> bool:
    """Whether a number is what it was, within `reach` and arithmetic; of anything else, whether it is equal."""
    if not isinstance(old, float | int) or not isinstance(new, float | int):
        return old == new
    return abs(new - old) <= max(TOLERANCE * abs(old), NOTHING, reach)


def digits(value: float | None) -> float | None:
    """Nine digits: more than the tolerance sees."""
    return None if value is None else float(f"{value:.9g}")


def read(folder: Path) -> PinsFile | None:
    """The pins of a folder, None if there are none. Raises BadInput."""
    path = folder / FILE
    return checked(PinsFile, read_toml(path), str(path)) if path.exists() else None


def pinned(runs: Sequence[Mapping[str, Norm]]) -> dict[str, Pin]:
    """Pins of the norms of one scenario: the values of the first run, tolerances that span those with other seeds."""
    pins = {}
    for name, norm in runs[0].items():
        values = [x for run in runs if name in run and (x := run[name].value) is not None]
        spread = max(values) - min(values) if values and norm.value is not None else 0.0
        least = max(TOLERANCE * abs(norm.value or 0.0), NOTHING)
        pins[name] = Pin(
            value=digits(norm.value), unit=norm.unit, tolerance=float(f"{max(spread, least):.3g}")
        )
    return pins


def drifts(pins: Mapping[str, Pin], found: Mapping[str, Norm]) -> list[str]:
    """A line for every norm that is not as it was pinned."""
    lines = []
    for name in {**pins, **found}:
        if name not in pins:
            lines.append(f"{name} is not pinned")
        elif name not in found:
            lines.append(f"{name} is pinned and gone")
        elif not same(pins[name].value, found[name].value, pins[name].tolerance):
            old, new = (_said(x.value, found[name].lacking) for x in (pins[name], found[name]))
            lines.append(
                f"{name}: {old} -> {new} {found[name].unit}".rstrip()
                + f" (+- {pins[name].tolerance:.3g})"
            )
        elif pins[name].unit != found[name].unit:
            lines.append(f"{name}: its unit was {pins[name].unit!r} and is {found[name].unit!r}")
    return lines


def _said(value: float | None, lacking: str | None) -> str:
    return (lacking or "not reached") if value is None else f"{value:.6g}"


def text_of(pins: PinsFile) -> str:
    """Content of a pins.toml: a line for each norm, so that a change of one is a change of one line."""
    lines = [
        "# Norms of the scenarios in this folder, each with the scenario's own seed. `boatsim test FOLDER` compares,",
        "# `boatsim test FOLDER --pin` writes this file. tolerance: range over the seeds, at least a millionth.",
        f"seeds = {pins.seeds}",
    ]
    for scenario, norms in sorted(pins.scenario.items()):
        lines += ["", f"[scenario.{json.dumps(scenario)}]"]
        for name, pin in norms.items():
            value = "" if pin.value is None else f"value = {pin.value!r}, "
            rest = (
                f"tolerance = {pin.tolerance!r}, unit = {json.dumps(pin.unit, ensure_ascii=False)}"
            )
            lines.append(f"{json.dumps(name)} = {{ {value}{rest} }}")
    return "\n".join(lines) + "\n"
