#!/usr/bin/env python3
"""Lists the headers of the host program that only one file includes, not counting the source of the same name.

    single_use_headers.py SOURCE_DIR

Advice, not a gate: such a header may be a part of the file that includes it, or an interface that will have more users.
The runtime is not listed, because its headers are for the users' programs.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

from includes_test import INCLUDE, SOURCE_DIR, name_of, sources, top_of


def main() -> None:
    files = [path for path in sources() if top_of(path) != "runtime"]
    headers = {name_of(path): path for path in files if path.suffix == ".hpp"}
    users: dict[Path, list[Path]] = defaultdict(list)
    for path in (*files, *(SOURCE_DIR / "tests").rglob("*.[ch]pp")):
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            header = headers.get(name)
            if header is not None and header.with_suffix("") != path.with_suffix(""):
                users[header].append(path)
    for header in headers.values():
        if len(users[header]) < 2:
            user = users[header][0].relative_to(SOURCE_DIR) if users[header] else "nothing else"
            print(f"{header.relative_to(SOURCE_DIR)}: {user}")
    print(f"{len(headers)} headers, {sum(len(users[header]) < 2 for header in headers.values())} with a single user")


if __name__ == "__main__":
    main()
