"""The viewer: a solution as one HTML page without network access, and as still pictures."""
