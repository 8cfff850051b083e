"""Names of effects that act only in one group of recordings, such as `wind@monday`.

Recordings form groups: days, builds, loads, crews. An effect may act in one group only, or have
another size there. Such an effect has the name of the effect, "@" and the name of the group.
"""

IN_GROUP = "@"


def name_in_group(name: str, group: str) -> str:
    """Return the name of an effect that acts only in one group of recordings.

    Args:
        name: Name of the effect.
        group: Name of the group.
    """
    return f"{name}{IN_GROUP}{group}"


def without_group(name: str) -> str:
    """Return the name of an effect without that of the group in which alone it acts."""
    return name.partition(IN_GROUP)[0]


def group_of(name: str) -> str:
    """Return the group of recordings in which alone an effect acts; "" for all recordings."""
    return name.partition(IN_GROUP)[2]
