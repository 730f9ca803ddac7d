#!/usr/bin/env python3
"""Makes the extension edsc-VERSION-TARGET.vsix in FOLDER from each archive of a static program.

    make_extension.py FOLDER ARCHIVE...

ARCHIVE is edsc-VERSION-linux-x86_64.tar.gz, edsc-VERSION-linux-aarch64.tar.gz or edsc-VERSION-windows-x86_64.zip. npm installs the
client and vsce of package-lock.json, from its cache if it has them. VS Code installs the result without a connection:
`code --install-extension edsc-VERSION-TARGET.vsix`.
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
# The names of VS Code, and the program.
TARGETS = {"linux-x86_64": ("linux-x64", "edsc"), "linux-aarch64": ("linux-arm64", "edsc"),
           "windows-x86_64": ("win32-x64", "edsc.exe")}


def add_program(archive: Path, extension: Path) -> tuple[str, str]:
    """Copies the program with its licenses, and returns version and target."""
    match = NAME.fullmatch(archive.name)
    if not match or match["platform"] not in TARGETS:
        sys.exit(f"{archive}: expected the name edsc-VERSION-PLATFORM, and one of the platforms {', '.join(TARGETS)}")
    target, program = TARGETS[match["platform"]]
    with tempfile.TemporaryDirectory() as folder:
        shutil.unpack_archive(archive, folder)
        (top,) = Path(folder).iterdir()
        shutil.rmtree(extension / "bin", ignore_errors=True)
        (extension / "bin").mkdir()
        for file in (top / "bin" / program, top / "share/doc/edsc/THIRD-PARTY-NOTICES"):
            shutil.copy(file, extension / "bin")
        (extension / "bin" / program).chmod(0o755)
        shutil.copy(top / "share/doc/edsc/copyright", extension / "LICENSE")
    return match["version"], target


def make(archive: Path, extension: Path, output: Path) -> None:
    version, target = add_program(archive, extension)
    description = json.loads((extension / "package.json").read_text(encoding="utf-8"))
    description["version"] = version
    (extension / "package.json").write_text(json.dumps(description, indent=2) + "\n", encoding="utf-8")
    subprocess.run(["npx", "--no-install", "vsce", "package", "--target", target, "--allow-missing-repository",
                    "--out", output.resolve() / f"edsc-{version}-{target}.vsix"], cwd=extension, check=True)


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    output, *archives = map(Path, sys.argv[1:])
    output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        extension = Path(folder) / "extension"
        shutil.copytree(HERE, extension, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
        subprocess.run(["npm", "ci", "--ignore-scripts", "--prefer-offline", "--silent", "--no-audit", "--no-fund"],
                       cwd=extension, check=True)
        for archive in archives:
            make(archive, extension, output)


if __name__ == "__main__":
    main()
