"""`python -m carp_verify.vectors` writes the test vectors."""

from carp_verify.vectors.writing import write_vectors

if __name__ == "__main__":
    write_vectors()
