"""The types with which numba compiles functions for the natives that Python hands to them."""

from carp_optimized.arrays import Adding, Polish, State
from carp_optimized.references import dereference

state_at = dereference(State)
adding_at = dereference(Adding)
polish_at = dereference(Polish)
