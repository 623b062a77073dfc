"""Commands that plan, and tell what the best possible is."""
