"""A rehearsal with strangers' logs: boats of no file here, simulated by a program of its own, judged by the commands.

Nothing in the simulator imports boatsim; the judge calls the commands that a user has.
"""
