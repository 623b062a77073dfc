"""The paper's experiments, as campaigns that can be stopped and taken up again."""
