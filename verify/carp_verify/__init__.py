"""Evidence that others can check: lemmas, certificates, optima and their proofs."""
