"""Measurements of carproof itself: speed, gaps, optima, and cross-checks of two implementations."""
