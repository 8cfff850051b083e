"""Metrics of a run, one set in each file; scenarios refer to a set by the name of its file."""
