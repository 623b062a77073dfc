"""Executions of late robots on arrays, and traces compared with solutions."""
