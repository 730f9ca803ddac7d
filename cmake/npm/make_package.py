#!/usr/bin/env python3
"""Makes the npm package edsc-VERSION.tgz in FOLDER from the archives of the static programs.

    make_package.py FOLDER ARCHIVE...

ARCHIVE is edsc-VERSION-linux-x86_64.tar.gz, edsc-VERSION-linux-aarch64.tar.gz or edsc-VERSION-windows-x86_64.zip; all have one
version. The package has a launcher, which runs the program of the user's platform. The same archives give the same bytes.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
NAME = re.compile(r"edsc-(?P<version>\d+\.\d+\.\d+)-(?P<platform>\w+-\w+)\.(tar\.gz|zip)")
# The names of Node.js, and the program.
PLATFORMS = {"linux-x86_64": ("linux-x64", "edsc"), "linux-aarch64": ("linux-arm64", "edsc"),
             "windows-x86_64": ("win32-x64", "edsc.exe")}


def add_program(archive: Path, package: Path) -> str:
    """Copies the program of the archive, its notices and its bill of materials, and returns the version."""
    match = NAME.fullmatch(archive.name)
    if not match or match["platform"] not in PLATFORMS:
        sys.exit(f"{archive}: expected the name edsc-VERSION-PLATFORM, and one of the platforms {', '.join(PLATFORMS)}")
    platform, program = PLATFORMS[match["platform"]]
    with tempfile.TemporaryDirectory() as folder:
        shutil.unpack_archive(archive, folder)
        (top,) = Path(folder).iterdir()
        target = package / "programs" / platform
        target.mkdir(parents=True)
        for file in (top / "bin" / program, top / "share/doc/edsc/THIRD-PARTY-NOTICES", top / "share/doc/edsc/edsc.cdx.json"):
            shutil.copy(file, target)
        (target / program).chmod(0o755)
        shutil.copy(top / "share/doc/edsc/copyright", package / "LICENSE")
    return match["version"]


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    output, *archives = map(Path, sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder) / "package"
        shutil.copytree(HERE, package, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
        versions = {add_program(archive, package) for archive in archives}
        if len(versions) != 1:
            sys.exit(f"the archives have different versions: {', '.join(sorted(versions))}")
        description = json.loads((package / "package.json").read_text(encoding="utf-8"))
        description["version"] = versions.pop()
        (package / "package.json").write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")
        output.mkdir(parents=True, exist_ok=True)
        subprocess.run(["npm", "pack", "--silent", "--pack-destination", output.resolve()], cwd=package, check=True)


if __name__ == "__main__":
    main()
