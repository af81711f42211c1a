"""The installed package: its files, its use from any folder, and its messages if something is
missing."""

import re

from ffimpact.input.parameters import ROOT
from tests.support.package import PROJECT, packed


def test_the_package_holds_every_file_of_the_program():
    """All files of orchestrate/ffimpact/ and edp/ are installed, no others, and there is no other
    name in site-packages."""
    there = {path for place in ("orchestrate/ffimpact", "edp") for path in (ROOT / place).rglob("*") if path.is_file() and path.suffix != ".pyc"}
    assert {str(path.relative_to(ROOT)) for path in there - set(packed().values())} == set()
    assert set(packed().values()) <= there and {name.split("/")[0] for name in packed()} == {"ffimpact"}


def test_the_lock_is_within_the_ranges():
    """requirements.lock pins every dependency, also of tests and checks, at a version that
    pyproject.toml accepts."""
    def numbers(version: str) -> tuple[int, ...]:
        return tuple(map(int, version.split(".")))
    pins = dict(re.findall(r"^([\w-]+)==([\d.]+)", (ROOT / "requirements.lock").read_text(), re.MULTILINE))
    extras = PROJECT["project"]["optional-dependencies"]
    for requirement in PROJECT["project"]["dependencies"] + extras["test"] + extras["check"]:
        name, low, high = re.fullmatch(r"([\w-]+)>=([\d.]+)(?:,<(\d+))?", requirement).groups()
        pin = numbers(pins[name])
        assert numbers(low) <= pin and (not high or pin < numbers(high))
