"""Evidence that others can check: theorems, certificates, optima and their proofs."""
