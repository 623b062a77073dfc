"""The conformance runner: asks somebody's program questions, judges its answers, and shrinks what it gets wrong.

Read it in this order: `cases` (a question), `findings` (what can be wrong), `judges` (what a level asks of an
answer), `subjects` (who is asked: a process that stays up, a process per question, or a Python function), `run`.
"""
