"""Vessels as functional mock-up units (FMU), which other simulators run: `boatsim export fmu`."""
