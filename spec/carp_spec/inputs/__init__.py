"""What public functions refuse, by the rule and at the path that the document or request would be refused with."""
