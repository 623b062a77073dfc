"""Optima: the formula of a smaller total, refutations, and proof directories."""
