#!/usr/bin/env python3
"""The table of options agrees with docs/options.md, its JSON schema and the defaults of the runtime.

    options_test.py SOURCE_DIR EDSC [--write]      --write generates the table of the page, and the schema

The schema has the structure of the structured options; descriptions, defaults and the other options are generated.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

BEGIN, END = "<!-- made by: tests/generator/device/options_test.py -->\n", "<!-- end -->\n"
MASK = {"type": "string", "pattern": "^0x[0-9A-Fa-f]{1,8}$"}
CAN_ID = {"type": "string", "pattern": "^0x[0-7]?[0-9A-Fa-f]{1,2}$"}
FORMS = {
    "flag": {"type": "boolean"},
    "number": {"type": "integer"},
    "mask": MASK,
    "abort_code": MASK,
    "emergency_code": {"type": "string", "pattern": "^[0-9A-Fa-f]{1,4}h?$"},
    "can_id_range": {"type": "array", "items": CAN_ID, "minItems": 2, "maxItems": 2},
}
MEMBER = re.compile(r"^  [\w:<>]+ (\w+)(?: = ([^;]+)|\{([^}]*)\});", re.MULTILINE)


def table(options: list[dict]) -> str:
    """One table for each group, in the order of the options."""
    text = ""
    for group in dict.fromkeys(option["group"] for option in options):
        members = [option for option in options if option["group"] == group]
        text += f"\n### {group}\n\n"
        if "group_meaning" in members[0]:
            meaning = members[0]["group_meaning"]
            text += f"{meaning[0].upper()}{meaning[1:]}.\n\n"
        text += "| option | meaning | default |\n|---|---|---|\n"
        for option in members:
            default = option.get("default_text", "")
            if not default and "default" in option:
                default = json.dumps(option["default"])
                default = f"`{default}`" if default.startswith('"') else default
            text += f"| `{option['name']}` | {option['meaning']} | {default} |\n"
    return text + "\n"


def plain(text: str) -> str:
    """Without the marks of Markdown, and without links."""
    return re.sub(r"(, )?\[see below\]\([^)]*\)", "", text).replace("`", "")


def schema_of_option(option: dict, old: dict) -> dict:
    """The structure of a structured option is that of the old schema."""
    row = dict(FORMS.get(option["form"]) or {key: old[key] for key in old if key not in ("description", "default")})
    row |= {key: option[key] for key in ("minimum", "maximum", "default") if key in option}
    return {"description": plain(option["meaning"]), **row}


def schema_of(options: list[dict], schema: dict) -> dict:
    properties, flat = {"$schema": schema["properties"]["$schema"]}, {}
    for option in options:
        *group, name = option["name"].split(".")
        members, old = properties, schema["properties"]
        if group:
            meaning = plain(option.get("group_meaning", f"{option['group']} options"))
            empty = {"description": meaning, "type": "object", "additionalProperties": False, "properties": {}}
            members = properties.setdefault(group[0], empty)["properties"]
            old = old.get(group[0], {}).get("properties", {})
        members[name] = schema_of_option(option, old.get(name, {}))
        if "flat_name" in option:
            flat[option["flat_name"]] = {"deprecated": True, "$ref": f"#/properties/{group[0]}/properties/{name}"}
    return schema | {"properties": properties | flat}


def with_table(page: str, text: str) -> str:
    head, rest = page.split(BEGIN, 1)
    return head + BEGIN + text + END + rest.split(END, 1)[1]


def members_of(header: Path, name: str) -> dict[str, str]:
    """The members of a struct of the runtime and their default values in C++."""
    text = header.read_text(encoding="utf-8")
    body = text[text.index(f"struct {name} {{"):]
    return {member: (value or braces).strip() for member, value, braces in MEMBER.findall(body[:body.index("\n};")])}


def runtime_problems(struct: str, members: dict[str, str], rows: dict[str, dict]) -> list[str]:
    """Members of a struct of the runtime without a row, and rows with another default; `rows` by member."""
    problems = [f"canopen::{struct}::{name} is not in the table of options" for name in members if name not in rows]
    for name, row in rows.items():
        if name not in members:
            problems.append(f"{name} is not a member of canopen::{struct}")
        elif "default" in row:
            value = row["default"]
            expected = value if isinstance(value, (bool, int)) else int(value, 16)
            found = members[name].replace("'", "")
            found_value = {"true": True, "false": False}.get(found)
            if (int(found, 0) if found_value is None else found_value) != expected:
                problems.append(f"{name}: the default is {value} in the table and {found} in canopen::{struct}")
    return problems


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    listed = subprocess.run([edsc, "check", "--list-options", "--format", "json"], check=True, capture_output=True)
    options = json.loads(listed.stdout)["options"]
    page, schema = source_dir / "docs/options.md", source_dir / "docs/schema/options.schema.json"
    old_schema = json.loads(schema.read_text(encoding="utf-8"))
    texts = {
        page: with_table(page.read_text(encoding="utf-8"), table(options)),
        schema: json.dumps(schema_of(options, old_schema), indent=2, ensure_ascii=False) + "\n",
    }
    runtime = source_dir / "runtime/include/canopen"
    lss = {option["name"].removeprefix("lss."): option for option in options if option["name"].startswith("lss.")}
    device = {option.get("flat_name", option["name"].replace(".", "_")): option
              for option in options if option["form"] != "structured" and not option["name"].startswith("lss.")}
    problems = runtime_problems("DeviceOptions", members_of(runtime / "od/device_options.hpp", "DeviceOptions"), device)
    problems += runtime_problems("LssOptions", members_of(runtime / "lss/lss_options.hpp", "LssOptions"), lss)
    for path, text in texts.items():
        if "--write" in sys.argv:
            path.write_text(text, encoding="utf-8")
        elif path.read_text(encoding="utf-8") != text:
            problems.append(f"{path.relative_to(source_dir)} is not up to date: run options_test.py with --write")
    print("\n".join(problems))
    print(f"{len(options)} options, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
