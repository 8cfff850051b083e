"""The seven file formats of loggers."""
