"""Runs and recordings to look at, in rerun."""
