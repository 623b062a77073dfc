"""The conformance runner: asks a program questions, judges its answers, and shrinks the failing ones.

Read it in this order: `cases` (questions), `findings` (faults of answers), `judges` (the demands of each level),
`subjects` (a process that stays up, a process per question, or a Python function), `run`.
"""
