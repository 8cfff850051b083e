"""Effects, the laws of a vessel and their compilation to one program."""

from boatsim.physics import debugging as debugging  # before any module in which numba compiles
