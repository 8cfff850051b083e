"""Rehearsal with logs of unknown boats, simulated by an independent program.

The simulator does not import boatsim; the judge calls the commands that a user has.
"""
