"""What a person gets of a run: documents, a page, saved findings."""
