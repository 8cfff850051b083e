"""Import of optional packages on which some rivals depend (extra `rivals`)."""

from importlib import import_module
from typing import Any

from boatsim.errors import BadInput


def import_package(name: str, rival: str) -> Any:
    """Import a package of the extra `rivals`.

    Args:
        name: Name of the module.
        rival: Name of the rival that needs it.

    Returns:
        The module.

    Raises:
        BadInput: If the package is not installed; the message is one line.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise BadInput(
            f"{rival} needs the package {name}, which is not installed ({error}); "
            "install the extra: pip install 'boatsim[rivals]'"
        ) from None
