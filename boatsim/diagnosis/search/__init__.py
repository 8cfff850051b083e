"""Selects the candidate effects that the recordings require."""
