"""Composes the answer of a diagnosis, the content of diagnosis.json, and its curves."""
