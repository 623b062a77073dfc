"""Searches for optima and lower bounds. Nothing here is trusted: `carp_verify` checks the results."""
