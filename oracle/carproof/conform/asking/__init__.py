"""The cases that a program is asked: smoke, vectors, random ones, and a ladder of sizes."""
