"""Executions: what robots have done by a tick, the action dependency graph, and the rules."""
