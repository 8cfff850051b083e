"""Command line of boatsim: `boatsim run | test | sweep | drive | diagnose | ...`."""

from boatsim.cli.commands import app, main

__all__ = ["app", "main"]
