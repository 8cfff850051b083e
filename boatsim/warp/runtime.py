"""Warp itself: imported when a batch is made, quiet, with its compiled kernels in boatsim's own folder."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from boatsim.errors import BadInput
from boatsim.physics.cache import cache_folder


def warp() -> Any:
    """The library. Raises BadInput where it is missing."""
    try:
        import warp as wp
    except ImportError:
        raise BadInput('a batch on Warp needs it installed: pip install "boatsim[warp]"') from None
    if wp.config.kernel_cache_dir is None and "WARP_CACHE_PATH" not in os.environ:
        wp.config.kernel_cache_dir = str(cache_folder() / "warp")
        wp.config.log_level = wp.LOG_ERROR  # it would tell of every module that it compiles
        with deaf():
            wp.get_devices()  # begins it
    return wp


def device(name: str) -> Any:
    """A device by its name, "cpu" or "cuda:0". Raises BadInput for one that is not there."""
    wp = warp()
    try:
        return wp.get_device(name)
    except (ValueError, RuntimeError):
        there = ", ".join(str(found) for found in wp.get_devices())
        raise BadInput(f"device = {name!r}; allowed here: {there}") from None


@contextmanager
def deaf() -> Iterator[None]:
    """Nothing reaches the standard error: Warp's own library says there that a computer has no GPU."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
