"""The conformance runner: asks a program questions, judges its answers, and shrinks the failing ones.

Read it in this order: `cases` (questions), `findings` (faults of answers), `judges` (the demands of each level),
`outcome` (one question asked), `ladder` (large questions), `smaller` (smaller ones), `run`.
"""
