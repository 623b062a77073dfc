"""Commands that make instances, and run carproof."""
