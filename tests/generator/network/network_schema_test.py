#!/usr/bin/env python3
"""The JSON schema of network files agrees with the members that edsc reads.

    network_schema_test.py SOURCE_DIR EDSC [--write]      --write generates the schema
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

FORMS = {
    "text": {"type": "string"},
    "number": {"type": "integer"},
    "flag": {"type": "boolean"},
    "texts": {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]},
    "values": {"type": "object", "additionalProperties": {"type": ["number", "string", "boolean"]}},
}


def object_of(members: list[dict], owner: str, description: str) -> dict:
    properties = {}
    for member in (one for one in members if one["owner"] == owner):
        limits = {key: member[key] for key in ("minimum", "maximum") if key in member}
        name = member["name"].removeprefix(f"{owner}.")
        properties[name] = {"description": member["meaning"].replace("`", ""), **FORMS[member["form"]], **limits}
    return {"description": description, "type": "object", "additionalProperties": False, "properties": properties}


def schema_of(members: list[dict]) -> dict:
    root = object_of(members, "", "")
    nodes = {"description": "the nodes by name", "type": "object", "minProperties": 1,
             "additionalProperties": object_of(members, "nodes.*", "a node")}
    signal = object_of(members, "signals[]", "values that one node sends to others") | {"required": ["from", "object"]}
    others = {"$schema": {"type": "string"},
              "sync": object_of(members, "sync", "SYNC"),
              "assume": object_of(members, "assume", "intervals of frames whose rate nothing limits"),
              "nodes": nodes,
              "signals": {"description": "signals, which edsc assigns to PDOs", "type": "array", "items": signal},
              "guessed": {"description": "what edsc discover guesses about the bus, for people; the other commands ignore it",
                          "type": "object"}}
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "$id": "urn:edsc:schema:network",
            "title": "edsc network file: the nodes of a CANopen network and their signals", "type": "object",
            "additionalProperties": False, "required": ["bit_rate", "nodes"],
            "properties": root["properties"] | others}


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    listed = subprocess.run([edsc, "network", "members", "--format", "json"], check=True, capture_output=True)
    path, schema = source / "docs/schema/network.schema.json", schema_of(json.loads(listed.stdout)["members"])
    if "--write" in sys.argv:
        path.write_text(json.dumps(schema, indent=2) + "\n", encoding="utf-8")
    elif not path.exists() or json.loads(path.read_text(encoding="utf-8")) != schema:
        print("docs/schema/network.schema.json is not up to date: run network_schema_test.py with --write")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
