"""The programs that are asked: over pipes, once a case, or as a Python function."""
