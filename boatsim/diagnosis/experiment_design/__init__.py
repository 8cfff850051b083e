"""Design of the next experiment: which manoeuvre to record next."""
