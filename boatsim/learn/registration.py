"""Tells Gymnasium of our environments."""

from collections.abc import Mapping
from pathlib import Path

import gymnasium

from boatsim.files import read_toml

IDS = Path(__file__).with_name("ids.toml")


def register() -> None:
    """Every id of ids.toml, unless it is known already."""
    said = {name: dict(table) for name, table in read_toml(IDS).items() if isinstance(table, Mapping)}
    vary = said.pop("vary")
    for name, told in said.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point="boatsim.learn.single:BoatEnv",
                vector_entry_point="boatsim.learn.vector:BoatVectorEnv",
                kwargs={"vary": vary, **told},
            )
