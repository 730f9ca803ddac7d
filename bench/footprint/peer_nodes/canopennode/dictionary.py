"""The object dictionary of a device in the form that CANopenNode 4 compiles: OD.h and OD.c, from the JSON of `edsc dump`.

All values are members of one structure in RAM. The description of each entry is constant.
"""

from __future__ import annotations

import re
from typing import Any

Json = dict[str, Any]

C_TYPES = {f"{sign}{bits}": f"{prefix}int{bits}_t" for sign, prefix in (("UNSIGNED", "u"), ("INTEGER", "")) for bits in (8, 16, 32)}
LAST_COMMUNICATION = 0x1FFF
HISTORY, PDO_COMMUNICATION = 0x1003, {"RPDO": 0x1400, "TPDO": 0x1800}
MAX_PDOS = 512
DOMAIN_BYTES = 8192  # of transfers.hpp


def text_of(entry: Json) -> str:
    return str(entry.get("default_value", ""))


def declaration(entry: Json, name: str) -> str:
    data_type = entry["data_type"]
    if data_type == "VISIBLE_STRING":
        return f"char {name}[{len(text_of(entry)) + 1}];"
    if data_type == "DOMAIN":
        return f"uint8_t {name}[{DOMAIN_BYTES}];"
    return f"{C_TYPES[data_type]} {name};"


def initializer(entry: Json) -> str:
    """The default value; without the node-ID, which CANopenNode adds to predefined CAN-IDs."""
    if entry["data_type"] == "VISIBLE_STRING":
        return f'"{text_of(entry)}"'
    if entry["data_type"] == "DOMAIN":
        return "{0}"
    value = entry.get("default_value", 0)
    return str(int(re.sub(r"\$NODEID\+", "", value), 0) if isinstance(value, str) else value)


def length(entry: Json) -> int:
    if entry["data_type"] == "VISIBLE_STRING":
        return len(text_of(entry))
    return DOMAIN_BYTES if entry["data_type"] == "DOMAIN" else entry["bits"] // 8


def attribute(entry: Json) -> str:
    is_read, is_written = entry["access"] != "wo", entry["access"] not in ("ro", "const")
    flags = {"ODA_SDO_R": is_read, "ODA_SDO_W": is_written,
             "ODA_TPDO": entry["pdo_mapping"] and is_read, "ODA_RPDO": entry["pdo_mapping"] and is_written,
             "ODA_MB": entry["data_type"] in C_TYPES and entry["bits"] > 8,
             "ODA_STR": entry["data_type"] == "VISIBLE_STRING"}
    return " | ".join(name for name, is_set in flags.items() if is_set)


def sub_name(entry: Json) -> str:
    return f"sub{entry['sub_index']}"


def members(thing: Json) -> list[str]:
    """The members of the structure of all values."""
    name, entries = f"x{thing['index']:04X}", thing["entries"]
    if thing["object_type"] == "ARRAY":
        return [f"uint8_t {name}_sub0;", f"{C_TYPES[entries[1]['data_type']]} {name}[{len(entries) - 1}];"]
    if thing["object_type"] == "RECORD":
        return [f"struct {{ {' '.join(declaration(entry, sub_name(entry)) for entry in entries)} }} {name};"]
    return [declaration(entries[0], name)]


def initializers(thing: Json) -> list[str]:
    name, entries = f"x{thing['index']:04X}", thing["entries"]
    if thing["object_type"] == "ARRAY":
        return [f".{name}_sub0 = {initializer(entries[0])},", f".{name} = {{{', '.join(map(initializer, entries[1:]))}}},"]
    if thing["object_type"] == "RECORD":
        values = ", ".join(f".{sub_name(entry)} = {initializer(entry)}" for entry in entries)
        return [f".{name} = {{{values}}},"]
    return [f".{name} = {initializer(entries[0])},"]


def description(thing: Json) -> str:
    """The constant that describes the entries of an object."""
    name, entries = f"x{thing['index']:04X}", thing["entries"]
    start = f"static CO_PROGMEM OD_obj_{{}}_t o{thing['index']:04X}"
    if thing["object_type"] == "ARRAY":
        element = entries[1]
        return (start.format("array") + f" = {{.dataOrig0 = &OD_RAM.{name}_sub0, .dataOrig = &OD_RAM.{name}[0], "
                f".attribute0 = {attribute(entries[0])}, .attribute = {attribute(element)}, "
                f".dataElementLength = {length(element)}, .dataElementSizeof = sizeof({C_TYPES[element['data_type']]})}};")
    if thing["object_type"] == "RECORD":
        rows = ", ".join(f"{{.dataOrig = &OD_RAM.{name}.{sub_name(entry)}, .subIndex = {entry['sub_index']}, "
                         f".attribute = {attribute(entry)}, .dataLength = {length(entry)}}}" for entry in entries)
        return start.format("record") + f"[{len(entries)}] = {{{rows}}};"
    entry = entries[0]
    return (start.format("var") + f" = {{.dataOrig = &OD_RAM.{name}, .attribute = {attribute(entry)}, "
            f".dataLength = {length(entry)}}};")


def header(device: Json) -> str:
    """OD.h: numbers of services, the structure of the values, and the entries that the stack needs."""
    things = device["objects"]
    indices = [thing["index"] for thing in things]
    counts = dict.fromkeys(("NMT", "EM", "EM_PROD", "SYNC", "SYNC_PROD", "HB_PROD", "SDO_SRV"), 1)
    counts |= {name: sum(first <= index < first + MAX_PDOS for index in indices) for name, first in PDO_COMMUNICATION.items()}
    history = next(len(thing["entries"]) - 1 for thing in things if thing["index"] == HISTORY)
    return "\n".join([
        "#ifndef OD_H", "#define OD_H",
        *(f"#define OD_CNT_{name} {count}" for name, count in counts.items()),
        f"#define OD_CNT_ARR_1003 {history}",
        "typedef struct {", *(f"  {member}" for thing in things for member in members(thing)), "} OD_RAM_t;",
        "#ifdef __cplusplus", 'extern "C" {', "#endif",
        "extern OD_RAM_t OD_RAM;", "extern OD_t *OD;",
        "#ifdef __cplusplus", "}", "#endif",
        *(f"#define OD_ENTRY_H{index:04X} (&OD->list[{i}])" for i, index in enumerate(indices) if index <= LAST_COMMUNICATION),
        "#endif", ""])


def source(device: Json) -> str:
    """OD.c: the values, their descriptions and the list of objects."""
    types = {"VAR": "ODT_VAR", "ARRAY": "ODT_ARR", "RECORD": "ODT_REC"}
    rows = (f"  {{0x{thing['index']:04X}, {len(thing['entries'])}, {types[thing['object_type']]}, "
            f"&o{thing['index']:04X}, NULL}}," for thing in device["objects"])
    return "\n".join([
        "#define OD_DEFINITION", '#include "301/CO_ODinterface.h"', '#include "OD.h"',
        "OD_RAM_t OD_RAM = {", *(f"  {text}" for thing in device["objects"] for text in initializers(thing)), "};",
        *map(description, device["objects"]),
        "static OD_entry_t OD_list[] = {", *rows, "  {0, 0, 0, NULL, NULL}", "};",
        "static OD_t OD_object = {sizeof OD_list / sizeof OD_list[0] - 1, OD_list};",
        "OD_t *OD = &OD_object;", ""])
