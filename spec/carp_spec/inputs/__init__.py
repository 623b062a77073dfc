"""Malformed values and requests are refused by the rule, and at the path, of their document or op."""
