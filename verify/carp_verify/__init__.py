"""Checkers of evidence: lemmas, certificates, optima and their proofs."""
