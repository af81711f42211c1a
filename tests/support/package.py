"""Shared by the tests of package."""

import tomllib
from pathlib import Path

from ffimpact.input.parameters import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def packed() -> dict[str, Path]:
    """What pyproject.toml puts into site-packages: the name there, and the file."""
    tools = PROJECT["tool"]["setuptools"]
    found = {}
    for package in tools["packages"]:
        owner = next(name for name in sorted(tools["package-dir"], key=len, reverse=True) if f"{package}.".startswith(f"{name}."))
        folder = ROOT / tools["package-dir"][owner] / package.removeprefix(owner).lstrip(".").replace(".", "/")
        for pattern in ["*.py", *tools["package-data"].get(package, [])]:
            found |= {f"{package.replace('.', '/')}/{path.relative_to(folder)}": path for path in folder.glob(pattern)}
    return found
