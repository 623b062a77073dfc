"""Compilation: all contact with numba's internals."""
