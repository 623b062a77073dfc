"""Executions of plans."""
