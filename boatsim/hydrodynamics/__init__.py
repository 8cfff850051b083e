"""Hydrodynamic coefficients of a hull from Capytaine, WAMIT or Nemoh."""
