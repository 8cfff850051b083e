"""All commands of boatsim; a command joins the command line when its module is imported."""

from boatsim.cli.application import COMMAND_GROUPS, app, main
from boatsim.cli.commands import controlling, recordings, simulating, vessels

__all__ = ["COMMAND_GROUPS", "app", "controlling", "main", "recordings", "simulating", "vessels"]
