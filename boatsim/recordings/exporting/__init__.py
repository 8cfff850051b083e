"""Recordings in the log formats of other programs."""
