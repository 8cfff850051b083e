"""One format of logs a file: `SUFFIXES`, and `read(path) -> Log`; found by the suffix of the log."""
