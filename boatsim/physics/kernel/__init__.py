"""Compiled machinery written once for every vessel; `boatsim.physics.program` puts a vessel's own laws before it."""
