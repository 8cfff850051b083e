"""Formats of logs, one module per format with `SUFFIXES` and `read(path) -> Log`."""
