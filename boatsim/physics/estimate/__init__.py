"""Rules for the numbers of a boat of which only the particulars are known: one idea a file, each with its source."""
