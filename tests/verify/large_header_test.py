#!/usr/bin/env python3
"""The header of a device with 65,000 entries compiles with the default limits of the compilers, for speed and for size.

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


def main() -> int:
    source_dir, edsc = (Path(argument).resolve() for argument in sys.argv[1:3])
    compilers = those_installed((GCC, CLANG))
    problems = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        subprocess.run([edsc, "generate", sheets.write(LARGEST, folder), "-o", folder, "--name", "device"], check=True,
                       capture_output=True)
        (folder / "device.cpp").write_text("#include <device/device.hpp>\n")
        for compiler in compilers:
            for optimization in ("-O2", "-Os"):
                run = compile_only(compiler, folder / "device.cpp", (folder, source_dir / "runtime/include"), (optimization,))
                print(f"{compiler.name} {optimization}: exit code {run.returncode}")
                if run.returncode != 0:
                    print(run.stderr[:4000])
                    problems += 1
    return 1 if problems else 0 if compilers else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
