#!/usr/bin/env python3
"""Writes the bill of materials of an image, CycloneDX 1.5 in JSON: the versions of edsc, compiler and C library, and the hashes of
the image and of the files that it is generated from.

    firmware_bill.py IMAGE.bin OUTPUT --name NAME --edsc PROGRAM --compiler PROGRAM [--file FILE]...

The same image from the same files gives the same bytes: it has no time, no random number and no folder.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import subprocess
from pathlib import Path


def output(*command: str | Path, text: str = "") -> str:
    return subprocess.run(command, input=text, check=True, capture_output=True, text=True).stdout


def sha256(path: Path) -> list[dict[str, str]]:
    return [{"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}]


def tool(name: str, version: str, description: str) -> dict[str, object]:
    return {"type": "application", "name": name, "version": version, "description": description}


def library(name: str, version: str, license_choice: dict[str, object] | None = None) -> dict[str, object]:
    reference = f"pkg:generic/{name}@{version}"
    licenses = {"licenses": [license_choice]} if license_choice else {}
    return {"type": "library", "bom-ref": reference, "name": name, "version": version, "purl": reference, **licenses}


def libraries_of_compiler(compiler: Path) -> list[dict[str, object]]:
    """Returns the C library, if it is newlib or picolibc, and GCC's libgcc."""
    macros = output(compiler, "-E", "-dM", "-x", "c++", "-", text="#include <string.h>\n#if __has_include(<_newlib_version.h>)\n"
                                                                  "#include <_newlib_version.h>\n#endif\n")
    found = []
    for name, macro in (("picolibc", "__PICOLIBC_VERSION__"), ("newlib", "_NEWLIB_VERSION")):
        if match := re.search(rf'^#define {macro} "([^"]+)"', macros, re.MULTILINE):
            found.append(library(name, match[1]))
            break
    if "#define __clang__" not in macros and (match := re.search(r'^#define __VERSION__ "(\S+)', macros, re.MULTILINE)):
        found.append(library("libgcc", match[1], {"expression": "GPL-3.0-or-later WITH GCC-exception-3.1"}))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("image", "output", "--edsc", "--compiler"):
        parser.add_argument(name, type=Path, **({"required": True} if name.startswith("-") else {}))
    parser.add_argument("--name", required=True)
    parser.add_argument("--file", type=Path, action="append", default=[])
    arguments = parser.parse_args()

    edsc = output(arguments.edsc, "--version").split()[1]
    compiler = output(arguments.compiler, "--version").splitlines()[0]
    version = re.search(r"\d+\.\d+(\.\d+)?", re.sub(r"\([^)]*\)", "", compiler))
    image = {"type": "firmware", "bom-ref": arguments.name, "name": arguments.name, "hashes": sha256(arguments.image)}
    libraries = [library("edsc", edsc, {"license": {"id": "MIT"}}), *libraries_of_compiler(arguments.compiler)]
    files = [{"type": "file", "bom-ref": f"file:{path.name}", "name": path.name, "hashes": sha256(path)} for path in arguments.file]
    parts = [*libraries, *files]
    bill = {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {
            "tools": {"components": [tool("edsc", edsc, "generates the dictionary"),
                                     tool(arguments.compiler.stem, version[0] if version else "unknown", compiler)]},
            "component": image},
        "components": parts,
        "dependencies": [{"ref": arguments.name, "dependsOn": [part["bom-ref"] for part in parts]}]}
    arguments.output.write_text(json.dumps(bill, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
