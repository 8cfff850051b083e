"""Benchmarks of the diagnosis on real recordings, judged on runs that were not fitted."""
