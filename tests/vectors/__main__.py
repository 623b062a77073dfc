"""`python -m tests.vectors` writes the test vectors."""

from tests.vectors.writing import write_vectors

if __name__ == "__main__":
    write_vectors()
