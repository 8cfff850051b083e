"""Hydrodynamic coefficients over frequency and heading: their files, memory model and grid."""
