"""Timings and comparisons with other software; they print tables and assert nothing."""

import os

# Must be set before numpy is imported: the matrices of a diagnosis are too small for several
# threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
