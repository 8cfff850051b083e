"""Sensors that a scenario's `[[sensor]]` adds to the usual ones: one a file, its name the file's name."""
