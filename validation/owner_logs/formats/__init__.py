"""The seven kinds of files that loggers write."""
