"""Recordings of a boat: a table of named signals with notes, read from the formats in `readers/`."""
