"""Campaigns of runs: parameter grids and random samples, parallel or on a cluster, in one table."""
