"""The shelf: one effect per file, found by its name."""
