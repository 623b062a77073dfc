"""`python -m carp_oracle` is `carproof`."""

import sys

from carp_oracle.cli import main

if __name__ == "__main__":
    sys.exit(main())
