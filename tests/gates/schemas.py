#!/usr/bin/env python3
"""The JSON files of the repository fit the schemas of docs/schema.

    schemas.py SOURCE_DIR

A file belongs to a schema by its name (x.options.json, x.deviations.json, x.behaviour.json) or by a member "$schema" that names a schema of
docs/schema by its $id or as a path. A file of docs/schema is a schema with an $id of its own. All other files are JSON.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import jsonschema

KINDS = ("options", "deviations", "behaviour")
METASCHEMA = "https://json-schema.org/draft/2020-12/schema"
ID = "urn:edsc:schema:"


def schema_of(source_dir: Path, name: str, value: object) -> str:
    """Returns the name of the schema that a file claims, or nothing."""
    for kind in KINDS:
        if name.endswith(f".{kind}.json"):
            return kind
    claimed = value.get("$schema", "") if isinstance(value, dict) else ""
    if claimed.startswith(ID):
        return claimed.removeprefix(ID)
    path = (source_dir / name).parent / claimed
    if claimed and path.resolve().parent == source_dir / "docs/schema":
        return path.name.removesuffix(".schema.json")
    return ""


def problems_of(schema: dict, value: object) -> list[str]:
    validator = jsonschema.Draft202012Validator(schema)
    return [f"{error.json_path}: {error.message}" for error in validator.iter_errors(value)]


def problems_of_schema(name: str, schema: object) -> list[str]:
    expected = ID + Path(name).name.removesuffix(".schema.json")
    if not isinstance(schema, dict) or schema.get("$id") != expected:
        return [f"expected \"$id\": \"{expected}\""]
    if schema.get("$schema") != METASCHEMA:
        return [f"expected \"$schema\": \"{METASCHEMA}\""]
    return problems_of(jsonschema.Draft202012Validator.META_SCHEMA, schema)


def main() -> int:
    source_dir = Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", source_dir, "ls-files", "--cached", "--others", "--exclude-standard", "*.json"],
                            capture_output=True, text=True)
    if listed.returncode != 0:
        print("SKIPPED: the folder is not a git repository")
        return 77
    names = [name for name in sorted(set(listed.stdout.splitlines())) if (source_dir / name).is_file()]
    problems, values = [], {}
    for name in names:
        try:
            values[name] = json.loads((source_dir / name).read_text(encoding="utf-8"))
        except ValueError as error:
            problems.append(f"{name}: {error}")
    schemas = {Path(name).name.removesuffix(".schema.json"): value for name, value in values.items()
               if name.startswith("docs/schema/")}
    checked = 0
    for name, value in values.items():
        if name.startswith("docs/schema/"):
            found = problems_of_schema(name, value)
        elif claimed := schema_of(source_dir, name, value):
            found = problems_of(schemas[claimed], value) if claimed in schemas else [f"unknown schema \"{claimed}\""]
        else:
            continue
        checked += 1
        problems += [f"{name}: {problem}" for problem in found]
    print("\n".join(problems))
    print(f"{len(names)} files, {checked} of them checked with a schema, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
