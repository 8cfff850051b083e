"""Output files of a diagnosis: report, answer, patched vessel, next experiment."""
