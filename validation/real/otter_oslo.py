"""Otter USV in Oslo harbour: `python -m validation.real.otter_oslo [--form clean|raw] [DAY...]`.

Students of OsloMet drove a catamaran of 2 m with two propellers on three days of 2024. Each day is
a group of the protocol (docs/protocol.md): another program, load and water. The runs are diagnosed
twice, from the files as published, which the map below imports, and from the files of runs_clean.

The vessel, otter/vessel.toml, is Fossen's model in the plane. It can not express what the closed
box of the vehicle does with a command between the revolutions that the program asks for and those
of the shafts.
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

from validation.real.common import DEG, RECORDINGS, print_table, runs_of
from validation.real.figures import Figures, diagnose_set, print_figures, split_groups

NAME = "otter_oslo"
VESSEL = str(Path(__file__).parent / "otter" / "vessel.toml")
DAYS = ("mar07", "mar22", "apr23")
TOO_SHORT = ("mar07_1529", "apr23_1208")  # less than 15 s
WINDOW = 10.0  # [s] of a free run
UNITS = {"position": ("position [m]", 1.0), "heading": ("heading [deg]", DEG)}
