"""Compiled functions that are the same for every vessel; they call the generated laws of one vessel."""
