"""Packages of npm for a test."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path


class Skipped(Exception):
    """A program or a package that the test needs is missing."""


def install_npm_packages(source: Path, work: Path) -> None:
    """Copies the folder `source` to `work` and installs there the packages of its lock file."""
    for program in ("node", "npm"):
        if shutil.which(program) is None:
            raise Skipped(f"{program} is not installed")
    lock, installed = source / "package-lock.json", work / "installed.json"
    shutil.copytree(source, work, dirs_exist_ok=True)
    if not installed.exists() or installed.read_bytes() != lock.read_bytes():
        npm = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries=1"], cwd=work,
                             capture_output=True, text=True, check=False)
        if npm.returncode != 0:
            raise Skipped(f"npm cannot install the packages of {source}:\n{npm.stderr}")
        installed.write_bytes(lock.read_bytes())
