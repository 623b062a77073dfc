"""Formulas for a SAT solver, and the proofs of its answers."""
