"""Calibration of a diagnosis: how often names are right that are stated with some probability."""
