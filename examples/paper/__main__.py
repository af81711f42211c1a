"""python -m examples.paper: the paper's statements beside this program's numbers."""

import sys

from ffimpact.__main__ import start

from .paper import main

if __name__ == "__main__":
    sys.exit(start(main))
