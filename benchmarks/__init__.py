"""Speed, accuracy and diagnosis figures; they print tables and assert nothing."""

import os

os.environ.setdefault(
    "OPENBLAS_NUM_THREADS", "1"
)  # before numpy comes: what follows a diagnosis is as small as it
