"""Runs in real time, steered by a driver from a page in the browser."""
