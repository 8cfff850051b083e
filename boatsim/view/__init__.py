"""Display of runs and recordings in rerun."""
