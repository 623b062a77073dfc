"""The types with which numba compiles functions for the natives that Python hands to them."""

from carp_optimized.arrays import Answers, Options, Polish, State, Work
from carp_optimized.references import dereference

state_at = dereference(State)
work_at = dereference(Work)
answers_at = dereference(Answers)
options_at = dereference(Options)
polish_at = dereference(Polish)
