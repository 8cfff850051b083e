"""Diagnoses of real recordings: what was left out of a published model, judged on runs it has not seen."""
