"""Runs all verification cases: `python -m verification`."""

import sys

from ffimpact.__main__ import start

from .verify import main

if __name__ == "__main__":
    sys.exit(start(main))
