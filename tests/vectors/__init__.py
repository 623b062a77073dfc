"""Keeping the test vectors, whose source is the files in `carp_spec/vectors`.

A new case is written into a file; `python -m tests.vectors.writing` then lays the file out and lists the case's digest.
`judging` is what carproof itself answers to a case; a test compares the two.
"""
