"""Recordings: tables of named signals with notes, from files or converted from logs."""
