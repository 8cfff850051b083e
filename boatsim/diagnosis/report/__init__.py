"""The report of a diagnosis: the answer and its curves in words and figures."""
