"""Verdicts on solutions, certificates and proofs, in Python or by the proved kernel."""
