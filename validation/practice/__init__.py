"""Second practice set: modified vessels of this repository, recorded by an independent program.

Nothing here imports boatsim: only the numbers come from the vessel files; the equations of motion
are written and integrated independently.
"""
