"""Which entries of the library the data ask for."""
