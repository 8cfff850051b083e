"""The library Warp, imported on demand, with its kernels in boatsim's cache folder."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from boatsim.errors import BadInput
from boatsim.physics.cache_folder import cache_folder


def import_warp() -> Any:
    """Import NVIDIA's library Warp and return its module.

    Raises:
        BadInput: Warp is not installed.
    """
    try:
        import warp as wp
    except ImportError:
        raise BadInput('a batch on Warp needs warp-lang: pip install "boatsim[warp]"') from None
    if wp.config.kernel_cache_dir is None and "WARP_CACHE_PATH" not in os.environ:
        wp.config.kernel_cache_dir = str(cache_folder() / "warp")
        wp.config.log_level = wp.LOG_ERROR  # it reports every module that it compiles
        with discard_standard_error():
            wp.get_devices()  # initialises Warp
    return wp


def find_device(name: str) -> Any:
    """Return the Warp device of a name.

    Args:
        name: "cpu" or "cuda:0", for example.

    Raises:
        BadInput: There is no such device.
    """
    wp = import_warp()
    try:
        return wp.get_device(name)
    except (ValueError, RuntimeError):
        allowed = ", ".join(map(str, wp.get_devices()))
        raise BadInput(f"device = {name!r}; allowed here: {allowed}") from None


@contextmanager
def discard_standard_error() -> Iterator[None]:
    """Discard standard error in a block: Warp reports there that a computer has no GPU."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
