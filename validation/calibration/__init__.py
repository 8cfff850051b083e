"""Calibration campaign: how often the stated probabilities of diagnoses are right."""
