"""Writes a fitted boat back as a vessel file: the original with comments, recalibrated, the effects found added."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit

from boatsim.diagnose.problem import Fit
from boatsim.files import replacing
from boatsim.physics.base import Effect
from boatsim.physics.content import address, vessel_address
from boatsim.physics.vessel import Vessel

DIGITS = 8  # significant, so that the file gives the fitted motion back


def patched(vessel: Vessel, found: Fit, kinds: Mapping[str, type[Effect]]) -> str:
    """Text of the patched vessel file; `kinds` are the classes of the suspects by name."""
    text = vessel.file.read_text(encoding="utf-8")
    if "based_on" not in tomlkit.parse(text):
        text = f'based_on = "{vessel_address(vessel.file)}"  # its folder holds the hull\n{text}'
    document: Any = tomlkit.parse(text)
    tables = document.setdefault("effect", tomlkit.aot())
    own = {e.name(): t for e, t in zip(vessel.effects, tables, strict=False)}
    added: dict[str, dict[str, float]] = {name: {} for name in found.suspects}
    for free, value in zip(found.free, found.theta, strict=True):
        if not free.relative:
            added[free.effect][free.name] = float(value)
            continue
        nominal = getattr(next(e for e in vessel.effects if e.name() == free.effect), free.name)
        for table in (own[free.effect], *_loads(document, free.effect, free.name)):
            table[free.name] = tomlkit.item(_rounded(float(table.get(free.name, nominal)) * float(value)))
            table[free.name].comment(f"recalibrated x {value:.4f}")
    for name in (n for n in kinds if n in added):  # channels act in the order of the diagnosis
        tables.append(_effect_table(address(kinds[name]), added[name]))
    return str(tomlkit.dumps(document))


def write(vessel: Vessel, found: Fit, kinds: Mapping[str, type[Effect]], path: Path) -> None:
    """Write the patched vessel file."""
    with replacing(path) as temporary:
        temporary.write_text(patched(vessel, found, kinds), encoding="utf-8")


def _effect_table(name: str, settings: Mapping[str, float]) -> Any:
    table = tomlkit.table()
    table["use"] = name
    table["use"].comment("found by the diagnosis")
    for key, value in settings.items():
        table[key] = _rounded(value)
    return table


def _loads(document: Any, effect: str, name: str) -> list[Any]:
    """Tables of loads that state the same coefficient."""
    return [load[effect] for load in document.get("loads", {}).values() if name in load.get(effect, {})]


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
