"""Vessels in waves against the frequency domain and against a recorded ship section."""
