"""Registers the environments with Gymnasium."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium

from boatsim.files import read_toml

IDS = Path(__file__).with_name("ids.toml")
VARY = "vary"  # of all ids


def ids() -> list[str]:
    """Return the ids of all environments."""
    return [name for name in read_toml(IDS) if name != VARY]


def says(name: str) -> dict[str, Any]:
    """Return the arguments of an environment.

    Args:
        name: Its id.
    """
    said: dict[str, Mapping[str, Any]] = {
        k: v for k, v in read_toml(IDS).items() if isinstance(v, Mapping)
    }
    return {VARY: dict(said[VARY]), **said[name]}


def register() -> None:
    """Register every id of ids.toml that is not registered yet."""
    for name in ids():
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point="boatsim.learn.single:BoatEnv",
                vector_entry_point="boatsim.learn.vector:BoatVectorEnv",
                kwargs=says(name),
            )
