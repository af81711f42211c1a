"""Compares the statements of the paper with our results: `python -m examples.paper`."""

import sys

from ffimpact.__main__ import start

from .paper import main

if __name__ == "__main__":
    sys.exit(start(main))
