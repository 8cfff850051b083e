"""Compiled functions that are the same for every vessel.

They call the generated laws of one vessel.
"""
