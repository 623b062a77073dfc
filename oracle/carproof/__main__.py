"""`python -m carproof` is the command `carproof`."""

import sys

from carproof.entry.start import main

if __name__ == "__main__":
    sys.exit(main())
