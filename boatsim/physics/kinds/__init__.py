"""Kinds of effects; each defines what its effects add to the compiled program of a vessel."""
