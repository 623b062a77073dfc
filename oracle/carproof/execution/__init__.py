"""Executions of plans by late robots: delays, drivers, switching, giving way."""
