"""`python -m boatsim.warp VESSEL` prints a vessel's program in Warp's language."""

import sys

from boatsim.physics import vessel
from boatsim.physics.program import Program
from boatsim.warp.program import translated_source

print(translated_source(Program(vessel.load_vessel(sys.argv[1])), "float32"))
