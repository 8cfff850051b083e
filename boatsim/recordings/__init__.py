"""Recordings: tables of named signals with notes, read from the formats in `readers/` and converted from logs."""
