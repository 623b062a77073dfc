"""Queries: the rules of their certificates, and the checker."""
