"""Hypothesis' profile, and what the environment of every test lacks."""

import os
import signal

from tests.profiles import load_profile

load_profile()

# A shell that runs the tests in the background ignores interrupts for them, and programs would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# The programs that the tests start print for a person at a terminal of the usual width, on a build server too: pytest
# for one prints its summary otherwise where CI is set.
for name in ("CI", "BUILD_NUMBER", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR", "PY_COLORS", "PYTEST_ADDOPTS"):
    os.environ.pop(name, None)
