"""Records of small runs in tests/records, evaluated without FreeFEM: an oblique impact with friction
by BDF2, two discs with friction that meet off their centres, a quarter of a ball in space, a ball of
revolution with modes, and a disc that falls until it rests."""

import shutil
from pathlib import Path

import ffimpact as ff
from ffimpact.output.evaluate import evaluate

RECORDS = Path(__file__).parents[1] / "records"


def unpacked(name: str, folder: Path) -> Path:
    """The folder, with the record in it."""
    shutil.unpack_archive(RECORDS / f"{name}.tar.xz", folder)
    return folder


def evaluated(name: str, folder: Path) -> ff.Result:
    """The record, evaluated in the folder."""
    evaluate(unpacked(name, folder))
    return ff.load(folder)
