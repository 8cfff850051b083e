"""`python -m boatsim.warp VESSEL` prints a vessel's program in Warp's language."""

import sys

from boatsim.physics import vessel
from boatsim.physics.program import Program
from boatsim.warp.program import text_of

print(text_of(Program(vessel.load_vessel(sys.argv[1])), "float32"))
