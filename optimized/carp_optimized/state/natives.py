"""The types with which numba compiles functions for the natives that Python hands to them."""

from carp_optimized.jit.references import dereference
from carp_optimized.state.arrays import Adding, Polish, State

state_at = dereference(State)
adding_at = dereference(Adding)
polish_at = dereference(Polish)
