"""Arrays and a WebAssembly module as text of a page, which `loader.js` reads."""

import zlib
from base64 import b64encode
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array

LOADER = Path(__file__).parent / "loader.js"
MOST_BYTES = 1_000_000  # of a page that contains a program


class PackedNumbers:
    """Arrays of floats and a program, one after another, compressed as text."""

    def __init__(self) -> None:
        """Begin without content."""
        self._bytes = bytearray()

    def place(self, array: Array) -> tuple[int, int]:
        """Add an array of floats; return its place [bytes] and its number of entries.

        Args:
            array: The array, of any shape.
        """
        at = len(self._bytes)
        self._bytes += np.ascontiguousarray(array, dtype="<f8").tobytes()
        return at, array.size

    def place_program(self, program: bytes) -> tuple[int, int]:
        """Add the program after all arrays, which start at multiples of 8 bytes.

        Args:
            program: A WebAssembly module.

        Returns:
            Its place and its size [bytes].
        """
        at = len(self._bytes)
        self._bytes += program
        return at, len(program)

    @property
    def text(self) -> str:
        """All of it, compressed by zlib, in base 64."""
        return b64encode(zlib.compress(bytes(self._bytes), 9)).decode()
