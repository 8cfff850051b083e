"""New boats: vessel file, hull drawing and scenario from particulars, coefficients from logs."""
