"""Describes what no entry of the library explains: a law of few terms, chosen by evidence inside the filter."""
