"""Diagnosis: finds the physics that a vessel model lacks, by recordings of the real vessel."""
