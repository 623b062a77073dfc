"""Judging answers: by the law, by audits, by the compiled planner, by the kernel."""
