"""boatsim: small-boat motion and control on MuJoCo, and what a simulation of a real boat has left out."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("boatsim")
except PackageNotFoundError:  # run from a source tree that was never installed
    __version__ = "0+unknown"
