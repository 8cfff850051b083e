"""Backends that perform the tasks of a campaign, one in each file."""
