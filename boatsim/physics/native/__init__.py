"""A vessel's program as a C library: the same laws, translated and compiled in about a second."""
