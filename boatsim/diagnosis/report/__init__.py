"""The answer: in words, figures, files."""
