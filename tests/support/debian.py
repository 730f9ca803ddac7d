"""The release of Debian that runs the tests: versions of packages and messages of compilers depend on it."""

from __future__ import annotations

from pathlib import Path

VERSION = Path("/etc/debian_version")


def is_debian(release: int) -> bool:
    return VERSION.exists() and VERSION.read_text(encoding="utf-8").startswith(f"{release}.")
