"""What a scenario measures on its log: one measure a file, its name the file's name."""
