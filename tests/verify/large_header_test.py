#!/usr/bin/env python3
"""The headers of a device with 65,000 entries, and of one with 512 PDOs of each direction, compile with the default limits of the
compilers, for speed and for size.

    large_header_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import sheets  # noqa: E402
from support.compilers import CLANG, GCC, SKIPPED, compile_only, those_installed  # noqa: E402

LARGEST = "rec6500x9"
MOST_PDOS = "pdos512"


def main() -> int:
    source_dir, edsc = (Path(argument).resolve() for argument in sys.argv[1:3])
    compilers = those_installed((GCC, CLANG))
    problems = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for sheet in (LARGEST, MOST_PDOS):
            subprocess.run([edsc, "generate", sheets.write(sheet, folder), "-o", folder / sheet, "--name", "device"], check=True,
                           capture_output=True)
        header = folder / "header.cpp"
        header.write_text("#include <device/device.hpp>\n")
        for compiler in compilers:
            for sheet in (LARGEST, MOST_PDOS):
                for optimization in ("-O2", "-Os"):
                    run = compile_only(compiler, header, (folder / sheet, source_dir / "runtime/include"), (optimization,))
                    print(f"{compiler.name} {optimization}, {sheet}: exit code {run.returncode}")
                    if run.returncode != 0:
                        print(run.stderr[:4000])
                        problems += 1
    return 1 if problems else 0 if compilers else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
