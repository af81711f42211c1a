"""Helpers that the modules test_package.py share."""

import tomllib
from pathlib import Path

from ffimpact.input.parameters import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())


def packed() -> dict[str, Path]:
    """The files that pyproject.toml installs into site-packages, by the name in site-packages."""
    tools = PROJECT["tool"]["setuptools"]
    files = {}
    for package in tools["packages"]:
        owner = next(name for name in sorted(tools["package-dir"], key=len, reverse=True) if f"{package}.".startswith(f"{name}."))
        folder = ROOT / tools["package-dir"][owner] / package.removeprefix(owner).lstrip(".").replace(".", "/")
        for pattern in ["*.py", *tools["package-data"].get(package, [])]:
            files |= {f"{package.replace('.', '/')}/{path.relative_to(folder)}": path for path in folder.glob(pattern)}
    return files
