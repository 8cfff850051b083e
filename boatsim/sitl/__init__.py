"""Autopilots in the loop: the JSON interface of ArduPilot's software in the loop (SITL)."""
