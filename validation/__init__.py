"""Accuracy of the diagnosis on simulated trials and real recordings; prints tables only."""

import os

# Must be set before numpy is imported: the matrices are too small for several threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
