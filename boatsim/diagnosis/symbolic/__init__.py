"""Symbolic regression: a formula of few terms for a force that no candidate effect explains."""
