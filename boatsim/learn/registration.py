"""Registers the environments with Gymnasium."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium

from boatsim.files import read_toml

IDS = Path(__file__).with_name("ids.toml")
VARY = "vary"  # table of ids.toml that applies to all ids


def _read_id_tables() -> dict[str, Mapping[str, Any]]:
    """Tables of ids.toml."""
    return {k: v for k, v in read_toml(IDS).items() if isinstance(v, Mapping)}


def environment_ids() -> list[str]:
    """Return the Gymnasium ids of all environments of this package."""
    return [name for name in read_toml(IDS) if name != VARY]


def environment_arguments(name: str) -> dict[str, Any]:
    """Return the arguments with which Gymnasium creates an environment of a given id.

    Args:
        name: Id of the environment.
    """
    tables = _read_id_tables()
    return {VARY: dict(tables[VARY]), **tables[name]}


def register() -> None:
    """Register with Gymnasium the environments of the file ids.toml that are not registered yet."""
    for name in environment_ids():
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point="boatsim.learn.single:BoatEnv",
                vector_entry_point="boatsim.learn.vector:BoatVectorEnv",
                kwargs=environment_arguments(name),
            )
