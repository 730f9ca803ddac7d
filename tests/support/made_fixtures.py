"""EDS files that programs of tests/fixtures make."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def names_eds(folder: Path) -> Path:
    """Writes names.eds to the folder."""
    program = Path(__file__).resolve().parents[1] / "fixtures/names.py"
    made = folder / "names.eds"
    made.write_bytes(subprocess.run([sys.executable, program], check=True, capture_output=True, timeout=600).stdout)
    return made
