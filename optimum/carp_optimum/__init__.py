"""Searches for optima and lower bounds. Nothing in here is trusted: `carp_verify` checks what they find."""
