"""The CARP query, a relative of SIPP: A* over free windows."""
