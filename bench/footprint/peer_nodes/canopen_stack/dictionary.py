"""The object dictionary of a device in the form that canopen-stack compiles: OD.h and OD.c, from the JSON of `edsc dump`.

The list of entries is constant. A read-only value that no PDO maps is in the list; other values are variables.
"""

from __future__ import annotations

from typing import Any

Json = dict[str, Any]

STATE = ("DOMAIN", "VISIBLE_STRING")  # types whose transfers keep an offset
HISTORY, WRITTEN = 0x1003, 0x6083  # error history; the object for which the application has a function
TYPES = {0x1003: "CO_TEMCY_HIST", 0x1005: "CO_TSYNC_ID", 0x1006: "CO_TSYNC_CYCLE", 0x1014: "CO_TEMCY_ID", 0x1017: "CO_THB_PROD",
         WRITTEN: "&peer_written"}
PDO_PARAMETERS = {0x14: {1: "CO_TPDO_ID", 2: "CO_TPDO_TYPE"}, 0x18: {1: "CO_TPDO_ID", 2: "CO_TPDO_TYPE", 5: "CO_TPDO_EVENT"}}
PDO_MAPPINGS = (0x16, 0x1A)
DOMAIN_BYTES = 8192  # of transfers.hpp


def name_of(entry: Json) -> str:
    return f"x{entry['index']:04X}_{entry['sub_index']}"


def value_of(entry: Json) -> int:
    """The default value without the node-ID."""
    value = entry.get("default_value", 0)
    return int(value.replace("$NODEID+", ""), 0) if isinstance(value, str) else value


def is_written(entry: Json) -> bool:
    return entry["access"] not in ("ro", "const")


def is_direct(entry: Json) -> bool:
    """Whether the list has the value."""
    return not (is_written(entry) or entry["pdo_mapping"] or entry["index"] == HISTORY or entry["data_type"] in STATE)


def type_of(entry: Json) -> str:
    index, sub_index = entry["index"], entry["sub_index"]
    if index >> 8 in PDO_MAPPINGS:
        return "CO_TPDO_MAP" if sub_index else "CO_TPDO_NUM"
    special = PDO_PARAMETERS.get(index >> 8, {}).get(sub_index) or TYPES.get(index)
    if special is not None:
        return special
    return {"DOMAIN": "CO_TDOMAIN", "VISIBLE_STRING": "CO_TSTRING"}.get(entry["data_type"]) or f"CO_TUNSIGNED{entry['bits']}"


def flags(entry: Json) -> str:
    found = {"CO_OBJ_____R_": entry["access"] != "wo", "CO_OBJ______W": is_written(entry), "CO_OBJ____P__": entry["pdo_mapping"],
             "CO_OBJ__N____": "$NODEID" in str(entry.get("default_value", "")), "CO_OBJ_D_____": is_direct(entry)}
    return " | ".join(name for name, is_set in found.items() if is_set)


def variable(entry: Json) -> str:
    name = name_of(entry)
    if entry["data_type"] == "VISIBLE_STRING":
        return f'static CO_OBJ_STR {name} = {{0, (uint8_t*)"{entry["default_value"]}"}};'
    if entry["data_type"] == "DOMAIN":
        return f"static uint8_t {name}_bytes[{DOMAIN_BYTES}];\nstatic CO_OBJ_DOM {name} = {{0, {DOMAIN_BYTES}, {name}_bytes}};"
    return f"uint{entry['bits']}_t {name} = (uint{entry['bits']}_t){value_of(entry)};"


def row(entry: Json) -> str:
    data = value_of(entry) if is_direct(entry) else f"&{name_of(entry)}"
    return f"  {{CO_KEY(0x{entry['index']:04X}, {entry['sub_index']}, {flags(entry)}), {type_of(entry)}, (CO_DATA){data}}},"


def entries_of(device: Json) -> list[Json]:
    return [entry for thing in device["objects"] for entry in thing["entries"]]


def header(device: Json) -> str:
    """OD.h: the list and its length."""
    written = next(entry for entry in entries_of(device) if entry["index"] == WRITTEN)
    return "\n".join(["#pragma once", '#include "co_core.h"', f"#define OD_ENTRIES {len(entries_of(device))}",
                      "#ifdef __cplusplus", 'extern "C" {', "#endif",
                      "extern const CO_OBJ_TYPE peer_written;", "extern const CO_OBJ OD_list[];",
                      f"extern uint32_t {name_of(written)};",
                      "#ifdef __cplusplus", "}", "#endif", ""])


def source(device: Json) -> str:
    """OD.c: the variables and the list of entries."""
    entries = entries_of(device)
    return "\n".join(['#include "OD.h"', *(variable(entry) for entry in entries if not is_direct(entry)),
                      "const CO_OBJ OD_list[] = {", *map(row, entries), "  CO_OBJ_DICT_ENDMARK", "};", ""])
