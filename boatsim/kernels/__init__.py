"""Compiled machinery written once for every vessel: `boatsim.program` puts a vessel's own laws in front of it."""
