"""The command line: `boatsim run | import | list | margins | compare | replay | diagnose`."""

from boatsim.cli.commands import app, main

__all__ = ["app", "main"]
