#!/usr/bin/env python3
"""The tables of docs/node.md name all public functions of a node, and no others.

    node_functions_test.py SOURCE_DIR [--list]

Clang reads the headers. A heading "## `Class`" of the page begins the table of a class, "## Parts" that of the functions in the
namespace; a row begins with one or more names in backticks, of which the parameters do not matter: a new function needs a row, a
new overload does not. `--list` prints the functions instead.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

PAGE = "docs/node.md"
FREE = "Parts"
# Headers with the functions: all of node/, and those of the classes that are used beside a node.
OTHERS = ("node.hpp", "indicator/indicator.hpp", "lss/lss_handler.hpp", "sdo/domain_handlers.hpp", "sdo/sdo_client.hpp",
          "storage/storage.hpp")
CLASSES = {"Node": "Node", "ObjectValues": "Node", "ObjectSetters": "Node", "Locked": "Locked", "Mailbox": "Mailbox",
           "Indicators": "Indicators", "SdoClient": "SdoClient"}
# Of the runtime itself: not called by an application.
INTERNAL_CLASSES = {"AcceptedFrame", "Composition", "DomainHandlerSet", "EventHandler", "HandlerCall", "HandlerCalls", "HandlerSet",
                    "ServiceDefaults", "ServiceHost", "ServiceSet"}
INTERNAL = {"check_limits", "check_received", "checked_handlers", "has_checks", "is_communication_index", "notify_written",
            "take_received"}
ROW = re.compile(r"^\| ((?:`[^`]+`(?:, )?)+) \|", re.MULTILINE)


def declarations(source: Path) -> list[dict]:
    """Returns the declarations in the namespace, each with `file`."""
    runtime = source / "runtime/include"
    headers = [*OTHERS, *sorted(f"node/{path.name}" for path in (runtime / "canopen/node").glob("*.hpp"))]
    with tempfile.TemporaryDirectory() as scratch:
        unit = Path(scratch) / "headers.cpp"
        unit.write_text("".join(f"#include <canopen/{header}>\n" for header in headers))
        text = subprocess.run(["clang++-14", "-std=c++20", f"-I{runtime}", "-fsyntax-only", "-Xclang", "-ast-dump=json", "-Xclang",
                               "-ast-dump-filter=canopen::", unit], stdout=subprocess.PIPE, text=True, check=True).stdout
    decoder, at, found, file = json.JSONDecoder(), 0, [], ""
    while (at := re.compile(r"\s*").match(text, at).end()) < len(text):
        declared, at = decoder.raw_decode(text, at)
        file = declared["loc"].get("file", file)  # without it, the file is that of the declaration before
        if file.removeprefix(f"{runtime}/canopen/") in headers:
            found.append(declared)
    return found


def function_name(declared: dict) -> str:
    """Returns the name of a function that may be called by it, or an empty string."""
    name = declared.get("name", "")
    is_function = declared["kind"] in ("CXXMethodDecl", "FunctionDecl", "FunctionTemplateDecl", "UnresolvedUsingValueDecl")
    return name if is_function and re.fullmatch(r"\w+", name) and not declared.get("isImplicit") else ""


def public_functions(class_template: dict) -> set[str]:
    """Returns the public functions of a class template that it declares itself."""
    record = next(inner for inner in class_template["inner"] if inner["kind"] == "CXXRecordDecl")
    access, found = "public" if record.get("tagUsed") == "struct" else "private", set()
    for member in record.get("inner", ()):
        if member["kind"] == "AccessSpecDecl":
            access = member["access"]
        elif access == "public" and (name := function_name(member)) and name != record["name"]:
            found.add(name)
    return found


def functions(source: Path) -> dict[str, set[str]]:
    found: dict[str, set[str]] = defaultdict(set)
    for declared in declarations(source):
        name = declared.get("name", "")
        if declared["kind"] == "ClassTemplateDecl" and name not in INTERNAL_CLASSES:
            members = public_functions(declared)
            if members and name not in CLASSES:
                sys.exit(f"{name} has public functions; name it in CLASSES or INTERNAL_CLASSES of {Path(__file__).name}")
            if members:
                found[CLASSES[name]] |= members
        elif function_name(declared) and name not in INTERNAL:
            found[FREE].add(name)
    return found


def documented(page: str) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {}
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        heading = section.splitlines()[0].strip("` ")
        if heading in {*CLASSES.values(), FREE}:
            found[heading] = {re.match(r"(?:canopen::|node\.)?(\w+)", name)[1] for row in ROW.findall(section)
                              for name in re.findall(r"`([^`]+)`", row)}
    return found


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    if shutil.which("clang++-14") is None:
        print("SKIPPED: clang++-14 of Debian 12 is missing; other versions write another syntax tree")
        return 77
    expected = functions(source)
    if "--list" in sys.argv:
        for group, names in expected.items():
            print(f"{group}: {' '.join(sorted(names))}")
        return 0
    named = documented((source / PAGE).read_text(encoding="utf-8"))
    problems = 0
    for group in sorted(expected.keys() | named.keys()):
        for name in sorted(expected.get(group, set()) - named.get(group, set())):
            print(f"{PAGE}: {group}: no row for {name}")
            problems += 1
        for name in sorted(named.get(group, set()) - expected.get(group, set())):
            print(f"{PAGE}: {group}: {name} is not a public function")
            problems += 1
    print(f"{sum(map(len, expected.values()))} functions, {problems} problems")
    return 1 if problems or not expected else 0


if __name__ == "__main__":
    sys.exit(main())
