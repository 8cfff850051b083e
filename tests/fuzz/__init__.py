"""Mutated files for every reader: each ends in a value or in one clear line, never in another
exception."""
