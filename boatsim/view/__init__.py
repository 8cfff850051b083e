"""Views of runs: logs for the rerun viewer, and HTML pages of runs and of folders of results."""
