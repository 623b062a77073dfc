"""Free windows under reservations (`window/free`).

The windows of a resource of capacity 1 are the gaps between its stays, those of no length included, which are too
short for any stay: a reservation splits the gap in which it falls, and its withdrawal joins the two. Where following is
forbidden, a gap is a tick shorter at both ends. The windows of other resources, and of those in groups, are made again
from the stays of all constraints on them.
"""
