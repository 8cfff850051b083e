"""A second practice set: boats of this repository that differ from their files, recorded by a program of its own.

Nothing here imports boatsim: the vessel files give numbers, the equations of motion are written and integrated anew.
"""
