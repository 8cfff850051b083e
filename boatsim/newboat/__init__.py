"""A boat from what its owner knows: its vessel file, a drawing, a first scenario, and its coefficients from a log."""
