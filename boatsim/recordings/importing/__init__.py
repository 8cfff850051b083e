"""Conversion of a log, whose streams have separate clocks, to one recording."""
