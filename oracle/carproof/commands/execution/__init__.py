"""`carproof execution`: commands about late robots."""
