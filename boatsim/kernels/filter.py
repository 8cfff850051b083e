"""Filter (to come)."""
