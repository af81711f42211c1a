"""Runs one measurement: `python -m benchmarks NAME`. Each measurement has its own --help."""

import importlib
import sys
from pathlib import Path

from ffimpact.__main__ import start
from ffimpact.failure import BadInput, unknown

NAMES = sorted(path.stem.replace("_", "-") for path in Path(__file__).parent.glob("*.py") if "\ndef main(argv" in path.read_text())


def main(argv: list[str]) -> int | None:
    """Runs the measurement whose name is `argv[0]` and returns its exit code. Raises BadInput for
    an unknown name."""
    if not argv or argv[0] in ("-h", "--help"):
        print(f"usage: python -m benchmarks NAME [OPTIONS]\n\nNAME: {', '.join(NAMES)}")
        return 0
    if argv[0] not in NAMES:
        raise BadInput(f"NAME: {unknown(argv[0], NAMES)}")
    return importlib.import_module(f"benchmarks.{argv[0].replace('-', '_')}").main(argv[1:])


if __name__ == "__main__":
    sys.exit(start(main))
