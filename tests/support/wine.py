"""Windows programs under wine."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

WINE_FOLDER = Path("/usr/lib/wine")
SECONDS = 600


def has_wine() -> bool:
    return (WINE_FOLDER / "wine64").is_file()


class Wine:
    """An own drive C: in a temporary folder. The server keeps running between the commands, which start in a third of a second."""

    def __init__(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="edsc-wine-", ignore_cleanup_errors=True)
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("EDSC_")}
        self.environment |= {"WINEPREFIX": self.folder.name, "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml=",
                             "DISPLAY": "", "LC_ALL": "C.UTF-8", "TERM": "xterm"}
        self.server("-p")
        # The services of Windows start with the first command and keep its output open.
        subprocess.run([WINE_FOLDER / "wine64", "cmd", "/c", "ver"], env=self.environment, timeout=SECONDS,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)

    @property
    def drive_c(self) -> Path:
        return Path(self.folder.name) / "drive_c"

    def server(self, argument: str) -> None:
        subprocess.run([WINE_FOLDER / "wineserver", argument], env=self.environment, timeout=SECONDS,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)

    def run(self, *command: object, cwd: Path | None = None, stdin: bytes | int = subprocess.DEVNULL,
            variables: dict[str, str] | None = None) -> subprocess.CompletedProcess:
        given = {"input": stdin} if isinstance(stdin, bytes) else {"stdin": stdin}
        return subprocess.run([WINE_FOLDER / "wine64", *map(str, command)], cwd=cwd, env=self.environment | (variables or {}),
                              capture_output=True, timeout=SECONDS, **given)

    def end(self) -> None:
        self.server("-k")
        self.server("-w")
        self.folder.cleanup()
